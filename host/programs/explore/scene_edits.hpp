// The scene that the window shows: a file's text with changes, choices that exclude one another, and skies of the
// window.
#pragma once

#include <dolp/dolp.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/temporary_folder.hpp"

namespace dolp::explore {

/// A scene file with changes: the window computes what `dolp eval` computes with the same settings.
class SceneEdits {
 public:
  explicit SceneEdits(const Scene& opened);
  /// A scene as it was opened, with changes. Errors: InputError, as set.
  SceneEdits(const Scene& opened, std::vector<Setting> changes) : SceneEdits(opened) { become(std::move(changes)); }

  /// Changes keys together. An effect's table without a value removes the effect, and any of its keys brings it back.
  /// Alternatives of a key (n and k, material, material file) are removed.
  /// Errors: InputError; the scene stays as it was.
  void set(const std::vector<Setting>& changes);

  /// Gives a key, or a whole table, the values of the scene as opened. Errors: InputError, as set.
  void reset(const std::string& key);
  void reset_all() { become(given_); }

  const Scene& scene() const { return scene_; }
  const Scene& opened() const { return opened_; }
  bool is_changed() const { return changes_ != saved_; }
  /// From now on the present scene counts as unchanged.
  void note_saved() { saved_ = changes_; }
  /// Goes to another state of this file or of another file; what was saved of this file stays known.
  void go_to(const SceneEdits& other);
  /// True where both have the same changes of the same file.
  bool is_same_scene(const SceneEdits& other) const { return is_same_file(other) && changes_ == other.changes_; }
  const std::vector<Setting>& changes() const { return changes_; }
  std::vector<Setting> changes_without(const std::vector<std::string>& keys) const;

 private:
  bool is_same_file(const SceneEdits& other) const;
  void become(std::vector<Setting> changes);

  std::vector<Setting> given_;  ///< settings of the command line
  std::vector<Setting> saved_;
  std::vector<Setting> changes_;
  Scene opened_;
  Scene scene_;
};

/// The films of a scene from the outside in, each as the keys of a TOML table: "n = 1.5, k = 0, thickness_um = 1".
std::vector<std::string> films_of(const Scene& scene);
/// The change of a scene that gives it these films.
Setting coating_of(const std::vector<std::string>& films);

/// The word of a value, without quotes.
std::string word_of(const Value& value);

/// Further changes that `chosen` needs: each choice of the scene that excludes a chosen one gets a word that goes with
/// it. Empty where nothing is in the way.
std::vector<Setting> needed_with(const Scene& scene, const std::vector<Setting>& chosen);

/// The choices that a scene makes in one table, as settings.
std::vector<Setting> choices_of(const Scene& scene, const std::string& table);

/// A sky whose brightness temperature is a straight line in zenith.
struct SkyPair {
  double zenith_K = 220.0;
  double horizon_K = 285.0;

  /// The file, two rows, that surroundings.profile names.
  std::string csv() const;
  friend bool operator==(const SkyPair&, const SkyPair&) = default;
};

/// Reads a file that SkyPair::csv wrote; none for any other file, and for one that cannot be read.
std::optional<SkyPair> read_sky_pair(const std::filesystem::path& file);

/// The file that a scene names as its sky; empty for a built-in sky and without a sky.
std::filesystem::path sky_file(const Scene& scene);

/// Files of the skies that the window edits, because a scene names a sky by its file. Their folder is removed at the
/// end.
class SkyFiles {
 public:
  /// The path of a sky's file. If no file can be made, the scene refuses the path.
  std::string path(const SkyPair& sky);
  bool hold(const std::filesystem::path& file) const { return folder_ && file.parent_path() == folder_->path(); }

 private:
  std::optional<TemporaryFolder> folder_;
};

}  // namespace dolp::explore
