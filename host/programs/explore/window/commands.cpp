#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/atomic_file.hpp"
#include "base/python_picture.hpp"
#include "base/stopwatch.hpp"
#include "explore/readout.hpp"
#include "explore/window/ui.hpp"
#include "terminal/embedded_texts.hpp"

namespace dolp::explore {
namespace {

constexpr auto kFading = std::chrono::milliseconds(300);  // time in which a closed dialog disappears

}  // namespace

Actions::Actions(Session& session, const std::string& device, std::string command_line,
                 const std::filesystem::path& preferences, const std::function<void()>& on_change)
    : table_task(on_change),
      true_error_task(on_change),
      fit_task(on_change),
      session_(session),
      command_line_(std::move(command_line)),
      table_evaluator_({.device = device, .is_interactive = true}),
      fit_evaluator_({.device = device, .is_interactive = true}),
      plot_task_(on_change) {
  try {
    preferences_.load(preferences);
    const std::string file = session_.scene().name();
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown)) return;  // the scene is built in or from standard input
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
  picture_path = path;
  picture_time_ = Clock::now() + kFading;
}

void Actions::save_plot(const std::string& path, const Scale& x, const Scale& y) {
  const auto work = [path, json = plot_json(session_, x, y)](const Progress&) -> BackgroundTask::Ending {
    check_writable(path);
    draw_with_python(embedded_plot_view_py().data(), json, path);
    return [text = "saved " + path] { return text; };
  };
  if (start(plot_task_, "the last figure", work)) session_.tell("drawing " + path);
}

void Actions::export_table(const std::string& path) {
  start(table_task, "the last table", [this, path, scene = session_.scene()](const Progress& progress) {
    const Clock::time_point begin = Clock::now();
    table_evaluator_.write_table(scene, path, {.progress = progress, .history = command_line_});
    return [text = fmt::format("{}: written in {:.2f} s", path, seconds_since(begin))] { return text; };
  });
}

void Actions::find_true_error() {
  if (!session_.curve().is_finished()) return;
  const auto work = [curve = session_.curve()](const Progress& progress) -> BackgroundTask::Ending {
    return [text = true_error(curve, progress)] { return text; };
  };
  if (start(true_error_task, "the last true error", work)) true_error_key_ = session_.curve().key();
}

bool Actions::is_true_error_old() const {
  return true_error_task.state() == BackgroundTask::State::kDone && true_error_key_ != session_.curve().key();
}

void Actions::fit() {
  const std::optional<FitJob> job = session_.fit_job();
  if (!job) {
    return session_.tell("a fit needs measured points, and parameters that are marked to vary", true);
  }
  const auto work = [this, job = *job](const Progress& progress) -> BackgroundTask::Ending {
    const auto phase = [this](const std::string& name) { fit_task.set_phase(name); };
    const Fit fit =
        fit_evaluator_.fit(job.edits.scene(), {job.data}, {.vary = job.vary, .progress = progress, .phase = phase});
    if (!fit.has_minimum) throw InputError("no minimum was found: no descent converged");
    return [this, job, fit] { return fit_text(fit, session_.take_fit(fit, job)); };
  };
  if (start(fit_task, "the last fit", work)) session_.tell("");
}

bool Actions::start(BackgroundTask& task, const std::string& name, const BackgroundTask::Work& work) {
  const bool is_started = task.start(work);
  if (!is_started) session_.tell(name + " is not finished yet; nothing was started", true);
  return is_started;
}

void Actions::finish() {
  for (BackgroundTask* task : {&table_task, &true_error_task}) task->finish();
  for (BackgroundTask* task : {&fit_task, &plot_task_}) {
    if (!task->is_running()) continue;
    task->finish();
    if (!task->is_running()) session_.tell(task->message(), task->state() == BackgroundTask::State::kFailed);
  }
}

