// A scene as TOML, after settings were applied. It remembers which setting gave a value, for messages.
#pragma once

#include <toml++/toml.h>

#include <dolp/setting.hpp>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// True if the setting removes its key: its value is absent or `{}`, or `none` for keys with is_removed_by_none(key).
bool is_removal(const Setting& setting);

/// A value as one line of TOML. If `is_escaped` is false, texts are written without escapes, as in messages.
std::string toml_text(const toml::node& node, bool is_escaped = true);

class SceneDocument {
 public:
  SceneDocument(const SceneDocument&) = delete;
  SceneDocument& operator=(const SceneDocument&) = delete;
  SceneDocument(SceneDocument&&) = default;
  /// Errors: InputError for a syntax error, nesting deeper than 100, or a text longer than kMostTextBytes.
  SceneDocument(const std::string& text, const std::string& path_name);

  /// Gives a key another value, or removes the key. Errors: InputError, also for the removal of an unknown key.
  void apply(const Setting& setting);

  const toml::table& root() const { return root_; }
  const toml::node* find(std::string_view key) const { return find_in(root_, key); }
  bool is_set(std::string_view key) const { return find_origin(key) != nullptr; }

  /// The first of `keys` that a setting gave, else the first of all. Messages blame it if `keys` contradict each other.
  std::string first_set(std::initializer_list<std::string> keys) const;

  /// Throws an InputError with the key's line or setting, its value, and `what`.
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// The beginning of the message of fail(), before `what`.
  std::string prefix(std::string_view key) const;

  /// The line of a key's value. If the key is absent, the line of the innermost table around it, or 1.
  unsigned line_number(std::string_view key) const;

 private:
  static const toml::node* find_in(const toml::table& root, std::string_view key);
  const std::string* find_origin(std::string_view key) const;
  toml::table& create_table(const std::vector<std::string_view>& path, const std::string& origin);
  void drop_other_alternatives(const std::string& key);
  void erase(const std::string& key);

  std::string name_;
  toml::table root_;
  toml::table text_;  // without settings, for the lines of its keys; copies of nodes of toml++ have lost them
  std::map<std::string, std::string, std::less<>> origins_;  // key -> origin of the setting that gave it
};

}  // namespace dolp
