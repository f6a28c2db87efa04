// The scene that the window shows: a file's text and what was changed since.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "explore/library.hpp"

namespace dolp::explore {

/// A scene file with changes, each one a scene key and a value as in `--set KEY=VALUE`: what the window computes is
/// what `dolp eval` computes with the same overrides.
class SceneEdits {
 public:
  using Change = std::pair<std::string, std::string>;

  explicit SceneEdits(const Scene& opened);

  /// Changes keys together; "none" of an effect's table removes it, any key of it brings it back. Alternatives of a key
  /// (n and k, material, material file) go.
  /// Errors: InputError; the scene then is as it was.
  void set(const std::vector<Change>& changes);
  void set(const std::string& key, const std::string& value) { set({{key, value}}); }
  void set(const std::string& key, double value);

  /// Takes changes of a key, or of a whole table, back: the values are those of the scene as opened.
  /// Errors: InputError, as set.
  void reset(const std::string& key);
  void reset_all();

  const Scene& scene() const { return scene_; }
  const Scene& opened() const { return opened_; }
  bool is_changed() const { return changes_ != given_; }
  /// All changes, as arguments of --set.
  std::vector<std::string> overrides() const;
  /// The same without some keys.
  std::vector<std::string> overrides_without(const std::vector<std::string>& keys) const;
  /// The scene with further overrides. Errors: InputError.
  Scene variant(const std::vector<std::string>& more) const;

 private:
  void become(std::vector<Change> changes);

  std::vector<Change> given_;  ///< of the command line
  std::vector<Change> changes_;
  Scene opened_;
  Scene scene_;
};

}  // namespace dolp::explore
