// The scene that the window shows: a file's text and the changes since.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "explore/library.hpp"

namespace dolp::explore {

/// A scene file with changes: what the window computes is what `dolp eval` computes with the same settings.
class SceneEdits {
 public:
  explicit SceneEdits(const Scene& opened);

  /// Changes keys together; setting an effect's table to no value removes the effect, any key of it brings it back.
  /// Alternatives of a key (n and k, material, material file) are removed.
  /// Errors: InputError; the scene then is as it was.
  void set(const std::vector<Setting>& changes);
  void set(const std::string& key, const Value& value) { set({{key, value}}); }

  /// Takes changes of a key, or of a whole table, back: the values are those of the scene as opened.
  /// Errors: InputError, as set.
  void reset(const std::string& key);
  void reset_all();

  const Scene& scene() const { return scene_; }
  const Scene& opened() const { return opened_; }
  bool is_changed() const { return changes_ != given_; }
  /// All changes.
  const std::vector<Setting>& changes() const { return changes_; }
  /// The same without some keys.
  std::vector<Setting> changes_without(const std::vector<std::string>& keys) const;

 private:
  void become(std::vector<Setting> changes);

  std::vector<Setting> given_;  ///< of the command line
  std::vector<Setting> changes_;
  Scene opened_;
  Scene scene_;
};

}  // namespace dolp::explore
