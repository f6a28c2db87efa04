// Actions of the window beyond its session: files, and work in the background.
#pragma once

#include "explore/files.hpp"

namespace dolp::explore {

class Actions {
  using Clock = std::chrono::steady_clock;

 public:
  /// `preferences`: the path of their file; empty: none are kept.
  /// Other threads call `on_change` when a task has news. The session must outlive this.
  Actions(Session& session, const std::string& device, std::string command_line,
          const std::filesystem::path& preferences, const std::function<void()>& on_change);

  /// Runs `body`, and leaves `done`, or the reason of its failure, in the session's message.
  void attempt(const std::string& done, const std::function<void()>& body);
  /// Opens a scene, a session or measured points.
  void open(const std::string& path);
  /// Saves a picture of the window a moment later, without the dialog that asked for its path. Errors: IoError.
  void save_picture(const std::string& path);
  // In the background. The session's message has the outcome of plots and fits.
  /// Draws curves between these axes, and the map, as .svg, .pdf or .png.
  void save_plot(const std::string& path, const Scale& x, const Scale& y);
  void export_table(const std::string& path);
  void find_true_error();
  void fit();
  /// Changes what is kept for the next start.
  void prefer(const std::function<void(Preferences&)>& change);
  const Preferences& preferences() const { return preferences_; }
  void quit() { is_quitting_ = true; }

  /// Takes the results of work that has ended in the background.
  void finish();
  bool is_quitting() const { return is_quitting_; }
  /// The path of a picture of the next frame; empty: none.
  std::string due_picture() const { return Clock::now() < picture_time_ ? "" : picture_path_; }
  /// Makes a picture of the next frame due at once; an empty path: none.
  void set_picture(const std::string& path) { picture_path_ = path; }
  bool has_picture_to_save() const { return !picture_path_.empty(); }

  BackgroundTask& table_task() { return table_; }
  BackgroundTask& true_error_task() { return true_error_; }
  BackgroundTask& fit_task() { return fit_; }
  /// True where the true error belongs to another curve than the one on display.
  bool is_true_error_old() const;

 private:
  Session& session_;
  std::string command_line_;
  Preferences preferences_;
  // Each has its own device, so that neither waits for the other.
  Evaluator table_evaluator_;
  Evaluator fit_evaluator_;
  BackgroundTask table_;
  BackgroundTask true_error_;
  BackgroundTask fit_;
  BackgroundTask plot_;
  std::string true_error_key_;  ///< key of the curve whose true error is known or under way
  std::string picture_path_;
  Clock::time_point picture_time_;
  bool is_quitting_ = false;
};

}  // namespace dolp::explore
