// Settings of the window that outlive it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dolp::explore {

/// Look and recent files, in a file of TOML.
class Preferences {
 public:
  static constexpr std::size_t kMostRecent = 10;

  /// $XDG_CONFIG_HOME/dolp/window.toml, by default in ~/.config; empty without a home.
  static std::filesystem::path default_path();

  /// Reads the file, if there is one; an empty path keeps nothing. Errors: InputError for a file that is none of these.
  void load(const std::filesystem::path& path);
  /// Errors: IoError.
  void save() const;

  /// Puts a file at the beginning of the recent ones.
  void remember(const std::filesystem::path& file);
  /// The recent files that are there, the last one first; absolute paths.
  std::vector<std::string> recent() const;

  bool is_light = false;  ///< theme
  /// Of text and controls.
  double zoom() const;
  /// Larger by so many steps, between the limits that keep text readable and in the window.
  void zoom_by(int steps);
  void zoom_to_default() { zoom_steps_ = 0; }

 private:
  std::filesystem::path path_;
  std::vector<std::string> recent_;
  int zoom_steps_ = 0;
};

}  // namespace dolp::explore
