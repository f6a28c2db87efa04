// The window's content: actions, menus, panels, dialogs and shortcuts.
#pragma once

#include "explore/files.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

/// Actions outside the session: files, and work in the background.
class Actions {
  using Clock = std::chrono::steady_clock;

 public:
  /// `preferences` is the path of their file; empty: they are not stored. Other threads call `on_change` when a task
  /// has news. The session must outlive this object.
  Actions(Session& session, const std::string& device, std::string command_line,
          const std::filesystem::path& preferences, const std::function<void()>& on_change);

  /// Runs `body`. Then sets the session's message to `done` or to the reason of the failure.
  void attempt(const std::string& done, const std::function<void()>& body);
  /// Opens a scene, a session or measured points.
  void open(const std::string& path);
  /// Saves a picture of the window shortly afterwards, when the dialog for its path has disappeared. Errors: IoError.
  void save_picture(const std::string& path);
  // These run in the background. The session's message gets the outcome of plots and fits.
  // Draws curves between these axes, and the map, as .svg, .pdf or .png.
  void save_plot(const std::string& path, const Scale& x, const Scale& y);
  void export_table(const std::string& path);
  void find_true_error();
  void fit();
  /// Changes the stored preferences.
  void prefer(const std::function<void(Preferences&)>& change);
  const Preferences& preferences() const { return preferences_; }
  void quit() { is_quitting_ = true; }

  /// Takes the results of finished work in the background.
  void finish();
  bool is_quitting() const { return is_quitting_; }
  /// The path for a picture of the next frame; empty: none.
  std::string due_picture() const { return Clock::now() < picture_time_ ? "" : picture_path_; }
  /// Requests a picture of the next frame at once. An empty path requests none.
  void set_picture(const std::string& path) { picture_path_ = path; }
  bool has_picture_to_save() const { return !picture_path_.empty(); }

  BackgroundTask& table_task() { return table_; }
  BackgroundTask& true_error_task() { return true_error_; }
  BackgroundTask& fit_task() { return fit_; }
  /// True if the true error belongs to another curve than the one on display.
  bool is_true_error_old() const;

 private:
  Session& session_;
  std::string command_line_;
  Preferences preferences_;
  // Each has a separate device, so that neither waits for the other.
  Evaluator table_evaluator_;
  Evaluator fit_evaluator_;
  BackgroundTask table_;
  BackgroundTask true_error_;
  BackgroundTask fit_;
  BackgroundTask plot_;
  std::string true_error_key_;  ///< key of the curve whose true error is known or being computed
  std::string picture_path_;
  Clock::time_point picture_time_;
  bool is_quitting_ = false;
};

/// The user interface. Named areas, besides the controls and the files of a dialog: "panel NAME" of a tab, "snapshot
/// NUMBER", "menu NAME", the text of a menu's entry, "recent PATH", and "cancel NAME" of a task.
class Ui {
 public:
  /// The window calls `catch_up` between controls and plots, so that the plots show the changes by the controls.
  /// Session and actions must outlive this object.
  Ui(Session& session, Actions& actions, std::function<void()> catch_up);

  /// Draws everything. Call it between ImGui's NewFrame and Render.
  void draw();

  const CurveView& curves() const { return curve_view_; }
  const MapView& map() const { return map_view_; }

 private:
  /// A menu entry, or a line of text.
  struct Command {
    const char* menu;
    const char* text;
    std::string shortcut;  ///< "Ctrl+KEY" or "Ctrl+Shift+KEY"; empty: none
    std::function<void()> run;
    std::function<bool()> is_checked = {};  ///< empty: the entry is not a switch
    std::function<bool()> is_enabled = {};  ///< empty: the entry is always enabled

    bool is_pressed(bool is_shift) const;
  };

  // Defined in commands.cpp.
  // A path beside the scene's file, or in the folder that was last chosen for it.
  std::string suggested_path(const std::string& ending) const;
  /// Functions for commands that ask for a path and suggest one with an `ending`, or that save a file there.
  std::function<void()> ask_for_path(const char* title, const char* ending, const std::vector<std::string>& suffixes,
                                     const std::function<void(const std::string&)>& accept);
  std::function<void()> save_as(const char* title, const char* ending, const char* suffix,
                                const std::function<void(const std::string&)>& save);
  std::vector<Command> file_commands();
  std::vector<Command> view_commands();
  std::vector<Command> scene_commands();
  void ask_what_to_open();
  void copy_command();
  void draw_menus();
  void draw_recent();
  void run_shortcuts();
  void draw_help();

  /// Everything right of the controls.
  void draw_right(float window_height);
  void draw_view_controls();
  void draw_map_axes(View& view);
  void draw_fit();
  void draw_pins();
  void draw_snapshots();
  void draw_message();
  void draw_readout();
  void draw_plots(ImVec2 size);
  /// Draws one view at a time if there is no room for two.
  void draw_one_page();
  bool draw_tab(const std::string& name, bool is_shown);
  void draw_panel_tabs();
  void draw_panel(ImVec2 size);
  void draw_accuracy();
  void draw_bottom();

  Session& session_;
  Actions& actions_;
  std::pair<std::string, std::filesystem::path> saved_;  ///< scene file, and the folder to which it was last saved
  std::function<void()> catch_up_;
  std::vector<Command> commands_;
  NumberFields fields_;
  MapView map_view_;
  SweepViews sweep_views_;
  ScatteringView scattering_view_;
  ShapeView shape_view_;
  CurveView curve_view_;
  PathDialog dialog_;
  bool is_narrow_ = false;
  std::string page_ = "curve";  ///< page in a narrow window; empty: the panel
  bool shows_help_ = false;
};

}  // namespace dolp::explore
