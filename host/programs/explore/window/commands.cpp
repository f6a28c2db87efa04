// The window's commands: menus, shortcuts, hints and recent files; and the actions behind them.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/python_picture.hpp"
#include "base/stopwatch.hpp"
#include "explore/readout.hpp"
#include "explore/window/ui.hpp"

namespace dolp::explore {
namespace {

constexpr auto kFading = std::chrono::milliseconds(300);  // time for which a closed dialog remains visible

constexpr const char* kOpenCommand = "Open";

/// Names the area of the menu, or of the menu entry, that is drawn next. An open menu is a different item.
void name_next(const std::string& name, const char* text) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  name_area(name, {corner, {corner.x + ImGui::CalcTextSize(text).x, corner.y + ImGui::GetTextLineHeight()}});
}

}  // namespace

Actions::Actions(Session& session, const std::string& device, std::string command_line,
                 const std::filesystem::path& preferences, const std::function<void()>& on_change)
    : session_(session),
      command_line_(std::move(command_line)),
      table_evaluator_({.device = device, .is_interactive = true}),
      fit_evaluator_({.device = device, .is_interactive = true}),
      table_(on_change),
      true_error_(on_change),
      fit_(on_change),
      plot_(on_change) {
  try {
    preferences_.load(preferences);
    const std::string file = session_.scene().name();
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown)) return;  // the scene is a built-in text
    prefer([&](Preferences& kept) { kept.remember(file); });
  } catch (const std::exception& error) {
    session_.tell(error.what(), true);
  }
}

void Actions::attempt(const std::string& done, const std::function<void()>& body) {
  try {
    body();
    session_.tell(done);
  } catch (const std::exception& error) {
    session_.tell(error.what(), true);
  }
}

void Actions::open(const std::string& path) {
  attempt("opened " + path, [&] {
    open_file(session_, path);
    if (session_.message().is_error) throw InputError(session_.message().text);
    prefer([&](Preferences& preferences) { preferences.remember(path); });
  });
}

void Actions::prefer(const std::function<void(Preferences&)>& change) {
  change(preferences_);
  preferences_.save();
}

void Actions::save_picture(const std::string& path) {
  check_writable(path);
  picture_path_ = path;
  picture_time_ = Clock::now() + kFading;
}

void Actions::save_plot(const std::string& path, const Scale& x, const Scale& y) {
  session_.tell("drawing " + path);
  plot_.start([path, json = plot_json(session_, x, y)](const Progress&) -> BackgroundTask::Ending {
    check_writable(path);
    draw_with_python(kPlotScript, json, path);
    return [text = "saved " + path] { return text; };
  });
}

void Actions::export_table(const std::string& path) {
  table_.start([this, path, scene = session_.scene()](const Progress& progress) -> BackgroundTask::Ending {
    const Clock::time_point start = Clock::now();
    table_evaluator_.write_table(scene, path, {.progress = progress, .history = command_line_});
    return [text = fmt::format("{}: written in {:.2f} s", path, seconds_since(start))] { return text; };
  });
}

void Actions::find_true_error() {
  if (!session_.curve().is_finished()) return;
  true_error_key_ = session_.curve().key();
  true_error_.start([curve = session_.curve()](const Progress& progress) -> BackgroundTask::Ending {
    return [text = true_error(curve, progress)] { return text; };
  });
}

bool Actions::is_true_error_old() const {
  return true_error_.state() == BackgroundTask::State::kDone && true_error_key_ != session_.curve().key();
}

void Actions::fit() {
  const std::optional<FitJob> job = session_.fit_job();
  if (!job) {
    return session_.tell("a fit needs measured points, and parameters that are marked to vary", true);
  }
  if (!fit_.is_running()) session_.tell("");
  fit_.start([this, job = *job](const Progress& progress) -> BackgroundTask::Ending {
    const auto phase = [this](const std::string& name) { fit_.set_phase(name); };
    return [this, job, fit = run_fit(job, fit_evaluator_, progress, phase)] {
      return fit_text(fit, session_.take_fit(fit, job));
    };
  });
}

void Actions::finish() {
  for (BackgroundTask* task : {&table_, &true_error_}) task->finish();
  for (BackgroundTask* task : {&fit_, &plot_}) {
    if (!task->is_running()) continue;
    task->finish();
    if (!task->is_running()) session_.tell(task->message(), task->state() == BackgroundTask::State::kFailed);
  }
}

