// Actions of the window beyond its session: files, and work in the background.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "explore/preferences.hpp"
#include "explore/session.hpp"

namespace dolp::explore {

class Actions {
  using Clock = std::chrono::steady_clock;

 public:
  /// `preferences`: the path of their file; empty: none are kept.
  /// `on_change` is called from other threads when a task has news. The session must outlive this.
  Actions(Session& session, const std::string& device, std::string command_line,
          const std::filesystem::path& preferences, const std::function<void()>& on_change);

  // Each tells the session how it went.
  /// A scene, a session or measured points; also a file that is dropped on the window.
  void open(const std::string& path);
  void save_scene(const std::string& path);
  void save_session(const std::string& path);
  void save_curve(const std::string& path);
  /// The picture shows the window a moment later, without the dialog that asked for its path.
  void save_picture(const std::string& path);
  // In the background.
  /// Curves between these axes, and the map, as .svg, .pdf or .png.
  void save_plot(const std::string& path, const Scale& x, const Scale& y);
  void export_table(const std::string& path);
  void find_true_error();
  void fit();
  /// Changes what is kept for the next start.
  void prefer(const std::function<void(Preferences&)>& change);
  const Preferences& preferences() const { return preferences_; }
  void quit() { is_quitting_ = true; }

  /// Takes what ended in the background.
  void finish();
  bool is_quitting() const { return is_quitting_; }
  /// The path of a picture that is to be saved with the next frame; empty: none.
  std::string due_picture() const { return Clock::now() < picture_time_ ? "" : picture_path_; }
  /// Without a delay, with the next frame; an empty path: none.
  void set_picture(const std::string& path) { picture_path_ = path; }
  bool has_picture_to_save() const { return !picture_path_.empty(); }

  BackgroundTask& table_task() { return table_; }
  BackgroundTask& true_error_task() { return true_error_; }
  BackgroundTask& fit_task() { return fit_; }
  /// True where the true error is not that of the curve on display.
  bool is_true_error_old() const;

 private:
  void attempt(const std::string& done, const std::function<void()>& body);

  Session& session_;
  std::string command_line_;
  Preferences preferences_;
  // Each with a device of its own, so that none waits for another.
  Evaluator table_evaluator_;
  Evaluator fit_evaluator_;
  BackgroundTask table_;
  BackgroundTask true_error_;
  BackgroundTask fit_;
  BackgroundTask plot_;
  std::string true_error_key_;  ///< of the curve whose true error is asked for or known
  std::string picture_path_;
  Clock::time_point picture_time_;
  bool is_quitting_ = false;
};

}  // namespace dolp::explore
