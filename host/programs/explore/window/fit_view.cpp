#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "explore/parameters.hpp"
#include "explore/window/style.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr ImGuiTableFlags kTable = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV;

void number(double value) {
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(fmt::format("{:.5g}", value).c_str());
}

void column_for(const FitParameter& of) { ImGui::TableSetupColumn(shown(parameter(of.key).symbol).c_str()); }

/// A line for each minimum; returns the one that was clicked.
std::optional<std::size_t> draw_minima(const Fit& fit, std::optional<std::size_t> current,
                                       std::map<std::string, Area>& areas) {
  std::optional<std::size_t> clicked;
  const int columns = static_cast<int>(fit.parameters.size()) + 2;
  if (!ImGui::BeginTable("minima", columns, kTable)) return clicked;
  ImGui::TableSetupColumn("minimum");
  ImGui::TableSetupColumn(shown("χ²").c_str());
  for (const FitParameter& one : fit.parameters) column_for(one);
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < fit.minima.size(); ++i) {
    const std::string name = fmt::format("{}{}", i + 1, i == 0 ? " (lowest)" : "");
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ImGui::Selectable(name.c_str(), current == i, ImGuiSelectableFlags_SpanAllColumns)) clicked = i;
    areas[fmt::format("minimum {}", i + 1)] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
    number(fit.minima[i].chi_square);
    for (const double value : fit.minima[i].values) number(value);
  }
  ImGui::EndTable();
  return clicked;
}

void draw_intervals(const Fit& fit) {
  if (!ImGui::BeginTable("intervals", 3, kTable)) return;
  for (const char* name : {"", "68 %", "95 %"}) ImGui::TableSetupColumn(name);
  ImGui::TableHeadersRow();
  for (const FitParameter& one : fit.parameters) {
    ImGui::TableNextRow();
    for (const std::string& text :
         {std::string(parameter(one.key).symbol), interval_text(one.interval_68), interval_text(one.interval_95)}) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(shown(text).c_str());
    }
  }
  ImGui::EndTable();
}

/// The lines of the report that say what the result means; the tables above have the others.
void draw_words(const Fit& fit) {
  constexpr std::array<std::string_view, 9> kShown = {"minimum",    "misfit",     "scale",  "pieces", "open",
                                                      "correlated", "degenerate", "status", "model"};
  for (const auto& [label, text] : fit.report.rows) {
    if (std::ranges::find(kShown, label) == kShown.end()) continue;
    const ImU32 colour = label == "misfit" || label == "status" ? kErrorColour : kTextColour;
    coloured_text(colour, label + ": " + text);
  }
}

}  // namespace

void draw_fit_result(Session& session, std::map<std::string, Area>& areas) {
  ImGui::BeginChild("fit result");
  if (!session.last_fit()) {
    coloured_text(kDimColour,
                  "No fit yet: load measured points (Ctrl+O), mark the numbers that vary by the boxes beside their "
                  "sliders, then Ctrl+F.");
  } else {
    const Fit& fit = *session.last_fit();
    const std::optional<std::size_t> current = session.minimum();
    const std::optional<std::size_t> clicked = draw_minima(fit, current, areas);
    coloured_text(kDimColour, current ? "A click moves the sliders to a minimum."
                                      : "The scene is no longer that of the fit. A click brings a minimum back.");
    draw_intervals(fit);
    ImGui::Spacing();
    draw_words(fit);
    if (clicked) session.visit_minimum(*clicked);
  }
  ImGui::EndChild();
}

}  // namespace dolp::explore
