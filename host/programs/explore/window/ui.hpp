#pragma once

#include "explore/files.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

/// Commands of the user that read and write files, or start work in the background.
class Actions {
  using Clock = std::chrono::steady_clock;

 public:
  /// `preferences` is the file of the preferences, or empty to store none. Background threads call `on_change` when
  /// their work progresses or ends. The session must outlive this object.
  Actions(Session& session, const std::string& device, std::string command_line,
          const std::filesystem::path& preferences, const std::function<void()>& on_change);

  /// Runs `body`. Then Session::message() is `done`, or the reason why `body` failed.
  void attempt(const std::string& done, const std::function<void()>& body);
  void open(const std::string& path);  ///< opens a scene, a session or measured points
  /// Saves a picture of the window to `path` when the dialog that asked for `path` has disappeared. Errors: IoError.
  void save_picture(const std::string& path);
  // The next four functions start work in the background, or tell that the last work of their kind is not finished yet.
  // save_plot() makes an .svg, .pdf or .png of curves and map.
  void save_plot(const std::string& path, const Scale& x, const Scale& y);
  void export_table(const std::string& path);
  void find_true_error();  ///< compares DOLP of the curve with the evaluator `reference`
  void fit();
  void prefer(const std::function<void(Preferences&)>& change);  ///< changes and stores the preferences
  const Preferences& preferences() const { return preferences_; }

  void finish();  ///< calls BackgroundTask::finish() of all tasks
  /// Path of the picture to save with this frame. Empty if there is none, or while a closed dialog fades out.
  std::string due_picture() const { return Clock::now() < picture_time_ ? "" : picture_path; }
  bool is_true_error_old() const;  ///< the last find_true_error() was for an earlier curve

  std::string picture_path;  ///< file of the picture to save; empty: no picture
  bool is_quitting = false;
  BackgroundTask table_task, true_error_task, fit_task;

 private:
  /// Starts a task. If it is still running, tells so with the name of its last work, and returns false.
  bool start(BackgroundTask& task, const std::string& name, const BackgroundTask::Work& work);

  Session& session_;
  std::string command_line_;
  Preferences preferences_;
  // Table and fit have separate evaluators, so that neither waits for the other.
  Evaluator table_evaluator_, fit_evaluator_;
  BackgroundTask plot_task_;
  std::string true_error_key_;  ///< Curve::key() of the curve at the last call of find_true_error()
  Clock::time_point picture_time_;
};

struct Ui {
  Session& session;
  Actions& actions;
  ControlState controls = {};
  AxisEditor axis_editor = {};
  MapView map = {};
  ScatteringView scattering_view = {};
  ShapeView shape_view = {};
  CurveView curves = {};
  PathDialog dialog = {};
  /// A scene file, and the folder where the user last saved a file for this scene; suggested_path() uses this folder.
  std::pair<std::string, std::filesystem::path> saved = {};
  std::optional<std::string> typed_title = {};  ///< while the menu of the title is open
  bool is_narrow = false;
  std::string page = "curve";  ///< page of a narrow window: "curve", "effects", "accuracy"; "": the panel View::panel
  bool shows_help = false;
  bool shows_about = false;
};

/// Draws everything. Call this function between ImGui's NewFrame and Render. Calls `catch_up` after drawing the
/// controls and before drawing the plots, so that the plots show what the user changed by the controls.
void draw_all(Ui& ui, const std::function<void()>& catch_up);

void ask_for_material(Ui& ui, const std::string& table);  ///< asks for a file of n and k for "surface", or for a film
void run_shortcuts(Ui& ui);
void draw_menus(Ui& ui);
void draw_help(Ui& ui);
void draw_about(Ui& ui);

}  // namespace dolp::explore
