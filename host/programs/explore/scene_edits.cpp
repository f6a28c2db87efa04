#include "explore/scene_edits.hpp"

#include <algorithm>
#include <iterator>

#include "base/text.hpp"
#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

/// True where a change makes an older change of `other` void.
bool replaces(const Setting& change, const std::string& other) {
  const std::string& key = change.key;
  if (other == key || other == table_of(key)) return true;
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return table_of(other) == key;
  return contains(described(key).rivals, other);
}

}  // namespace

SceneEdits::SceneEdits(const Scene& opened)
    : given_(opened.settings()), changes_(opened.settings()), opened_(opened), scene_(opened) {}

void SceneEdits::become(std::vector<Setting> changes) {
  scene_ = Scene::from_text(opened_.text(), changes, opened_.name());
  changes_ = std::move(changes);
}

void SceneEdits::set(const std::vector<Setting>& changes) {
  std::vector<Setting> all = changes_;
  for (const Setting& change : changes) {
    std::erase_if(all, [&](const Setting& old) { return replaces(change, old.key); });
  }
  all.insert(all.end(), changes.begin(), changes.end());
  become(std::move(all));
}

void SceneEdits::reset(const std::string& key) {
  const auto is_of_key = [&](const Setting& change) { return change.key == key || table_of(change.key) == key; };
  std::vector<Setting> all = changes_;
  std::erase_if(all, is_of_key);
  std::ranges::copy_if(given_, std::back_inserter(all), is_of_key);
  become(std::move(all));
}

void SceneEdits::reset_all() { become(given_); }

std::vector<Setting> SceneEdits::changes_without(const std::vector<std::string>& keys) const {
  std::vector<Setting> left;
  for (const Setting& change : changes_) {
    if (!contains(keys, change.key)) left.push_back(change);
  }
  return left;
}

}  // namespace dolp::explore
