#include "explore/scene_edits.hpp"

#include <algorithm>
#include <iterator>

#include "base/text.hpp"
#include "explore/parameters.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"
#include "scene/scene_writer.hpp"

namespace dolp::explore {
namespace {

using Change = SceneEdits::Change;

std::string argument(const Change& change) { return change.first + '=' + change.second; }

/// KEY=VALUE; without "=" the reader refuses it.
Change change_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {text, {}};
  return {std::string(trim(text.substr(0, equals))), text.substr(equals + 1)};
}

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Whether a change of `key` makes an older change of `other` void.
bool replaces(const Change& change, const std::string& other) {
  const std::string& key = change.first;
  if (other == key || other == table_of(key)) return true;
  if (is_effect_table(key) && table_of(other) == key) return true;
  for (const KeyChoice& choice : key_choices()) {
    for (const auto& alternative : choice.alternatives) {
      if (!contains(alternative, key)) continue;
      for (const auto& rival : choice.alternatives) {
        if (&rival != &alternative && contains(rival, other)) return true;
      }
    }
  }
  return false;
}

}  // namespace

SceneEdits::SceneEdits(std::string text, std::string path_name, std::vector<std::string> overrides)
    : text_(std::move(text)), path_name_(std::move(path_name)), opened_(parse_scene(text_, path_name_, overrides)) {
  for (const std::string& override : overrides) given_.push_back(change_of(override));
  changes_ = given_;
  scene_ = opened_;
}

void SceneEdits::become(std::vector<Change> changes) {
  std::vector<std::string> arguments;
  for (const Change& change : changes) arguments.push_back(argument(change));
  scene_ = parse_scene(text_, path_name_, arguments);
  changes_ = std::move(changes);
}

void SceneEdits::set(const std::vector<Change>& changes) {
  std::vector<Change> all = changes_;
  for (const Change& change : changes) {
    std::erase_if(all, [&](const Change& old) { return replaces(change, old.first); });
  }
  all.insert(all.end(), changes.begin(), changes.end());
  become(std::move(all));
}

void SceneEdits::set(const std::string& key, double value) { set(key, format_number(value)); }

void SceneEdits::reset(const std::string& key) {
  const auto is_of_key = [&](const Change& change) { return change.first == key || table_of(change.first) == key; };
  std::vector<Change> all = changes_;
  std::erase_if(all, is_of_key);
  std::ranges::copy_if(given_, std::back_inserter(all), is_of_key);
  become(std::move(all));
}

void SceneEdits::reset_all() { become(given_); }

std::vector<std::string> SceneEdits::overrides() const { return overrides_without({}); }

std::vector<std::string> SceneEdits::overrides_without(const std::vector<std::string>& keys) const {
  std::vector<std::string> arguments;
  for (const Change& change : changes_) {
    if (!contains(keys, change.first)) arguments.push_back(argument(change));
  }
  return arguments;
}

Scene SceneEdits::variant(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments = overrides();
  arguments.insert(arguments.end(), more.begin(), more.end());
  return parse_scene(text_, path_name_, arguments);
}

std::string SceneEdits::toml(const std::filesystem::path& folder) const {
  return scene_toml(text_, path_name_, overrides(), folder);
}

}  // namespace dolp::explore
