#include "explore/window/widgets.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "base/text.hpp"
#include "explore/scene_edits.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPopup = "###path";
constexpr const char* kUp = "../";
constexpr float kListLines = 12.0F;

/// Sets the ends of `range` to the numbers in two texts. Returns the reason if a text is refused, otherwise "".
std::string parse_range(const std::string& low, const std::string& high, Scale& range) {
  const std::optional<double> from = parse_number(low), to = parse_number(high);
  if (!from || !to) return fmt::format("{}: must be a number", one_line(from ? high : low));
  range = {*from, *to, range.is_log};
  const std::string why = range.refusal();
  return why.empty() ? why : fmt::format("from {} to {}: {}", one_line(low), one_line(high), why);
}

/// Draws the search field of a list, which is empty when the list opens. Returns true if the user presses Enter.
bool draw_search(std::string& text) {
  if (ImGui::IsWindowAppearing()) {
    text.clear();
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1.0F);
  return ImGui::InputTextWithHint("##search", "search", &text, ImGuiInputTextFlags_EnterReturnsTrue);
}

}  // namespace

void NumberFields::draw(const std::string& id, double value, const Apply& apply) {
  const auto found = typed_.find(id);
  // Drops a refused text if the number has changed since the user typed the text.
  if (found != typed_.end() && !found->second.is_active && found->second.value != value) typed_.erase(found);
  const std::string unedited = fmt::format("{:.6g}", value);
  const bool is_refused = !reason(id).empty();
  const std::string before = typed_.contains(id) ? text(id) : unedited;
  std::string now = before;
  if (is_refused) ImGui::PushStyleColor(ImGuiCol_FrameBg, kRefusedColour);
  ImGui::PushItemFlag(ImGuiItemFlags_NoTabStop, false);
  ImGui::InputText(("##" + id).c_str(), &now, ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopItemFlag();
  name_item("field " + id);
  if (is_refused) ImGui::PopStyleColor();

  if (now != before && !typed_.contains(id)) typed_[id] = {now, value};
  const auto typed = typed_.find(id);
  if (typed == typed_.end()) return;
  const bool was_active = std::exchange(typed->second.is_active, ImGui::IsItemActive());
  typed->second.text = now;
  const bool is_ended = was_active && !typed->second.is_active;
  const bool is_free = !ImGui::IsAnyItemActive() && !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
  const bool is_taken_back = is_pressed(GLFW_KEY_ESCAPE) && (is_ended || is_free);
  if (is_taken_back || (is_ended && now == unedited)) {
    typed_.erase(typed);
  } else if (is_ended) {
    typed->second.reason = apply(now);
    if (typed->second.reason.empty()) typed_.erase(typed);
  }
}

void NumberFields::draw_end(const std::string& id, std::size_t end, const std::array<double, 2>& ends,
                            const ApplyEnds& apply) {
  const auto end_id = [&](std::size_t i) { return fmt::format("{} {}", id, i); };
  draw(end_id(end), ends[end], [&](const std::string& typed) {
    const std::string refused = text(end_id(1 - end));
    const std::string other = refused.empty() ? format_number(ends[1 - end]) : refused;
    return end == 0 ? apply(typed, other) : apply(other, typed);
  });
}

void NumberFields::draw_reason(const std::string& id) const {
  if (const std::string why = reason(id); !why.empty()) coloured_text(kErrorColour, why);
}

std::optional<std::size_t> draw_list(const List& list, std::string* search) {
  ImGui::SetNextItemWidth(list.width);
  // Stores the area of the closed list. name_item() would store a wrong area while the list is open.
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  name_area(list.id, {corner, {corner.x + ImGui::CalcItemWidth(), corner.y + ImGui::GetFrameHeight()}});
  if (!ImGui::BeginCombo(("##" + list.id).c_str(), shown(list.current).c_str(), ImGuiComboFlags_HeightLarge)) {
    if (!list.note.empty()) tooltip(list.note);
    return std::nullopt;
  }
  const bool is_entered = search && draw_search(*search);
  std::optional<std::size_t> clicked;
  std::string group;
  for (std::size_t i = 0; i < list.entries.size(); ++i) {
    const ListEntry& entry = list.entries[i];
    if (search && !has_words(entry.group + ' ' + entry.text, *search)) continue;
    if (std::exchange(group, entry.group) != entry.group) coloured_text(kHeadingColour, entry.group);
    const auto flags = entry.is_enabled ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
    const bool is_first = is_entered && !clicked && entry.is_enabled;
    if ((ImGui::Selectable(shown(entry.text).c_str(), i == list.chosen, flags) || is_first) && i != list.chosen)
      clicked = i;
    name_item(list.id + ' ' + entry.text);
    if (!entry.note.empty()) tooltip(entry.note);
  }
  if (is_entered && clicked) ImGui::CloseCurrentPopup();
  ImGui::EndCombo();
  return clicked;
}

void row_label(const std::string& text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown(text).c_str());
  // The labels form a column that is wide enough for the longest of them.
  const float longest = ImGui::CalcTextSize(shown("λ1, λ2 [µm]").c_str()).x;
  ImGui::SameLine(std::max(6.2F * ImGui::GetTextLineHeight(), longest + 2.0F * ImGui::GetStyle().ItemSpacing.x));
}

