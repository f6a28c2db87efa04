#include "scene/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "base/text.hpp"

namespace dolp {
namespace {

using Type = Key::Type;

constexpr auto kMostListed = static_cast<std::size_t>(kAxisCountRange.max);

double read_number(const SceneDocument& document, std::string_view key, const toml::node& node,
                   const NumberRange& range, const std::string& allowed) {
  const auto* integer = node.as_integer();
  const auto* real = node.as_floating_point();
  if (!integer && !real) document.fail(key, "must be " + allowed);
  // The cast rounds an integer that no double holds exactly; node.value<double>() would return nothing for it.
  const double number = integer ? static_cast<double>(integer->get()) : real->get();
  if (!range.contains(number)) document.fail(key, fmt::format("{} is out of range; must be {}", number, allowed));
  return number;
}

std::vector<double> read_list(const SceneDocument& document, const Key& description, const toml::array& array) {
  if (array.size() > kMostListed) {
    document.fail(description.key, fmt::format("{} values; must be at most {}", array.size(), kMostListed));
  }
  std::vector<double> numbers;
  for (const toml::node& element : array) {
    numbers.push_back(read_number(document, description.key, element, description.range, description.allowed()));
  }
  return numbers;
}

double read_axis_number(const SceneDocument& document, const std::string& key, const NumberRange& range) {
  const toml::node* node = document.find(key);
  const std::string allowed = "a number in " + range.text();
  if (!node) document.fail(key, "missing; must be " + allowed);
  return read_number(document, key, *node, range, allowed);
}

AxisRange read_axis_rule(const SceneDocument& document, const Key& description, const toml::table& table) {
  const std::string begin = description.key + '.';
  const std::vector<std::string> known = {"from", "to", "count", "spacing"};
  for (const auto& [name, node] : table) {
    if (std::find(known.begin(), known.end(), name.str()) != known.end()) continue;
    document.fail(begin + std::string(name.str()),
                  fmt::format("unknown key; the nearest known key is {}{}", begin, nearest_name(name.str(), known)));
  }
  AxisRange rule;
  rule.from = read_axis_number(document, begin + "from", description.range);
  rule.to = read_axis_number(document, begin + "to", description.range);
  const double count = read_axis_number(document, begin + "count", kAxisCountRange);
  if (count != std::floor(count)) document.fail(begin + "count", "must be a whole number in " + kAxisCountRange.text());
  rule.count = static_cast<std::size_t>(count);
  if (const toml::node* spacing = document.find(begin + "spacing")) {
    const std::string word = spacing->value_or(std::string());
    if (word != "linear" && word != "log") document.fail(begin + "spacing", "must be one of linear, log");
    rule.is_logarithmic = word == "log";
  }
  if (rule.count == 1 && rule.from != rule.to)
    document.fail(document.first_set({begin + "count", begin + "from", begin + "to"}), "one value needs from = to");
  for (const auto& [end, value] : {std::pair("from", rule.from), {"to", rule.to}}) {
    if (rule.is_logarithmic && value <= 0.0)
      document.fail(document.first_set({begin + end, begin + "spacing"}),
                    "spacing = \"log\" needs from > 0 and to > 0");
  }
  return rule;
}

/// The values of an axis from `from` to `to`. Both ends are exact. Exchanged ends give exactly the reversed values.
std::vector<double> axis_values(const AxisRange& rule) {
  std::vector<double> values(rule.count, rule.from);
  const auto last = static_cast<double>(rule.count - 1);
  for (std::size_t i = 1; i < rule.count; ++i) {
    const auto done = static_cast<double>(i);
    const double left = last - done;
    values[i] = rule.is_logarithmic ? std::pow(rule.from, left / last) * std::pow(rule.to, done / last)
                                    : (left * rule.from + done * rule.to) / last;
  }
  values.back() = rule.to;
  return values;
}

std::vector<double> read_axis(const SceneDocument& document, const Key& description, const toml::node& node) {
  std::vector<double> values;
  if (const toml::array* array = node.as_array()) {
    values = read_list(document, description, *array);
  } else if (const toml::table* table = node.as_table()) {
    values = axis_values(read_axis_rule(document, description, *table));
  } else {
    values.push_back(read_number(document, description.key, node, description.range, description.allowed()));
  }
  if (values.empty()) document.fail(description.key, "the list is empty; must be " + description.allowed());
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) document.fail(description.key, fmt::format("{} appears twice", *twice));
  // Axes of CF ascend or descend. Scene::remarks() tells the user that values were sorted.
  return std::ranges::is_sorted(values, std::greater<>()) ? values : sorted;
}

std::vector<double> read_pair(const SceneDocument& document, const Key& description, const toml::node& node) {
  const toml::array* array = node.as_array();
  const std::string what = "must be " + description.allowed();
  if (!array || array->size() != 2) document.fail(description.key, what);
  std::vector<double> pair = read_list(document, description, *array);
  if (!(pair[0] < pair[1])) document.fail(description.key, what);
  return pair;
}

std::vector<double> read_pairs(const SceneDocument& document, const Key& description, const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->empty() || !array->front().is_array()) return read_pair(document, description, node);
  std::vector<double> pairs;
  for (const toml::node& element : *array) {
    const std::vector<double> pair = read_pair(document, description, element);
    pairs.insert(pairs.end(), pair.begin(), pair.end());
  }
  return pairs;
}

std::vector<std::string> read_names(const SceneDocument& document, const Key& description, const toml::node& node) {
  if (node.is_string()) return {node.value_or(std::string())};
  std::vector<std::string> names;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) {
      if (!element.is_string()) document.fail(description.key, "must be " + description.allowed());
      names.push_back(element.value_or(std::string()));
    }
  }
  if (names.empty()) document.fail(description.key, "must be " + description.allowed());
  return names;
}

std::string read_word(const SceneDocument& document, const Key& description, const toml::node& node) {
  const std::string word = node.value_or(std::string());
  if (std::ranges::find(description.words, word) == description.words.end())
    document.fail(description.key, "must be " + description.allowed() + word_hint(description.key, word));
  return word;
}

std::string list_hint(const Key& description) {
  const std::string name = description.key.substr(description.key.find('.') + 1);
  const std::string axis = "grid." + name;
  if (!find_scene_key(axis)) return "";
  const char* const band = name == "wavelength_um" ? "; a band is spectrum.band_um = [from, to]" : "";
  return fmt::format("; several values are {} = [...]{}", axis, band);
}

double read_one_number(const SceneDocument& document, const Key& description, const toml::node& node) {
  const std::string hint = node.is_array() ? list_hint(description) : "";
  return read_number(document, description.key, node, description.range, description.allowed() + hint);
}

}  // namespace

KeyValue read_value(const SceneDocument& document, const Key& description) {
  const toml::node& node = *document.find(description.key);
  switch (description.type) {
    case Type::kNumber:
      return read_one_number(document, description, node);
    case Type::kWord:
      return read_word(document, description, node);
    case Type::kFlag:
      if (!node.is_boolean()) document.fail(description.key, "must be " + description.allowed());
      return node.value_or(false);
    case Type::kText:
      if (!node.is_string()) document.fail(description.key, "must be a text");
      return node.value_or(std::string());
    case Type::kPair:
      return read_pair(document, description, node);
    case Type::kNames:
      return read_names(document, description, node);
    case Type::kPairs:
      return read_pairs(document, description, node);
    case Type::kAxis:
      return read_axis(document, description, node);
  }
  return {};
}

}  // namespace dolp
