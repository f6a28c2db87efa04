// The TOML of a scene with settings applied, which knows where each value came from.
#pragma once

#include <toml++/toml.h>

#include <dolp/setting.hpp>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// True for a setting that removes a key or a table, as a value of a program or as text.
bool is_removal(const Setting& setting);

/// A value in one line, as one would write it in TOML. Without `is_escaped`, for messages: texts between double quotes
/// as they are.
std::string toml_text(const toml::node& node, bool is_escaped = true);

class SceneDocument {
 public:
  /// Errors: InputError for a TOML syntax error, with its line, for nesting deeper than 100 and for a text longer than
  /// kMostTextBytes.
  SceneDocument(const std::string& text, const std::string& path_name);

  /// Gives a key another value, or takes it away. Errors: InputError.
  void apply(const Setting& setting);

  const toml::table& root() const { return root_; }
  const toml::node* find(std::string_view key) const;
  bool is_set(std::string_view key) const { return origin_of(key) != nullptr; }

  /// The first of these keys that a setting gave, else the first key. A message about a contradiction names it.
  std::string first_set(std::initializer_list<std::string> keys) const;

  /// Throws InputError with the place of the key's value, the key, its value and the problem. For an absent key it
  /// names the line of its table.
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// The beginning of such a message.
  std::string prefix(std::string_view key) const;

  /// The line of a key's value, or the line of the nearest table around it, or 1.
  unsigned line_of(std::string_view key) const;

 private:
  const std::string* origin_of(std::string_view key) const;
  toml::table& create_table(const std::vector<std::string_view>& path, const std::string& origin);
  void drop_other_alternatives(const std::string& key);
  void erase(const std::string& key);

  std::string name_;
  toml::table root_;
  std::map<std::string, std::string, std::less<>> origins_;  // for each key that was set: the beginning of its messages
};

}  // namespace dolp
