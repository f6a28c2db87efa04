#include "scene/scene_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <dolp/errors.hpp>
#include <limits>
#include <optional>
#include <sstream>
#include <variant>

#include "base/text.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostDepth = 100;

/// Position after the string that begins at `begin`. One or three quotation marks, single or double, enclose a string.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const std::string_view close = text.substr(begin).starts_with(three) ? three : std::string_view(three).substr(0, 1);
  for (std::size_t i = begin + close.size(); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text.substr(i).starts_with(close)) {
      return i + close.size();
    }
  }
  return text.size();
}

/// The line where nesting exceeds kMostDepth, else 0. There the TOML parser would recurse too deeply.
std::size_t line_of_deep_nesting(std::string_view text) {
  std::vector<std::size_t> around = {0};  // depth outside of brackets, then the depth inside each open bracket
  std::size_t depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i) - 1;
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '[' || c == '{') {
      around.push_back(++depth);
    } else if ((c == ']' || c == '}') && around.size() > 1) {
      around.pop_back();
      depth = around.back();
    } else if (c == ',' || c == '\n') {
      depth = around.back();
    } else if (c == '.') {
      ++depth;
    }
    if (depth > kMostDepth)
      return static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n')) +
             1;
  }
  return 0;
}

/// Position of a list element from its number, which counts from 1. For other texts: a position beyond every list.
std::size_t list_position(std::string_view part) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
  const bool is_number = error == std::errc() && end == part.data() + part.size() && number > 0;
  return is_number ? number - 1 : std::numeric_limits<std::size_t>::max();
}

std::string_view table_part(std::string_view key) {
  const std::size_t dot = key.find_last_of('.');
  return dot == std::string_view::npos ? std::string_view{} : key.substr(0, dot);
}

/// The fault of a text that is not TOML. If a word without quotes may be the reason, says so.
std::string toml_fault(std::string_view text, const toml::parse_error& error) {
  const toml::source_position at = error.source().begin;
  const std::vector<std::string_view> lines = split(text, '\n');
  const std::string_view line = lines[std::clamp<std::size_t>(at.line, 1, lines.size()) - 1];
  const std::size_t before = line.substr(0, at.column).find_last_of("=,[");
  std::string hint;
  if (before != std::string_view::npos) {
    const std::string_view value = line.substr(before + 1);
    const std::string_view word = trim(value.substr(0, value.find_first_of(",]}#")));
    const bool is_word = !word.empty() && (std::isalpha(static_cast<unsigned char>(word[0])) != 0 || word[0] == '/');
    if (is_word) hint = fmt::format("; a text needs quotes: \"{}\"", one_line(word));
  }
  return fmt::format("not valid TOML: {}{}", one_line(error.description()), hint);
}

/// Reads `text` as TOML, else as a number in a notation that TOML lacks, else as a word. Calls `insert` with the value.
/// Errors: InputError that begins with `origin` for a list or a table that is not TOML.
template <class Insert>
void insert_text(const std::string& text, bool is_text_key, const std::string& origin, const Insert& insert) {
  try {
    const toml::table parsed = toml::parse("v = " + text);
    const toml::node* node = parsed.get("v");
    if (parsed.size() == 1 && (!is_text_key || node->is_string())) {
      node->visit([&](const auto& value) { insert(value); });
      return;
    }
  } catch (const toml::parse_error& error) {
    const bool is_list = text.starts_with('[') || text.starts_with('{');
    if (is_list && !is_text_key) throw InputError(fmt::format("{}: {}", origin, toml_fault("v = " + text, error)));
    const std::optional<double> number = parse_number(text);
    if (number && !is_text_key) {
      insert(*number);
      return;
    }
  }
  insert(text);
}

}  // namespace

std::string toml_text(const toml::node& node, bool is_escaped) {
  if (const auto* number = node.as_floating_point()) return format_number(number->get());
  if (const auto* text = node.as_string(); text && !is_escaped) return '"' + text->get() + '"';
  std::vector<std::string> parts;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) parts.push_back(toml_text(element, is_escaped));
    return '[' + join(parts) + ']';
  }
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, value] : *table)
      parts.push_back(fmt::format("{} = {}", name.str(), toml_text(value, is_escaped)));
    return "{ " + join(parts) + " }";
  }
  std::ostringstream stream;
  const toml::value<std::string>* const string = node.as_string();
  const bool has_lines = string && string->get().find('\n') != std::string::npos;
  const auto in_lines = toml::format_flags::allow_multi_line_strings | toml::format_flags::allow_literal_strings;
  const auto all = toml::toml_formatter::default_flags;
  const auto flags = has_lines ? all & ~in_lines : all;
  node.visit([&](const auto& value) { stream << toml::toml_formatter{value, flags}; });
  return stream.str();
}

SceneDocument::SceneDocument(const std::string& text, const std::string& path_name) : name_(input_name(path_name)) {
  if (text.size() > kMostTextBytes) {
    throw InputError(fmt::format("{}: is longer than {} bytes", name_, kMostTextBytes));
  }
  if (const std::size_t line = line_of_deep_nesting(text); line > 0) {
    throw InputError(fmt::format("{}:{}: nested deeper than {}", name_, line, kMostDepth));
  }
  try {
    text_ = toml::parse(std::string_view(text));
    root_ = text_;
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", name_, error.source().begin.line, toml_fault(text, error)));
  }
}

bool is_removal(const Setting& setting) {
  const std::string value = setting.value.text();
  const bool is_none = value == "none" || value == "\"none\"" || value == "'none'";
  return std::holds_alternative<std::monostate>(setting.value.content()) || value == "{}" ||
         (is_none && is_removed_by_none(setting.key));
}

