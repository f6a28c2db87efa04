#pragma once

#include <algorithm>
#include <cmath>

#include "explore/session.hpp"

namespace dolp::explore {

void save_session(const Session& session, const std::string& path);  ///< Errors: IoError

/// Writes the scene as a file and calls Session::note_saved(). Errors: IoError.
void save_scene(Session& session, const std::string& path);

/// Writes the curve, or the curve of the view (Session::sweep()), as CSV with the columns of `dolp eval`. Errors:
/// InputError if the curve is not finished; IoError.
void save_curve(const Session& session, const std::string& path);
void save_sweep(const Session& session, const std::string& path);

bool is_session_file(const std::string& path);  ///< false also if the file cannot be read

/// Opens measured points (a .csv file), a scene or a session. Errors: InputError; `session` then stays unchanged.
void open_file(Session& session, const std::string& path);

class Preferences {
 public:
  static constexpr std::size_t kMostRecent = 10;

  /// $XDG_CONFIG_HOME/dolp/window.toml, otherwise $HOME/.config/dolp/window.toml; empty if neither variable is set.
  static std::filesystem::path default_path();

  /// Reads the file `path` if it exists. save() will write `path`, unless `path` is empty. Errors: InputError.
  void load(const std::filesystem::path& path);
  void save() const;                                 ///< Errors: IoError
  void remember(const std::filesystem::path& file);  ///< puts a file at the head of the recent files
  std::vector<std::string> recent() const;           ///< absolute paths of the files that exist, the most recent first

  bool is_light = false;  ///< theme
  double zoom() const {   // factor for the size of text and controls, in steps of 10 %
    constexpr double kStep = 1.1;
    return std::pow(kStep, zoom_steps_);
  }
  void zoom_by(int steps) {
    constexpr int kMostSteps = 8;  // at 8 steps the size is about doubled or halved
    zoom_steps_ = std::clamp(zoom_steps_ + std::clamp(steps, -2 * kMostSteps, 2 * kMostSteps), -kMostSteps, kMostSteps);
  }
  void zoom_to_default() { zoom_steps_ = 0; }

 private:
  std::filesystem::path path_;
  std::vector<std::string> recent_;
  int zoom_steps_ = 0;
};

}  // namespace dolp::explore
