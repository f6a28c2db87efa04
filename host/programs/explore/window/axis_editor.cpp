#include "explore/window/axis_editor.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

std::string AxisEditor::take(const std::string& end, const std::string& text, const Scale& now, const Check& check,
                             std::optional<Change>& change) const {
  const std::optional<double> typed = parse_number(text);
  if (!typed) return fmt::format("{} = {}: must be a number", end, one_line(text));
  // An end that was refused goes with the other.
  const auto other = [&](const char* name, double value) { return parse_number(fields_.text(name)).value_or(value); };
  const Scale range{end == "from" ? *typed : other("from", now.from), end == "to" ? *typed : other("to", now.to),
                    now.is_log};
  std::string refusal = range.refusal();
  if (!refusal.empty()) return fmt::format("{} = {}: {}", end, one_line(text), refusal);
  refusal = check(range);
  if (refusal.empty()) change = Change{range, range.is_log};
  return refusal;
}

std::optional<AxisEditor::Change> AxisEditor::draw(const std::string& label, const Area& numbers, const Scale& now,
                                                   const Check& check) {
  std::optional<Change> change;
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(numbers.min, numbers.max) &&
      ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    shown_ = label;
    is_opening_ = true;
    fields_ = {};
  }
  if (shown_ != label) return change;
  const bool was_typed = !fields_.text("from").empty() || !fields_.text("to").empty();
  bool is_open = true;
  const ImVec2 mouse = ImGui::GetMousePos();
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(mouse, ImGuiCond_Appearing,
                          {mouse.x > middle.x ? 1.0F : 0.0F, mouse.y > middle.y ? 1.0F : 0.0F});
  if (is_opening_) ImGui::SetNextWindowFocus();
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse;
  if (ImGui::Begin(shown(label).c_str(), &is_open, kFlags)) {
    for (const auto& [end, value] : {std::pair{"from", now.from}, {"to", now.to}}) {
      ImGui::SetNextItemWidth(7.0F * ImGui::GetFontSize());
      if (is_opening_) ImGui::SetKeyboardFocusHere();
      is_opening_ = false;
      fields_.draw(end, value, [&](const std::string& text) { return take(end, text, now, check, change); });
      ImGui::SameLine();
      ImGui::TextUnformatted(end);
      if (const std::string why = fields_.reason(end); !why.empty()) coloured_text(kErrorColour, why);
    }
    bool is_log = now.is_log;
    if (ImGui::Checkbox("logarithmic", &is_log)) change = Change{std::nullopt, is_log};
    log_box_ = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
    ImGui::SameLine();
    if (ImGui::Button("automatic")) change = Change{std::nullopt, now.is_log};
  }
  // Escape takes back what is typed first.
  if (ImGui::IsWindowFocused() && !was_typed && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
    is_open = false;
  ImGui::End();
  if (!is_open) shown_.clear();
  if (change) fields_ = {};
  return change;
}

}  // namespace dolp::explore
