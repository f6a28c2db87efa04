#include <fmt/format.h>

#include <algorithm>

#include "explore/readout.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

void cell(const std::string& text, ImU32 colour = kTextColour) {
  ImGui::TableNextColumn();
  coloured_text(colour, text);
}

/// Influence of an effect on DOLP in percentage points: "≤ bound" if the run drops the effect, otherwise "≈ estimate".
std::string influence_text(const Effect& row) {
  if (!row.bound && !row.influence) return "";
  const double points = 100.0 * row.bound.value_or(row.influence.value_or(0.0));
  if (points == 0.0) return "0";
  return fmt::format("{} {} points", row.bound ? "≤" : "≈",
                     points >= 10.0 ? fmt::format("{:.0f}", points) : fmt::format("{:.2g}", points));
}

bool is_stale(const Session& session) { return !session.effects().empty() && !session.curve().is_finished(); }

void draw_row(const Session& session, const Effect& row) {
  const bool is_absent = row.state == EffectState::kAbsent;
  const ImU32 colour = is_absent || is_stale(session) ? kDimColour : kTextColour;
  const bool is_slopes = row.name == "distribution";  // removing this effect makes the surface smooth
  const std::string removed = is_slopes ? "roughness" : row.name;
  const std::string without = is_absent ? "" : without_text(session, removed);
  cell(row.name, colour);
  cell(row.state == EffectState::kNotNeeded ? "not needed" : to_name(row.state), colour);
  cell(influence_text(row), colour);
  cell(is_slopes && !without.empty() ? "smooth: " + without : without, colour);
  if (const std::string words = without_words(session, removed); !words.empty()) tooltip(words);
  cell(row.reason, colour);
  if (!row.needs.empty()) tooltip("needs: " + row.needs);
}

/// Draws a table: a row for each minimum, then the intervals for 68 % and 95 %. Returns the minimum that was clicked.
std::optional<std::size_t> draw_minima(const Fit& fit, std::optional<std::size_t> current) {
  std::optional<std::size_t> clicked;
  const int columns = static_cast<int>(fit.parameters.size()) + 2;
  if (!ImGui::BeginTable("minima", columns, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV)) return clicked;
  ImGui::TableSetupColumn("minimum");
  ImGui::TableSetupColumn(shown("χ²").c_str());
  for (const FitParameter& number : fit.parameters) ImGui::TableSetupColumn(shown(control(number.key).label).c_str());
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < fit.minima.size(); ++i) {
    ImGui::TableNextColumn();
    const std::string name = fmt::format("{}{}", i + 1, i == 0 ? ", lowest" : "");
    if (ImGui::Selectable(name.c_str(), current == i, ImGuiSelectableFlags_SpanAllColumns)) clicked = i;
    name_item(fmt::format("minimum {}", i + 1));
    cell(fmt::format("{:.5g}", fit.minima[i].chi_square));
    for (const double value : fit.minima[i].values) cell(fmt::format("{:.5g}", value));
  }
  for (const auto& [name, interval] :
       {std::pair{"68 %", &FitParameter::interval_68}, {"95 %", &FitParameter::interval_95}}) {
    cell(name);
    ImGui::TableNextColumn();
    for (const FitParameter& number : fit.parameters) cell(interval_text(number.*interval));
  }
  ImGui::EndTable();
  return clicked;
}

/// Draws lines of the fit's report that explain the table of draw_minima().
void draw_words(const Fit& fit) {
  constexpr std::array<std::string_view, 9> kShown = {"minimum",    "misfit",     "scale",  "scaled", "pieces",
                                                      "correlated", "degenerate", "status", "model"};
  for (const auto& [label, text] : fit.report.rows) {
    if (std::ranges::count(kShown, label) == 0) continue;
    const ImU32 colour = label == "misfit" || label == "status" ? kErrorColour : kTextColour;
    coloured_text(colour, fmt::format("{}: {}", label, text));
  }
}

}  // namespace

void draw_effects(const Session& session) {
  struct Column {
    const char* name;
    const char* meaning;
    float width;  ///< width in units of the font size
  };
  const std::array<Column, 5> columns = {
      {{is_stale(session) ? "the scene before" : "effect", "a part of the scene", 6.8F},
       {"plan", "kept, dropped, absent, or not needed by what is kept", 4.2F},
       {"at cursor", "what it adds to DOLP at the cursor: a bound (≤) where it is dropped, else an estimate", 6.4F},
       {"Q/I → without it", "Q/I at the cursor with all effects → without this one; their difference is its part",
        10.8F},
       {"why", "the reason of the plan", 14.0F}}};
  const float em = ImGui::GetFontSize();
  const bool is_narrow = ImGui::GetContentRegionAvail().x < 36.0F * em;
  ImGuiTableFlags flags =
      ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit;
  if (is_narrow) flags |= ImGuiTableFlags_ScrollX;
  if (!ImGui::BeginTable(is_narrow ? "narrow effects" : "effects", static_cast<int>(columns.size()), flags)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const Column& column : columns) {
    const bool is_stretched = &column == &columns.back() && !is_narrow;
    ImGui::TableSetupColumn(column.name,
                            is_stretched ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            is_stretched ? 0.0F : column.width * em);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const Column& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.name);
    tooltip(column.meaning);
  }
  for (const Effect& row : session.effects()) {
    ImGui::TableNextRow();
    draw_row(session, row);
  }
  ImGui::EndTable();
}

void draw_fit_result(Session& session) {
  ImGui::BeginChild("fit result");
  const Fit& fit = session.last_fit().value();
  const std::optional<std::size_t> current = session.minimum();
  const std::optional<std::size_t> clicked = draw_minima(fit, current);
  coloured_text(kDimColour, current ? "A click moves the sliders to a minimum."
                                    : "The scene has changed since the fit. A click brings a minimum back.");
  draw_words(fit);
  if (clicked) session.visit_minimum(*clicked);
  ImGui::EndChild();
}

}  // namespace dolp::explore