bool Ui::Command::is_pressed(bool is_shift) const {
  if (shortcut.empty()) return false;
  const char key = shortcut.back();
  const bool needs_shift = shortcut.starts_with("Ctrl+Shift");
  if (needs_shift != is_shift && key != '+') return false;       // on many keyboards + is above =
  if (key == 'Z' && ImGui::GetIO().WantTextInput) return false;  // the field undoes its own text
  using explore::is_pressed;
  if (key == '+') return is_pressed('=') || is_pressed(GLFW_KEY_KP_ADD);
  if (key == '-') return is_pressed(key) || is_pressed(GLFW_KEY_KP_SUBTRACT);
  if (key == '0') return is_pressed(key) || is_pressed(GLFW_KEY_KP_0);
  return is_pressed(key);  // GLFW numbers letter keys by their letters
}

std::string Ui::suggested_path(const std::string& ending) const {
  const std::filesystem::path file = session_.scene().name();
  const std::filesystem::path folder = file == saved_.first ? saved_.second : file.parent_path();
  return (folder / ((file == "-" ? "dolp" : file.stem().string()) + ending)).string();
}

std::function<void()> Ui::ask_for_path(const char* title, const char* ending, const std::vector<std::string>& suffixes,
                                       const std::function<void(const std::string&)>& accept) {
  return [=, this] {
    dialog_.open({.title = title,
                  .path = suggested_path(ending),
                  .suffixes = suffixes,
                  .accept = [=, this](const std::string& path) {
                    saved_ = {session_.scene().name(), std::filesystem::path(path).parent_path()};
                    accept(path);
                  }});
  };
}

std::function<void()> Ui::save_as(const char* title, const char* ending, const char* suffix,
                                  const std::function<void(const std::string&)>& save) {
  return ask_for_path(title, ending, {suffix}, [this, save](const std::string& path) {
    actions_.attempt("saved " + path, [&] { save(path); });
  });
}

void Ui::ask_what_to_open() {
  const std::filesystem::path folder = std::filesystem::path(session_.scene().name()).parent_path();
  dialog_.open({.title = "Open a scene, a session (.toml) or measured points (.csv)",
                .path = folder.empty() ? "" : folder.string() + '/',
                .suffixes = {".toml", ".csv"},
                .must_exist = true,
                .accept = [this](const std::string& path) { actions_.open(path); }});
}

std::vector<Ui::Command> Ui::file_commands() {
  using Path = const std::string&;
  return {
      {"File", kOpenCommand, "Ctrl+O", [this] { ask_what_to_open(); }},
      {"File", "Save the scene", "Ctrl+S",
       save_as("Save the scene as TOML", "_scene.toml", ".toml", [this](Path path) { save_scene(session_, path); })},
      {"File", "Save the session", "Ctrl+Shift+S",
       save_as("Save scene, pins, snapshots and view as TOML", "_session.toml", ".toml",
               [this](Path path) { save_session(session_, path); })},
      {"File", "Export the table", "Ctrl+T",
       ask_for_path("Compute the table of the scene's grid: .nc, .csv, .npy", "_table.nc", {".nc", ".csv", ".npy"},
                    [this](Path path) { actions_.export_table(path); })},
      {"File", "Save the curve as CSV", "Ctrl+E",
       save_as("Save the curve as CSV", "_curve.csv", ".csv", [this](Path path) { save_curve(session_, path); })},
      {"File", "Save the plots", "Ctrl+Shift+E",
       ask_for_path("Draw curves and map: .svg, .pdf, .png", "_plot.svg", {".svg", ".pdf", ".png"},
                    [this](Path path) { actions_.save_plot(path, curve_view_.x(), curve_view_.y()); })},
      {"File", "Save a picture", "Ctrl+I",
       save_as("Save a picture of the window as PNG", "_window.png", ".png",
               [this](Path path) { actions_.save_picture(path); })},
      {"File",
       "Remove measured points",
       "",
       [this] { session_.clear_measured(); },
       {},
       [this] { return session_.residuals().data().has_value(); }},
      {"File", "Quit", "Ctrl+Q", [this] { actions_.quit(); }},
  };
}

std::vector<Ui::Command> Ui::view_commands() {
  const auto flip = [this](bool View::*flag) {
    return [this, flag] { session_.set_view(flag, !(session_.view().*flag)); };
  };
  const auto is_set = [this](bool View::*flag) { return [this, flag] { return session_.view().*flag; }; };
  const auto prefer = [this](void (*change)(Preferences&)) { return [this, change] { actions_.prefer(change); }; };
  return {
      {"View", "Logarithmic axis", "Ctrl+L", flip(&View::is_log), is_set(&View::is_log)},
      {"View", "Overlay the other slope distribution", "Ctrl+D", flip(&View::has_overlay), is_set(&View::has_overlay)},
      {"View", "Keep all effects", "Ctrl+G", flip(&View::keeps_all), is_set(&View::keeps_all)},
      {"View", "Larger", "Ctrl++", prefer([](Preferences& kept) { kept.zoom_by(1); })},
      {"View", "Smaller", "Ctrl+-", prefer([](Preferences& kept) { kept.zoom_by(-1); })},
      {"View", "Usual size", "Ctrl+0", prefer([](Preferences& kept) { kept.zoom_to_default(); })},
      {"View", "Light theme", "", prefer([](Preferences& kept) { kept.is_light = !kept.is_light; }),
       [this] { return actions_.preferences().is_light; }},
  };
}