namespace {

using Path = const std::string&;

/// A path for saving: the name of the scene file without its suffix, followed by `ending`. If the file saved last
/// belongs to this scene, the path is in the folder of that file, otherwise in the folder of the scene file.
std::string suggested_path(const Ui& ui, const std::string& ending) {
  const std::filesystem::path file = ui.session.scene().name();
  const std::filesystem::path folder = file == ui.saved.first ? ui.saved.second : file.parent_path();
  return (folder / ((file == "-" ? "dolp" : file.stem().string()) + ending)).string();
}

/// Opens a dialog that saves a file in one of `formats`.
void export_as(Ui& ui, const char* title, std::vector<PathDialog::Format> formats, std::size_t format = 0) {
  std::vector<std::string> suffixes;
  for (PathDialog::Format& one : formats) {
    suffixes.push_back(one.ending.substr(one.ending.find('.')));
    one.accept = [&ui, accept = one.accept](Path path) {
      ui.saved = {ui.session.scene().name(), std::filesystem::path(path).parent_path()};
      accept(path);
    };
  }
  ui.dialog.open({.title = title,
                  .path = suggested_path(ui, formats[format].ending),
                  .suffixes = suffixes,
                  .formats = formats,
                  .format = format});
}

template <auto save>  // a function of the session and a path
std::function<void(Path)> saving(Ui& ui) {
  return [&ui](Path path) { ui.actions.attempt("saved " + path, [&] { save(ui.session, path); }); };
}

/// Opens a dialog that opens a file, beginning in the folder of the scene.
void ask_for_file(Ui& ui, const char* title, const std::vector<std::string>& suffixes,
                  const std::function<void(Path)>& accept) {
  const std::filesystem::path folder = std::filesystem::path(ui.session.scene().name()).parent_path();
  ui.dialog.open({.title = title,
                  .path = folder.empty() ? "" : folder.string() + '/',
                  .suffixes = suffixes,
                  .formats = {{"", "", accept}},
                  .must_exist = true});
}

enum FigureFormat : std::size_t { kSvg, kPdf, kPng, kWindow };
template <FigureFormat format>
void export_figure(Ui& ui) {
  const auto plot = [&ui](Path path) { ui.actions.save_plot(path, ui.curves.x(), ui.curves.y()); };
  const auto window = [&ui](Path path) { ui.actions.attempt("saved " + path, [&] { ui.actions.save_picture(path); }); };
  export_as(ui, "Save a figure",
            {{"curves and view, SVG", "_plot.svg", plot},
             {"curves and view, PDF", "_plot.pdf", plot},
             {"curves and view, PNG", "_plot.png", plot},
             {"the window, PNG", "_window.png", window}},
            format);
}

enum DataFormat : std::size_t { kCurve, kTable };
template <DataFormat format>
void export_data(Ui& ui) {
  const auto table = [&ui](Path path) { ui.actions.export_table(path); };
  std::vector<PathDialog::Format> formats = {{"the curve, CSV", "_curve.csv", saving<save_curve>(ui)},
                                             {"the table of the scene's grid, NetCDF", "_table.nc", table},
                                             {"the table of the scene's grid, CSV", "_table.csv", table},
                                             {"the table of the scene's grid, NumPy", "_table.npy", table}};
  if (*swept_name(ui.session.view().panel) != '\0') {
    const std::string text = "the curve over " + ui.session.sweep_axis().label + ", CSV";
    formats.push_back({text, "_view.csv", saving<save_sweep>(ui)});
  }
  export_as(ui, "Save data", formats, format);
}

void ask_what_to_open(Ui& ui) {
  ask_for_file(ui, "Open a scene, a session (.toml) or measured points (.csv)", {".toml", ".csv"},
               [&ui](Path path) { ui.actions.open(path); });
}

void copy_command(Ui& ui) {
  const std::string command = table_command(ui.session.edits());
  ImGui::SetClipboardText(command.c_str());
  ui.session.tell("copied: " + command);
}

template <bool View::*kFlag>
void flip(Ui& ui) {
  ui.session.set_view(kFlag, !(ui.session.view().*kFlag));
}
template <bool View::*kFlag>
bool is_set(const Ui& ui) {
  return ui.session.view().*kFlag;
}
template <auto change>
void prefer(Ui& ui) {
  ui.actions.prefer(change);
}

struct Command {
  const char* menu;
  const char* text;
  const char* shortcut;  ///< "Ctrl+KEY" or "Ctrl+Shift+KEY"; empty: none
  void (*run)(Ui&);
  bool (*is_checked)(const Ui&) = nullptr;  ///< null: the entry is not a switch
  bool (*is_enabled)(const Ui&) = nullptr;  ///< null: the entry is always enabled

