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

void cell(const std::string& text) {
  ImGui::TableNextColumn();
  coloured_text(kTextColour, text);
}

/// A line for each minimum, and one for each kind of interval; returns the minimum that was clicked.
std::optional<std::size_t> draw_minima(const Fit& fit, std::optional<std::size_t> current,
                                       std::map<std::string, Area>& areas) {
  std::optional<std::size_t> clicked;
  const int columns = static_cast<int>(fit.parameters.size()) + 2;
  if (!ImGui::BeginTable("minima", columns, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV)) return clicked;
  ImGui::TableSetupColumn("minimum");
  ImGui::TableSetupColumn(shown("χ²").c_str());
  for (const FitParameter& one : fit.parameters) ImGui::TableSetupColumn(shown(parameter(one.key).symbol).c_str());
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < fit.minima.size(); ++i) {
    ImGui::TableNextColumn();
    const std::string name = fmt::format("{}{}", i + 1, i == 0 ? ", lowest" : "");
    if (ImGui::Selectable(name.c_str(), current == i, ImGuiSelectableFlags_SpanAllColumns)) clicked = i;
    areas[fmt::format("minimum {}", i + 1)] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
    cell(fmt::format("{:.5g}", fit.minima[i].chi_square));
    for (const double value : fit.minima[i].values) cell(fmt::format("{:.5g}", value));
  }
  for (const auto& [name, interval] :
       {std::pair{"68 %", &FitParameter::interval_68}, {"95 %", &FitParameter::interval_95}}) {
    cell(name);
    ImGui::TableNextColumn();
    for (const FitParameter& one : fit.parameters) cell(interval_text(one.*interval));
  }
  ImGui::EndTable();
  return clicked;
}

/// The lines of the report that say what the result means; the table above has the others.
void draw_words(const Fit& fit) {
  constexpr std::array<std::string_view, 9> kShown = {"minimum",    "misfit",     "scale",  "scaled", "pieces",
                                                      "correlated", "degenerate", "status", "model"};
  for (const auto& [label, text] : fit.report.rows) {
    if (std::ranges::find(kShown, label) == kShown.end()) continue;
    const ImU32 colour = label == "misfit" || label == "status" ? kErrorColour : kTextColour;
    coloured_text(colour, fmt::format("{}: {}", label, text));
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
    draw_words(fit);
    if (clicked) session.visit_minimum(*clicked);
  }
  ImGui::EndChild();
}

}  // namespace dolp::explore