std::vector<Ui::Command> Ui::scene_commands() {
  return {
      {"Scene", "Undo", "Ctrl+Z", [this] { session_.undo(); }},
      {"Scene", "Redo", "Ctrl+Shift+Z", [this] { session_.redo(); }},
      {"Scene", "Copy the command that writes its table", "Ctrl+Shift+C", [this] { copy_command(); }},
      {"Scene", "Pin the curve", "Ctrl+P", [this] { session_.pin(); }},
      {"Scene", "Take a snapshot", "Ctrl+B", [this] { session_.take_snapshot(); }},
      {"Scene", "True error of the curve", "Ctrl+K", [this] { actions_.find_true_error(); }},
      {"Scene", "Fit to the measured points", "Ctrl+F", [this] { actions_.fit(); }},
      {"Scene", "Undo all changes", "Ctrl+R", [this] { session_.reset_all(); }},
      {"Help", "Shortcuts and hints", "Ctrl+H", [this] { shows_help_ = true; }},
  };
}

void Ui::copy_command() {
  if (session_.has_own_sky())
    return session_.tell("save the scene first: the command names its sky, which has no file yet", true);
  const std::string command = table_command(session_.edits());
  ImGui::SetClipboardText(command.c_str());
  session_.tell("copied: " + command);
}

void Ui::run_shortcuts() {
  if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId)) return;
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.KeyCtrl || io.KeyAlt) return;
  for (const Command& command : commands_) {
    if (command.is_pressed(io.KeyShift)) command.run();
  }
}

void Ui::draw_recent() {
  const std::vector<std::string> recent = actions_.preferences().recent();
  name_next("recent", "Open recent");
  if (!ImGui::BeginMenu("Open recent", !recent.empty())) return;
  for (const std::string& path : recent) {
    name_next("recent " + path, path.c_str());
    if (ImGui::MenuItem(shown(path).c_str())) actions_.open(path);
  }
  ImGui::EndMenu();
}

void Ui::draw_menus() {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const char* menu : {"File", "View", "Scene", "Help"}) {
    name_next(std::string("menu ") + menu, menu);
    if (!ImGui::BeginMenu(menu)) continue;
    for (const Command& command : commands_) {
      if (std::string_view(command.menu) != menu) continue;
      name_next(command.text, command.text);
      const bool is_checked = command.is_checked && command.is_checked();
      const bool is_enabled = !command.is_enabled || command.is_enabled();
      if (ImGui::MenuItem(command.text, command.shortcut.c_str(), is_checked, is_enabled)) command.run();
      if (command.text == kOpenCommand) draw_recent();
    }
    ImGui::EndMenu();
  }
  ImGui::TextDisabled("|");
  ImGui::TextUnformatted(shown(session_.scene().title()).c_str());
  if (session_.edits().is_changed()) ImGui::TextDisabled("(changed)");
  ImGui::EndMainMenuBar();
}

void Ui::draw_help() {
  if (!shows_help_) return;
  ImGui::SetNextWindowSize({36.0F * ImGui::GetFontSize(), 0.0F}, ImGuiCond_Appearing);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5F, 0.5F});
  if (is_pressed(GLFW_KEY_ESCAPE) && !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup)) shows_help_ = false;
  if (ImGui::Begin("Shortcuts and hints", &shows_help_, ImGuiWindowFlags_NoCollapse)) {
    for (const Command& command : commands_) {
      if (!command.shortcut.empty()) ImGui::BulletText("%s: %s", command.shortcut.c_str(), command.text);
    }
    ImGui::Separator();
    for (const char* hint :
         {"Drag in the curve: moves θ. Drag in the map: moves the parameters of its axes, and the curve follows.",
          "Wheel in the curve: zooms (with Shift only θ, with Alt only the values). Right button: moves the axes.",
          "Double click in the curve: shows all; on the numbers of an axis: edits its ends.",
          "Click in the legend: hides or shows a curve. Right click on a pin: edits its name.",
          "Ctrl-click on a slider: restores the value as opened. You can type any allowed value beside it.",
          "Rest the mouse on a control: shows meaning, equation and range.",
          "Drop a scene, a session or measured points on the window: opens them.",
          "Grey in map and curve: the model fails there; the line under the plots names the reason."}) {
      coloured_text(kTextColour, hint);
    }
  }
  ImGui::End();
}

}  // namespace dolp::explore
