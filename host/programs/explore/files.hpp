// TOML files of the window: sessions and preferences.
#pragma once

#include <algorithm>
#include <cmath>

#include "explore/session.hpp"

namespace dolp::explore {

/// Writes scene, pins, snapshots, view, path of the measured points, and the parameters that vary in fits. Paths in the
/// file are relative to its folder. Copies sky files of Session::skies() to NAME_sky_ZENITH_HORIZON.csv in this folder.
/// Errors: IoError.
void save_session(const Session& session, const std::string& path);

/// Writes the scene as TOML and declares it unchanged. If its sky is a file of Session::skies(), copies the sky to
/// NAME_sky.csv beside the scene's file, and the scene then names this copy. Errors: IoError.
void save_scene(Session& session, const std::string& path);

/// Writes the finished curve as CSV with the columns of `dolp eval`. Errors: InputError if it is not finished; IoError.
void save_curve(const Session& session, const std::string& path);

/// True if save_session wrote the file. False also if the file cannot be read.
bool is_session_file(const std::string& path);

/// Shows a file: measured points (.csv), a scene, or a session from save_session.
/// Errors: InputError in one line; the session then stays unchanged.
void open_file(Session& session, const std::string& path);

/// Preferences of the user: theme, size of text, recent files.
class Preferences {
 public:
  static constexpr std::size_t kMostRecent = 10;

  /// $XDG_CONFIG_HOME/dolp/window.toml. If this variable is not set, ~/.config/dolp/window.toml. Empty if HOME is not
  /// set either.
  static std::filesystem::path default_path();

  /// Reads the file if it exists. If `path` is empty, save() does nothing. Errors: InputError for wrong content.
  void load(const std::filesystem::path& path);
  /// Errors: IoError.
  void save() const;

  /// Puts a file at the head of the recent files.
  void remember(const std::filesystem::path& file);
  /// The absolute paths of the recent files that exist, the most recent first.
  std::vector<std::string> recent() const;

  bool is_light = false;  ///< theme
  /// Factor for the size of text and controls.
  double zoom() const {
    constexpr double kStep = 1.1;
    return std::pow(kStep, zoom_steps_);
  }
  /// Enlarges text and controls by `steps` of 10 %; a negative number makes them smaller. The sum of all steps is at
  /// most 8 in each direction, so that text stays readable and controls stay in the window.
  void zoom_by(int steps) {
    constexpr int kMostSteps = 8;  // zoom to about twice or half the size
    zoom_steps_ = std::clamp(zoom_steps_ + std::clamp(steps, -2 * kMostSteps, 2 * kMostSteps), -kMostSteps, kMostSteps);
  }
  void zoom_to_default() { zoom_steps_ = 0; }

 private:
  std::filesystem::path path_;
  std::vector<std::string> recent_;
  int zoom_steps_ = 0;
};

}  // namespace dolp::explore