  bool is_pressed(bool is_shift) const {
    const std::string_view keys = shortcut;
    if (keys.empty()) return false;
    const char key = keys.back();
    if (keys.starts_with("Ctrl+Shift") != is_shift && key != '+') return false;  // some keyboards need Shift for +
    if (key == 'Z' && ImGui::GetIO().WantTextInput) return false;                // a text field uses Ctrl+Z itself
    using explore::is_pressed;
    if (key == '+') return is_pressed('=') || is_pressed(GLFW_KEY_KP_ADD);
    if (key == '-') return is_pressed(key) || is_pressed(GLFW_KEY_KP_SUBTRACT);
    if (key == '0') return is_pressed(key) || is_pressed(GLFW_KEY_KP_0);
    return is_pressed(key);  // GLFW's number of a letter key is the letter
  }
};

constexpr const char* kNoMenu = "";  // a command that has only a shortcut

constexpr Command kCommands[] = {
    {"File", "Open", "Ctrl+O", ask_what_to_open},
    {"File", "Save the scene", "Ctrl+S",
     [](Ui& ui) {
       export_as(ui, "Save the scene", {{"", "_scene.toml", saving<save_scene>(ui)}});
     }},
    {"File", "Save the session", "Ctrl+Shift+S",
     [](Ui& ui) {
       export_as(ui, "Save scene, pins, snapshots and view", {{"", "_session.toml", saving<save_session>(ui)}});
     }},
    {"File", "Remove measured points", "", [](Ui& ui) { ui.session.clear_measured(); }, nullptr,
     [](const Ui& ui) { return ui.session.residuals().data().has_value(); }},
    {"File", "Quit", "Ctrl+Q", [](Ui& ui) { ui.actions.is_quitting = true; }},
    {"Export", "Figure…", "Ctrl+Shift+E", export_figure<kSvg>},
    {"Export", "Data…", "Ctrl+E", export_data<kCurve>},
    {kNoMenu, "Export a picture of the window", "Ctrl+I", export_figure<kWindow>},
    {kNoMenu, "Export the table", "Ctrl+T", export_data<kTable>},
    {"View", "Logarithmic axis", "Ctrl+L", flip<&View::is_log>, is_set<&View::is_log>},
    {"View", "Overlay the other slope distribution", "Ctrl+D", flip<&View::has_overlay>, is_set<&View::has_overlay>},
    {"View", "Keep all effects", "Ctrl+G", flip<&View::keeps_all>, is_set<&View::keeps_all>},
    {"View", "Larger", "Ctrl++", prefer<[](Preferences& kept) { kept.zoom_by(1); }>},
    {"View", "Smaller", "Ctrl+-", prefer<[](Preferences& kept) { kept.zoom_by(-1); }>},
    {"View", "Usual size", "Ctrl+0", prefer<[](Preferences& kept) { kept.zoom_to_default(); }>},
    {"View", "Light theme", "", prefer<[](Preferences& kept) { kept.is_light = !kept.is_light; }>,
     [](const Ui& ui) { return ui.actions.preferences().is_light; }},
    {"Scene", "Undo", "Ctrl+Z", [](Ui& ui) { ui.session.undo(); }},
    {"Scene", "Redo", "Ctrl+Shift+Z", [](Ui& ui) { ui.session.redo(); }},
    {"Scene", "Copy the command that writes its table", "Ctrl+Shift+C", copy_command},
    {"Scene", "Pin the curve", "Ctrl+P", [](Ui& ui) { ui.session.pin(); }},
    {"Scene", "Take a snapshot", "Ctrl+B", [](Ui& ui) { ui.session.take_snapshot(); }},
    {"Scene", "True error of the curve", "Ctrl+K", [](Ui& ui) { ui.actions.find_true_error(); }},
    {"Scene", "Fit to the measured points", "Ctrl+F", [](Ui& ui) { ui.actions.fit(); }},
    {"Scene", "Undo all changes", "Ctrl+R", [](Ui& ui) { ui.session.reset_all(); }},
    {"Help", "Shortcuts and hints", "Ctrl+H", [](Ui& ui) { ui.shows_help = true; }},
    {"Help", "About dolp", "", [](Ui& ui) { ui.shows_about = true; }},
};

/// Names the area of the menu or entry drawn next. After BeginMenu() opens a menu, name_item() names a wrong item.
void name_next(const std::string& name, const char* text) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  name_area(name, {corner, {corner.x + ImGui::CalcTextSize(text).x, corner.y + ImGui::GetTextLineHeight()}});
}

