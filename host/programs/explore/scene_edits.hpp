// The scene that the window shows: a file's text and the changes since; choices that exclude one another.
#pragma once

#include <dolp/dolp.hpp>
#include <string>
#include <vector>

namespace dolp::explore {

/// A scene file with changes: what the window computes is what `dolp eval` computes with the same settings.
class SceneEdits {
 public:
  explicit SceneEdits(const Scene& opened);
  /// The same with changes. Errors: InputError, as set.
  SceneEdits(const Scene& opened, std::vector<Setting> changes) : SceneEdits(opened) { become(std::move(changes)); }

  /// Changes keys together; setting an effect's table to no value removes the effect, any key of it brings it back.
  /// Alternatives of a key (n and k, material, material file) are removed.
  /// Errors: InputError; the scene then is as it was.
  void set(const std::vector<Setting>& changes);

  /// Takes changes of a key, or of a whole table, back: the values are those of the scene as opened.
  /// Errors: InputError, as set.
  void reset(const std::string& key);
  void reset_all();

  const Scene& scene() const { return scene_; }
  const Scene& opened() const { return opened_; }
  bool is_changed() const { return changes_ != saved_; }
  /// The scene as it is now counts as unchanged.
  void note_saved() { saved_ = changes_; }
  /// Goes to another state, of this file or of another; what was saved of this one stays known.
  void go_to(const SceneEdits& other);
  /// True where both are the same changes of the same file.
  bool is_same_scene(const SceneEdits& other) const { return is_same_file(other) && changes_ == other.changes_; }
  /// All changes.
  const std::vector<Setting>& changes() const { return changes_; }
  /// The same without some keys.
  std::vector<Setting> changes_without(const std::vector<std::string>& keys) const;

 private:
  bool is_same_file(const SceneEdits& other) const;
  void become(std::vector<Setting> changes);

  std::vector<Setting> given_;  ///< of the command line
  std::vector<Setting> saved_;
  std::vector<Setting> changes_;
  Scene opened_;
  Scene scene_;
};

/// The word of a value, without quotes.
std::string word_of(const Value& value);

/// The changes that `chosen` asks for elsewhere: each choice of the scene that excludes a chosen one gets a word that
/// goes with it. Empty where nothing is in the way.
std::vector<Setting> asked_for(const Scene& scene, const std::vector<Setting>& chosen);

/// The choices of one table as a scene has them: restoring the table makes these choices.
std::vector<Setting> choices_of(const Scene& scene, const std::string& table);

}  // namespace dolp::explore
