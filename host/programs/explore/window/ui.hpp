#pragma once

#include "explore/files.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

/// The commands that do more than change the session: they read and write files, and start work in the background.
class Actions {
  using Clock = std::chrono::steady_clock;

 public:
  /// `preferences` is the file of the preferences; if this path is empty, no file stores them. The threads of the tasks
  /// call `on_change` when they have news. The session must outlive this object.
  Actions(Session& session, const std::string& device, std::string command_line,
          const std::filesystem::path& preferences, const std::function<void()>& on_change);

  /// Runs `body`. Then sets the session's message to `done` or to the reason of the failure.
  void attempt(const std::string& done, const std::function<void()>& body);
  void open(const std::string& path);  ///< opens a scene, a session or measured points
  /// Saves a picture of the window shortly afterwards, when the dialog for its path has disappeared. Errors: IoError.
  void save_picture(const std::string& path);
  // The next four functions start work in the background. Afterwards Session::message() has the outcome of a plot or a
  // fit. save_plot() writes the curves with the axes `x` and `y`, and the map, as .svg, .pdf or .png.
  void save_plot(const std::string& path, const Scale& x, const Scale& y);
  void export_table(const std::string& path);
  void find_true_error();
  void fit();
  void prefer(const std::function<void(Preferences&)>& change);  ///< changes and stores the preferences
  const Preferences& preferences() const { return preferences_; }

  void finish();  ///< takes the results of finished work in the background
  /// Path of the picture that must be saved with this frame; empty if none is due.
  std::string due_picture() const { return Clock::now() < picture_time_ ? "" : picture_path; }
  bool is_true_error_old() const;  ///< the true error is for a curve that is no longer on display

  std::string picture_path;  ///< file for a picture of the next frame; empty: no picture
  bool is_quitting = false;
  BackgroundTask table_task, true_error_task, fit_task;

 private:
  Session& session_;
  std::string command_line_;
  Preferences preferences_;
  // Table and fit have separate Vulkan devices, so that neither waits for the other.
  Evaluator table_evaluator_, fit_evaluator_;
  BackgroundTask plot_task_;
  std::string true_error_key_;  ///< key of the curve whose true error is known or being computed
  Clock::time_point picture_time_;
};

struct Ui {
  Session& session;
  Actions& actions;
  NumberFields fields = {};
  AxisEditor axis_editor = {};
  MapView map = {};
  ScatteringView scattering_view = {};
  ShapeView shape_view = {};
  CurveView curves = {};
  PathDialog dialog = {};
  std::pair<std::string, std::filesystem::path> saved = {};  ///< scene file, and folder last chosen for it
  bool is_narrow = false;
  std::string page = "curve";  ///< in a narrow window the only view; empty: View::panel
  bool shows_help = false;
};

/// Draws everything. Call it between ImGui's NewFrame and Render. It calls `catch_up` after the controls and before the
/// plots, so that the plots show the changes by the controls. For tests it names areas (Input::areas): "panel NAME" is
/// a tab, "cancel NAME" the button of a task, "menu NAME" a menu; others are "snapshot NUMBER", "recent PATH", and the
/// text of a menu's entry. draw_controls() and PathDialog name more.
void draw_all(Ui& ui, const std::function<void()>& catch_up);

void run_shortcuts(Ui& ui);
void draw_menus(Ui& ui);
void draw_help(Ui& ui);

}  // namespace dolp::explore