void draw_recent(Actions& actions) {
  const std::vector<std::string> recent = actions.preferences().recent();
  name_next("recent", "Open recent");
  if (!ImGui::BeginMenu("Open recent", !recent.empty())) return;
  for (const std::string& path : recent) {
    name_next("recent " + path, path.c_str());
    if (ImGui::MenuItem(shown(path).c_str())) actions.open(path);
  }
  ImGui::EndMenu();
}

/// Draws the title of the scene as a menu with a field for another title. The scene gets it when the menu closes.
void draw_title(Ui& ui) {
  constexpr float kWidth = 30.0F;
  Session& session = ui.session;
  const std::string title = figure_title(session.edits());
  name_next("title", title.c_str());
  if (ImGui::BeginMenu((shown(title) + "###title").c_str())) {
    if (!ui.typed_title) {
      ui.typed_title = title;
      ImGui::SetKeyboardFocusHere();
    }
    ImGui::TextDisabled("title of the scene and of its figures");
    ImGui::SetNextItemWidth(kWidth * ImGui::GetFontSize());
    if (ImGui::InputText("##title", &*ui.typed_title, ImGuiInputTextFlags_EnterReturnsTrue)) ImGui::CloseCurrentPopup();
    ImGui::EndMenu();
  } else if (const auto typed = std::exchange(ui.typed_title, std::nullopt); typed && *typed != title) {
    session.set("title", *typed);
  }
}

}  // namespace

void ask_for_material(Ui& ui, const std::string& table) {
  ask_for_file(ui, "Open a file of n and k", {".csv", ".yml", ".yaml", ".txt", ".dat", ".nk", ".lnk"},
               [&ui, table](Path path) {
                 const std::string file = std::filesystem::absolute(path).lexically_normal().string();
                 ui.session.set(medium_change(ui.session.scene(), table, {{"material_file", file}}));
               });
}

void run_shortcuts(Ui& ui) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId) || !io.KeyCtrl || io.KeyAlt) return;
  for (const Command& command : kCommands) {
    if (command.is_pressed(io.KeyShift)) command.run(ui);
  }
}

void draw_menus(Ui& ui) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const char* menu : {"File", "Export", "View", "Scene", "Help"}) {
    name_next(std::string("menu ") + menu, menu);
    if (!ImGui::BeginMenu(menu)) continue;
    for (const Command& command : kCommands) {
      if (std::string_view(command.menu) != menu) continue;
      name_next(command.text, command.text);
      const bool is_checked = command.is_checked && command.is_checked(ui);
      const bool is_enabled = !command.is_enabled || command.is_enabled(ui);
      if (ImGui::MenuItem(shown(command.text).c_str(), command.shortcut, is_checked, is_enabled)) command.run(ui);
      if (&command == kCommands) draw_recent(ui.actions);  // the list of recent files follows "Open"
    }
    ImGui::EndMenu();
  }
  ImGui::TextDisabled("|");
  draw_title(ui);
  if (ui.session.edits().is_changed()) ImGui::TextDisabled("(changed)");
  ImGui::EndMainMenuBar();
}

void draw_about(Ui& ui) {
  constexpr const char* kAbout = "About dolp";
  if (std::exchange(ui.shows_about, false)) ImGui::OpenPopup(kAbout);
  if (!ImGui::BeginPopupModal(kAbout, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  for (const std::string& line : about_lines(ui.session)) ImGui::TextUnformatted(shown(line).c_str());
  if (ImGui::Button("Close") || is_pressed(GLFW_KEY_ESCAPE)) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void draw_help(Ui& ui) {
  if (!ui.shows_help) return;
  ImGui::SetNextWindowSize({36.0F * ImGui::GetFontSize(), 0.0F}, ImGuiCond_Appearing);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5F, 0.5F});
  if (is_pressed(GLFW_KEY_ESCAPE) && !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup)) ui.shows_help = false;
  if (ImGui::Begin("Shortcuts and hints", &ui.shows_help, ImGuiWindowFlags_NoCollapse)) {
    for (const Command& command : kCommands) {
      if (*command.shortcut) ImGui::BulletText("%s: %s", command.shortcut, shown(command.text).c_str());
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
