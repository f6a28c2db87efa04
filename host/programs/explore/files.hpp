// TOML files of the window: sessions, and preferences that outlive it.
#pragma once

#include "explore/session.hpp"

namespace dolp::explore {

/// Writes scene, pins, snapshots, view, the path of the measured points and what a fit varies. Paths in the file are
/// relative to its folder; skies of skies() are copied into that folder, as NAME_sky_ZENITH_HORIZON.csv.
/// Errors: IoError.
void save_session(const Session& session, const std::string& path);

/// Writes the scene, which counts as unchanged from then on. A sky of the window goes into a file beside it,
/// "NAME_sky.csv", which the scene names from then on. Errors: IoError.
void save_scene(Session& session, const std::string& path);

/// Writes the finished curve with the columns of `dolp eval`. Errors: InputError before it is finished; IoError.
void save_curve(const Session& session, const std::string& path);

/// True for a file that save_session wrote; false also if it cannot be read.
bool is_session_file(const std::string& path);

/// Shows a file: measured points (.csv), a scene, or a session that save_session wrote.
/// Errors: InputError in one line; the session stays as it was.
void open_file(Session& session, const std::string& path);

/// Look and recent files.
class Preferences {
 public:
  static constexpr std::size_t kMostRecent = 10;

  /// $XDG_CONFIG_HOME/dolp/window.toml, by default in ~/.config; empty without a home.
  static std::filesystem::path default_path();

  /// Reads the file, if there is one. With an empty path nothing is kept. Errors: InputError for other content.
  void load(const std::filesystem::path& path);
  /// Errors: IoError.
  void save() const;

  /// Puts a file first among the recent ones.
  void remember(const std::filesystem::path& file);
  /// The absolute paths of the recent files that exist, the most recent first.
  std::vector<std::string> recent() const;

  bool is_light = false;  ///< theme
  /// Factor for the size of text and controls.
  double zoom() const;
  /// Makes text and controls larger by some steps, within limits that keep text readable and in the window.
  void zoom_by(int steps);
  void zoom_to_default() { zoom_steps_ = 0; }

 private:
  std::filesystem::path path_;
  std::vector<std::string> recent_;
  int zoom_steps_ = 0;
};

}  // namespace dolp::explore