std::optional<std::string> typed_name(std::string name, const std::string& hint) {
  if (!ImGui::BeginPopupContextItem("name")) return std::nullopt;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool is_typed = ImGui::InputTextWithHint("##name", hint.c_str(), &name);
  ImGui::EndPopup();
  return is_typed ? std::optional(std::move(name)) : std::nullopt;
}

std::optional<AxisEditor::Change> AxisEditor::draw_content(const Scale& now, const Check& check) {
  std::optional<Change> change;
  const auto apply = [&](const std::string& low, const std::string& high) {
    Scale range = now;
    std::string why = parse_range(low, high, range);
    if (why.empty() && check) why = check(range);
    if (why.empty()) change = Change{range, range.is_log};
    return why;
  };
  for (const std::size_t end : {0U, 1U}) {
    ImGui::SetNextItemWidth(7.0F * ImGui::GetFontSize());
    if (std::exchange(is_opening_, false)) ImGui::SetKeyboardFocusHere();
    fields_.draw_end("axis", end, {now.from, now.to}, apply);
    ImGui::SameLine();
    ImGui::TextUnformatted(end == 0 ? "from" : "to");
    fields_.draw_reason(end == 0 ? "axis 0" : "axis 1");
  }
  bool is_log = now.is_log;
  if (ImGui::Checkbox("logarithmic", &is_log)) change = Change{std::nullopt, is_log};
  name_item("logarithmic");
  ImGui::SameLine();
  if (ImGui::Button("automatic")) change = Change{std::nullopt, now.is_log};
  return change;
}

std::optional<AxisEditor::Change> AxisEditor::draw(const std::string& label, const Area& numbers, const Scale& now,
                                                   const Check& check) {
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(numbers.min, numbers.max) &&
      ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    shown_ = label;
    is_opening_ = true;
    fields_ = {};
  }
  if (shown_ != label) return std::nullopt;
  const bool was_typed = !fields_.text("axis 0").empty() || !fields_.text("axis 1").empty();
  bool is_open = true;
  const ImVec2 mouse = ImGui::GetMousePos();
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(mouse, ImGuiCond_Appearing,
                          {mouse.x > middle.x ? 1.0F : 0.0F, mouse.y > middle.y ? 1.0F : 0.0F});
  if (is_opening_) ImGui::SetNextWindowFocus();
  constexpr ImGuiWindowFlags kEditorFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse;
  std::optional<Change> change;
  if (ImGui::Begin(shown(label).c_str(), &is_open, kEditorFlags)) change = draw_content(now, check);
  // The first Escape restores the value in a field; the next one closes the window.
  if (ImGui::IsWindowFocused() && !was_typed && is_pressed(GLFW_KEY_ESCAPE)) is_open = false;
  ImGui::End();
  if (!is_open) shown_.clear();
  if (change) fields_ = {};
  return change;
}

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
    } else if (std::ranges::count(request_.suffixes, lower_case(entry->path().extension().string())) > 0) {
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
    name_item(name);
  }
  ImGui::EndChild();
  if (!entered.empty()) enter(fs::absolute(folder_ / entered).lexically_normal().parent_path());
  return is_repeated;
}

void PathDialog::draw_formats() {
  for (std::size_t i = 0; i < request_.formats.size() && request_.formats.size() > 1; ++i) {
    const Format &old = request_.formats[request_.format], &format = request_.formats[i];
    const bool is_clicked = ImGui::RadioButton(shown(format.text).c_str(), i == request_.format);
    name_item("format " + format.text);
    if (!is_clicked) continue;
    if (name_.ends_with(old.ending)) name_.replace(name_.size() - old.ending.size(), old.ending.size(), format.ending);
    request_.format = i;
    wants_focus_ = true;
  }
}

void PathDialog::draw() {
  if (is_opening_) ImGui::OpenPopup(kPopup);
  is_opening_ = false;
  const float width = std::min(36.0F * ImGui::GetFontSize(), ImGui::GetMainViewport()->WorkSize.x);
  ImGui::SetNextWindowSize({width, 0.0F});
  if (!ImGui::BeginPopupModal((request_.title + kPopup).c_str(), nullptr, ImGuiWindowFlags_NoResize)) return;
  draw_formats();
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
  is_accepted |= ImGui::Button(request_.must_exist ? "Open" : "Save");
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool is_cancelled = ImGui::Button("Cancel") || is_pressed(GLFW_KEY_ESCAPE);
  if (is_accepted && is_folder) {
    enter(fs::absolute(path()).lexically_normal());
    name_.clear();
  }
  // For a folder or a missing file, the dialog stays open, so that the user can type another name.
  wants_focus_ = is_accepted && (is_folder || is_missing);
  is_accepted = is_accepted && !wants_focus_ && !name_.empty();
  if (is_accepted || is_cancelled) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (is_accepted) request_.formats[request_.format].accept(path().string());
}

}  // namespace dolp::explore
