#pragma once

#include "explore/readout.hpp"
#include "explore/window/screen.hpp"
#include "explore/window/ui.hpp"

namespace dolp::explore {

struct AppOptions {
  std::string device;                      ///< number of the device in `dolp devices`, or a part of its name
  std::string command_line;                ///< command line for the attribute "history" of tables
  std::filesystem::path preferences = {};  ///< file of Preferences; empty: no file
};

class App {
 public:
  App(SceneEdits edits, const AppOptions& options);  ///< Errors: the errors of Screen()

  Session& session() { return session_; }
  /// The area of a named item in the last frame. Errors: std::out_of_range if the last frame did not draw this item.
  Area control_area(const std::string& name) { return input_.areas().at(name); }
  const Ui& ui() const { return ui_; }

  /// Takes input and results, and draws one frame. Returns false if the user has closed the window.
  /// Errors: DeviceError if no device can compute, or if the device is lost.
  bool frame();
  /// Draws frames until ImGui has shown all effects of the input. Returns false if the user has closed the window.
  bool answer();
  void close();  ///< ends run(); any thread may call it
  /// Draws frames until the window is closed, and between them waits for input or results.
  void run();
  /// Draws `count` frames. If `screenshot_path` is not empty, saves a last frame with all results. Returns a text with
  /// the durations of all frames, and of the frames during computations.
  std::string run_frames(std::size_t count, const std::string& screenshot_path);

  /// True if nothing remains to be computed and the session has all results.
  bool is_idle() { return worker_.is_idle() && is_all_taken_ && !actions_.fit_task.is_running(); }
  void settle();  ///< draws frames until is_idle() is true
  void save_picture(const std::string& path) { actions_.picture_path = path; }

 private:
  void exchange();  ///< gives results to the session, and the jobs of Session::wanted() to the worker
  /// While the user drags a slider, waits briefly for the coarse curve, so that slider and curve move together.
  void catch_up();
  void draw();

  Session session_;
  Screen screen_;
  Evaluator evaluator_;
  std::atomic<bool> is_catching_up_ = false;  ///< while true, catch_up() waits for results, and they do not wake run()
  Worker worker_;
  Actions actions_;
  Input input_;
  Ui ui_;
  bool is_all_taken_ = false;
};

struct ProgramOptions : AppOptions {
  std::string measured_path;           ///< CSV of measured points; empty: none
  std::size_t frames = 0;              ///< number of frames to draw; 0: until the window is closed
  std::string screenshot_path;         ///< PNG of the last frame; empty: none
  std::string panel = {};              ///< one of kPanelNames, the view to show first; empty: the map
  std::string session_path = {};       ///< session file that replaces the scene; empty: none
  std::vector<Setting> settings = {};  ///< changes of the scene in `session_path`, from --set and similar options
};

/// Shows the window. If `frames` is not 0, prints the durations of the frames. Errors: errors of dolp/errors.hpp.
void run_program(const Scene& scene, const ProgramOptions& options);

}  // namespace dolp::explore
