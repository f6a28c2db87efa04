#include "explore/window/path_dialog.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "explore/window/input.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPopup = "###path";
constexpr const char* kUp = "../";
constexpr float kListLines = 12.0F;

}  // namespace

void PathDialog::open(Request request) {
  request_ = std::move(request);
  const fs::path path = request_.path;
  name_ = path.filename().string();
  enter(path.parent_path());
  is_opening_ = wants_focus_ = true;
}

void PathDialog::enter(const fs::path& folder) {
  folder_ = folder;
  std::vector<std::string> files;
  listed_ = {kUp};
  std::error_code failure;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    std::error_code unknown;
    if (name.starts_with('.')) continue;
    if (entry->is_directory(unknown)) {
      listed_.push_back(name + '/');
    } else if (std::ranges::count(request_.suffixes, entry->path().extension().string()) > 0) {
      files.push_back(name);
    }
  }
  std::ranges::sort(listed_);
  std::ranges::sort(files);
  listed_.insert(listed_.end(), files.begin(), files.end());
}

bool PathDialog::draw_list() {
  bool is_repeated = false;
  std::string entered;
  areas_.clear();
  const float most = 0.5F * ImGui::GetMainViewport()->WorkSize.y;
  ImGui::BeginChild("files", {0.0F, std::min(kListLines * ImGui::GetTextLineHeightWithSpacing(), most)}, true);
  for (const std::string& name : listed_) {
    const bool is_chosen = name == name_;
    if (ImGui::Selectable(shown(name).c_str(), is_chosen, ImGuiSelectableFlags_DontClosePopups)) {
      if (name.ends_with('/')) {
        entered = name;
      } else {
        is_repeated = is_chosen;
        name_ = name;
      }
    }
    areas_[name] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  }
  ImGui::EndChild();
  if (!entered.empty()) enter(fs::absolute(folder_ / entered).lexically_normal().parent_path());
  return is_repeated;
}

void PathDialog::draw() {
  if (is_opening_) ImGui::OpenPopup(kPopup);
  is_opening_ = false;
  const float width = std::min(36.0F * ImGui::GetFontSize(), ImGui::GetMainViewport()->WorkSize.x);
  ImGui::SetNextWindowSize({width, 0.0F});
  if (!ImGui::BeginPopupModal((request_.title + kPopup).c_str(), nullptr, ImGuiWindowFlags_NoResize)) return;
  if (std::exchange(wants_focus_, false)) ImGui::SetKeyboardFocusHere();
  constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll;
  ImGui::SetNextItemWidth(-1.0F);
  const bool is_entered = ImGui::InputText("##name", &name_, kFlags);
  coloured_text(kDimColour, "in " + fs::absolute(folder_.empty() ? "." : folder_).lexically_normal().string());
  bool is_accepted = (draw_list() && request_.must_exist) || is_entered;

  std::error_code unknown;
  const fs::file_status status = fs::status(path(), unknown);
  const bool is_folder = fs::is_directory(status);
  const bool is_missing = request_.must_exist && !fs::exists(status) && !name_.empty();
  const bool is_replaced = !request_.must_exist && fs::exists(status) && !is_folder;
  ImGui::TextUnformatted(is_missing    ? "There is no such file."
                         : is_replaced ? "This file exists and will be replaced."
                                       : " ");
  ImGui::BeginDisabled(is_missing || name_.empty());
  is_accepted |= ImGui::Button("OK");
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool is_cancelled = ImGui::Button("Cancel") || is_pressed(GLFW_KEY_ESCAPE);
  if (is_accepted && is_folder) {
    enter(fs::absolute(path()).lexically_normal());
    name_.clear();
  }
  // A name that cannot be accepted stays, to be mended.
  wants_focus_ = is_accepted && (is_folder || is_missing);
  is_accepted = is_accepted && !wants_focus_ && !name_.empty();
  if (is_accepted || is_cancelled) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (is_accepted) request_.accept(path().string());
}

}  // namespace dolp::explore
