#include "explore/scene_edits.hpp"

#include <algorithm>
#include <iterator>

#include "base/text.hpp"
#include "explore/parameters.hpp"

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

/// Whether a change makes an older change of `other` void.
bool replaces(const Change& change, const std::string& other) {
  const std::string& key = change.first;
  if (other == key || other == table_of(key)) return true;
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return table_of(other) == key;
  return contains(described(key).rivals, other);
}

}  // namespace

SceneEdits::SceneEdits(const Scene& opened) : opened_(opened), scene_(opened) {
  for (const std::string& override : opened.overrides()) given_.push_back(change_of(override));
  changes_ = given_;
}

void SceneEdits::become(std::vector<Change> changes) {
  std::vector<std::string> arguments;
  for (const Change& change : changes) arguments.push_back(argument(change));
  scene_ = Scene::from_text(opened_.text(), arguments, opened_.name());
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

Scene SceneEdits::variant(const std::vector<std::string>& more) const { return scene_.with(more); }

}  // namespace dolp::explore
