#include "explore/window/views.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

#include "explore/readout.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

void cell(const std::string& text, ImU32 colour) {
  ImGui::TableNextColumn();
  coloured_text(colour, text);
}

/// In points of DOLP: a bound of what is dropped, an estimate of what is kept.
std::string influence_text(const Effect& row) {
  if (!row.bound && !row.influence) return "";
  const double points = 100.0 * row.bound.value_or(row.influence.value_or(0.0));
  if (points == 0.0) return "0";
  return fmt::format("{} {} points", row.bound ? "≤" : "≈",
                     points >= 10.0 ? fmt::format("{:.0f}", points) : fmt::format("{:.2g}", points));
}

/// The name of what is taken away: a surface without slopes is a smooth one.
std::string taken_away(const Effect& row) { return row.name == "distribution" ? "roughness" : row.name; }

std::string taken_away_text(const Session& session, const Effect& row) {
  const std::string text = without_text(session, taken_away(row));
  return text.empty() || row.name != "distribution" ? text : "smooth: " + text;
}

/// True where the effects belong to an earlier scene.
bool is_stale(const Session& session) { return !session.effects().empty() && !session.curve().is_finished(); }

void draw_row(const Session& session, const Effect& row) {
  const bool is_absent = row.state == EffectState::kAbsent;
  const ImU32 colour = is_absent || is_stale(session) ? kDimColour : kTextColour;
  cell(row.name, colour);
  cell(row.state == EffectState::kNotNeeded ? "not needed" : name_of(row.state), colour);
  cell(influence_text(row), colour);
  cell(is_absent ? "" : taken_away_text(session, row), colour);
  if (const std::string words = without_words(session, taken_away(row)); !words.empty()) tooltip(words);
  cell(row.reason, colour);
  if (!row.needs.empty()) tooltip("it takes: " + row.needs);
}

/// The names of the columns, each with what its values mean.
void draw_headers() {
  constexpr std::array kMeanings = {
      "a part of the scene", "kept, dropped, absent or not needed by what is kept",
      "what it adds to DOLP at the cursor: a bound (≤) where it is dropped, else an estimate",
      "Q/I at the maximum of the curve with all effects → without this one; their difference is its part",
      "the reason of the plan"};
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < static_cast<int>(kMeanings.size()); ++column) {
    ImGui::TableSetColumnIndex(column);
    ImGui::TableHeader(ImGui::TableGetColumnName(column));
    tooltip(kMeanings[static_cast<std::size_t>(column)]);
  }
}

}  // namespace

void draw_effects(const Session& session) {
  constexpr int kColumns = 5;
  const float em = ImGui::GetFontSize();
  const bool is_narrow = ImGui::GetContentRegionAvail().x < 36.0F * em;
  ImGuiTableFlags flags =
      ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit;
  if (is_narrow) flags |= ImGuiTableFlags_ScrollX;
  if (!ImGui::BeginTable(is_narrow ? "narrow effects" : "effects", kColumns, flags)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  const char* name = is_stale(session) ? "the scene before" : "effect";
  ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, 6.8F * em);
  ImGui::TableSetupColumn("plan", ImGuiTableColumnFlags_WidthFixed, 4.2F * em);
  ImGui::TableSetupColumn("at cursor", ImGuiTableColumnFlags_WidthFixed, 6.0F * em);
  ImGui::TableSetupColumn("Q/I → without it", ImGuiTableColumnFlags_WidthFixed, 9.4F * em);
  if (is_narrow) {
    ImGui::TableSetupColumn("why", ImGuiTableColumnFlags_WidthFixed, 14.0F * em);
  } else {
    ImGui::TableSetupColumn("why", ImGuiTableColumnFlags_WidthStretch);
  }
  draw_headers();
  for (const Effect& row : session.effects()) {
    ImGui::TableNextRow();
    draw_row(session, row);
  }
  ImGui::EndTable();
}

}  // namespace dolp::explore