void SceneDocument::apply(const Setting& setting) {
  const std::string& key = setting.key;
  const SceneKey* const known = find_scene_key(key);
  const std::vector<std::string> tables = scene_tables();
  const bool is_known = known || is_coating(key) || std::ranges::find(tables, key) != tables.end();
  if (is_removal(setting) && !is_known)
    throw InputError(fmt::format("{}: unknown key; the nearest known key is {}", one_line(key), key_hint(key)));
  const std::string value = setting.value.text();
  const std::string origin = setting.origin.empty() ? one_line(key + " = " + value) : setting.origin;
  std::vector<std::string_view> path = split(key, '.');
  if (std::ranges::any_of(path, &std::string_view::empty)) throw InputError(origin + ": needs the key of a scene");
  if (path.size() > kMostDepth || line_of_deep_nesting(value) > 0) {
    throw InputError(fmt::format("{}: nested deeper than {}", origin, kMostDepth));
  }
  if (is_removal(setting)) {
    erase(key);
    return;
  }
  const std::string_view leaf = path.back();
  path.pop_back();
  toml::table& table = create_table(path, origin);
  drop_other_alternatives(key);
  const auto insert = [&](const auto& v) { table.insert_or_assign(leaf, v); };
  if (const auto* text = std::get_if<std::string>(&setting.value.content())) {
    insert(*text);  // this text need not be UTF-8, unlike TOML
  } else {
    const bool is_of_user = std::holds_alternative<TomlText>(setting.value.content());
    insert_text(value, is_of_user && known && known->description.type == Key::Type::kText, origin, insert);
  }
  origins_[key] = origin;
}

toml::table& SceneDocument::create_table(const std::vector<std::string_view>& path, const std::string& origin) {
  toml::table* table = &root_;
  toml::array* list = nullptr;  // null unless the next part is a position in a list
  std::string key;
  for (const std::string_view part : path) {
    if (list) {
      const std::size_t position = list_position(part);
      if (position > list->size()) {
        throw InputError(
            fmt::format("{}: {} has {} layers, and the next is {}", origin, key, list->size(), list->size() + 1));
      }
      key += '.' + std::string(part);
      if (position == list->size()) {
        list->push_back(toml::table{});
        origins_[key] = origin;
      }
      table = list->get_as<toml::table>(position);
      list = nullptr;
    } else {
      key += (key.empty() ? "" : ".") + std::string(part);
      if (!table->contains(part)) {
        if (is_coating(key)) table->insert(part, toml::array{});
        if (!is_coating(key)) table->insert(part, toml::table{});
        origins_[key] = origin;
      }
      list = is_coating(key) ? table->get_as<toml::array>(part) : nullptr;
      table = list ? table : table->get_as<toml::table>(part);
    }
    if (!table) throw InputError(fmt::format("{}: {} is not a table in this scene", origin, one_line(key)));
  }
  return *table;
}

void SceneDocument::drop_other_alternatives(const std::string& key) {
  for (const std::string& other : keys_replaced_by(key)) {
    if (!is_set(other)) erase(other);
  }
}

void SceneDocument::erase(const std::string& key) {
  const std::string_view around = table_part(key);
  toml::node* parent = around.empty() ? &root_ : const_cast<toml::node*>(find(around));
  if (toml::table* table = parent ? parent->as_table() : nullptr) table->erase(last_part(key));
  if (toml::array* list = parent ? parent->as_array() : nullptr; list && find(key))
    list->erase(list->begin() + static_cast<std::ptrdiff_t>(list_position(last_part(key))));
  std::erase_if(origins_, [&](const auto& entry) { return entry.first == key || entry.first.starts_with(key + '.'); });
}

const toml::node* SceneDocument::find_in(const toml::table& root, std::string_view key) {
  const toml::node* node = &root;
  for (const std::string_view part : split(key, '.')) {
    if (const toml::array* list = node->as_array()) {
      node = list->get(list_position(part));
    } else {
      const toml::table* table = node->as_table();
      node = table ? table->get(part) : nullptr;
    }
    if (!node) return nullptr;
  }
  return node;
}

const std::string* SceneDocument::find_origin(std::string_view key) const {
  for (;;) {
    if (const auto found = origins_.find(key); found != origins_.end()) return &found->second;
    if (table_part(key).empty()) return nullptr;
    key = table_part(key);
  }
}

unsigned SceneDocument::line_number(std::string_view key) const {
  for (; !key.empty(); key = table_part(key)) {
    const toml::node* node = find_in(text_, key);
    if (node && node->source().begin.line > 0) return node->source().begin.line;
  }
  return 1;
}

std::string SceneDocument::prefix(std::string_view key) const {
  const toml::node* node = find(key);
  // A missing part of an axis, such as grid.sigma.to, is the fault of the setting that gave the whole axis.
  const bool is_of_value = node != nullptr || find_scene_key(table_part(key)) != nullptr;
  if (const std::string* origin = is_of_value ? find_origin(key) : nullptr; origin)
    return *origin + ": " + (node ? "" : last_part(key) + ": ");
  const std::string value = node && !node->is_table() ? " = " + one_line(toml_text(*node, false)) : "";
  return fmt::format("{}:{}: {}{}: ", name_, line_number(key), one_line(key), value);
}

std::string SceneDocument::first_set(std::initializer_list<std::string> keys) const {
  const auto found = std::ranges::find_if(keys, [this](const std::string& key) { return is_set(key); });
  return found == keys.end() ? *keys.begin() : *found;
}

void SceneDocument::fail(std::string_view key, const std::string& what) const { throw InputError(prefix(key) + what); }

}  // namespace dolp
