// The window's files: its File menu, recent files, snapshots.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <filesystem>
#include <utility>

#include "explore/window/style.hpp"
#include "explore/window/ui.hpp"

namespace dolp::explore {

std::string Ui::suggested(const std::string& ending) const {
  const std::filesystem::path file = session_.scene().name();
  const std::filesystem::path folder = file == saved_.first ? saved_.second : file.parent_path();
  return (folder / ((file == "-" ? "dolp" : file.stem().string()) + ending)).string();
}

void Ui::remember_folder(const std::string& path) {
  saved_ = {session_.scene().name(), std::filesystem::path(path).parent_path()};
}

void Ui::ask_what_to_open() {
  std::filesystem::path folder = std::filesystem::path(session_.scene().name()).parent_path();
  dialog_.open({.title = "Open a scene, a session (.toml) or measured points (.csv)",
                .path = folder.empty() ? "" : folder.string() + '/',
                .suffixes = {".toml", ".csv"},
                .must_exist = true,
                .accept = [this](const std::string& path) { actions_.open(path); }});
}

void Ui::add_file_commands() {
  // Asks for a path, and saves something there; the ending begins with what the name gets.
  const auto save = [this](const char* title, const char* ending, const std::vector<std::string>& suffixes,
                           void (Actions::*act)(const std::string&)) {
    return [=, this] {
      dialog_.open({.title = title,
                    .path = suggested(ending),
                    .suffixes = suffixes,
                    .accept = [=, this](const std::string& path) {
                      remember_folder(path);
                      (actions_.*act)(path);
                    }});
    };
  };
  commands_ = {
      {"File", "Open", 'O', [this] { ask_what_to_open(); }},
      {"File", "Save the scene", 'S', save("Save the scene as TOML", "_scene.toml", {".toml"}, &Actions::save_scene)},
      {"File",
       "Save the session",
       'S',
       save("Save scene, pins, snapshots and view as TOML", "_session.toml", {".toml"}, &Actions::save_session),
       {},
       true},
      {"File", "Export the table", 'T',
       save("Compute the table of the scene's grid: .nc, .csv, .npy", "_table.nc", {".nc", ".csv", ".npy"},
            &Actions::export_table)},
      {"File", "Save the curve as CSV", 'E',
       save("Save the curve as CSV", "_curve.csv", {".csv"}, &Actions::save_curve)},
      {"File",
       "Save the plots",
       'E',
       [this] {
         dialog_.open({.title = "Draw curves and map: .svg, .pdf, .png",
                       .path = suggested("_plot.svg"),
                       .suffixes = {".svg", ".pdf", ".png"},
                       .accept = [this](const std::string& path) {
                         remember_folder(path);
                         actions_.save_plot(path, curve_view_.x(), curve_view_.y());
                       }});
       },
       {},
       true},
      {"File", "Save a picture", 'I',
       save("Save a picture of the window as PNG", "_window.png", {".png"}, &Actions::save_picture)},
      {.menu = "File",
       .text = "Remove measured points",
       .key = 0,
       .run = [this] { session_.clear_measured(); },
       .is_enabled = [this] { return session_.residuals().data().has_value(); }},
      {"File", "Quit", 'Q', [this] { actions_.quit(); }},
  };
}

void Ui::draw_recent() {
  const std::vector<std::string> recent = actions_.preferences().recent();
  remember_next("recent", "Open recent");
  if (!ImGui::BeginMenu("Open recent", !recent.empty())) return;
  for (const std::string& path : recent) {
    remember_next("recent " + path, path.c_str());
    if (ImGui::MenuItem(shown(path).c_str())) actions_.open(path);
  }
  ImGui::EndMenu();
}

void Ui::draw_snapshots() {
  if (session_.snapshots().empty()) return;
  ImGui::Spacing();
  ImGui::TextUnformatted("Snapshots");
  ImGui::Separator();
  std::size_t removed = session_.snapshots().size();
  for (std::size_t i = 0; i < session_.snapshots().size(); ++i) {
    const Snapshot& one = session_.snapshots()[i];
    const std::string id = fmt::format("snapshot {}", i);  // not that of a pin
    ImGui::PushID(id.c_str());
    if (ImGui::SmallButton("x")) removed = i;
    ImGui::SameLine();
    const std::string name = in_lines(shown(one.name), ImGui::GetContentRegionAvail().x);
    if (ImGui::Selectable((name + "###go").c_str(), one.edits.is_same_scene(session_.edits()))) {
      session_.go_to(one.edits);
    }
    areas_[id] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
    tooltip("back to this state of the scene; Ctrl+Z undoes it, a right click renames");
    if (const auto typed = typed_name(one.name)) session_.rename_snapshot(i, *typed);
    ImGui::PopID();
  }
  if (removed < session_.snapshots().size()) session_.remove_snapshot(removed);
}

}  // namespace dolp::explore
