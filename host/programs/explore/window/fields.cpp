#include "explore/window/fields.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <utility>

#include "explore/window/input.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

void NumberFields::draw(const std::string& key, double value, const Take& take) {
  const auto found = typed_.find(key);
  // The text typed goes with the value that it was to change.
  if (found != typed_.end() && !found->second.is_active && found->second.value != value) typed_.erase(found);
  const std::string own = fmt::format("{:.6g}", value);
  const bool is_refused = !reason(key).empty();
  const std::string before = typed_.contains(key) ? text(key) : own;
  std::string now = before;
  if (is_refused) ImGui::PushStyleColor(ImGuiCol_FrameBg, kRefusedColour);
  ImGui::PushItemFlag(ImGuiItemFlags_NoTabStop, false);
  ImGui::InputText(("##" + key).c_str(), &now, ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopItemFlag();
  if (is_refused) ImGui::PopStyleColor();

  if (now != before && !typed_.contains(key)) typed_[key] = {now, value};
  const auto typed = typed_.find(key);
  if (typed == typed_.end()) return;
  const bool was_active = std::exchange(typed->second.is_active, ImGui::IsItemActive());
  typed->second.text = now;
  const bool is_ended = was_active && !typed->second.is_active;
  const bool is_free = !ImGui::IsAnyItemActive() && !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
  const bool is_taken_back = is_pressed(GLFW_KEY_ESCAPE) && (is_ended || is_free);
  if (is_taken_back || (is_ended && now == own)) {
    typed_.erase(typed);
  } else if (is_ended) {
    typed->second.reason = take(now);
    if (typed->second.reason.empty()) typed_.erase(typed);
  }
}

std::string NumberFields::text(const std::string& key) const {
  const auto typed = typed_.find(key);
  return typed == typed_.end() ? "" : typed->second.text;
}

std::string NumberFields::reason(const std::string& key) const {
  const auto typed = typed_.find(key);
  return typed == typed_.end() ? "" : typed->second.reason;
}

std::optional<std::string> typed_name(std::string name, const std::string& hint) {
  if (!ImGui::BeginPopupContextItem("name")) return std::nullopt;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool is_typed = ImGui::InputTextWithHint("##name", hint.c_str(), &name);
  ImGui::EndPopup();
  return is_typed ? std::optional(std::move(name)) : std::nullopt;
}

}  // namespace dolp::explore
