// The TOML of a scene after its settings were applied. It knows the origin of each value, for messages.
#pragma once

#include <toml++/toml.h>

#include <dolp/setting.hpp>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// True for an empty value, `{}`, or `none` where it removes (is_removed_by_none).
bool is_removal(const Setting& setting);

/// A value as one line of TOML. Without `is_escaped`, which is for messages, texts are quoted without escapes.
std::string toml_text(const toml::node& node, bool is_escaped = true);

class SceneDocument {
 public:
  /// Errors: InputError for a syntax error, nesting deeper than 100, or a text longer than kMostTextBytes.
  SceneDocument(const std::string& text, const std::string& path_name);

  /// Gives a key another value, or removes it. Errors: InputError.
  void apply(const Setting& setting);

  const toml::table& root() const { return root_; }
  const toml::node* find(std::string_view key) const;
  bool is_set(std::string_view key) const { return origin_of(key) != nullptr; }

  /// For a message about keys that contradict each other: the first of them that a setting gave, else the first.
  std::string first_set(std::initializer_list<std::string> keys) const;

  /// InputError with line or setting of the key, its value and the problem. An absent key has the line of the table.
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// The beginning of the message of fail(), before the problem.
  std::string prefix(std::string_view key) const;

  /// The line of a key's value, else of the nearest table around it, else 1.
  unsigned line_of(std::string_view key) const;

 private:
  const std::string* origin_of(std::string_view key) const;
  toml::table& create_table(const std::vector<std::string_view>& path, const std::string& origin);
  void drop_other_alternatives(const std::string& key);
  void erase(const std::string& key);

  std::string name_;
  toml::table root_;
  std::map<std::string, std::string, std::less<>> origins_;  // origin of each key that a setting gave
};

}  // namespace dolp
