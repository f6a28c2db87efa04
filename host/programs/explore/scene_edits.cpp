#include "explore/scene_edits.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string_view>
#include <variant>

#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

/// True where a change makes an older change of `other` void.
bool replaces(const Setting& change, const std::string& other) {
  const std::string& key = change.key;
  if (other == key || other == table_of(key)) return true;
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return table_of(other) == key;
  return std::ranges::count(described(key).rivals, other) > 0;
}

/// Words of one key that exclude those of another, and the word that it takes when it gives way.
struct Side {
  const char* key;
  std::vector<std::string_view> words;
  const char* instead;

  bool excludes(std::string_view word) const { return std::ranges::find(words, word) != words.end(); }
};
using Conflict = std::array<Side, 2>;

// The words that are taken instead exclude nothing, so that one conflict never leads to the next.
const std::vector<Conflict>& conflicts() {
  const Side multiple{"surface.scattering", {"multiple"}, "single"};
  const Side direct{"emission.model", {"direct"}, "moments"};
  const Side bracket{"emission.bracket", {"true"}, "false"};
  const Side without_direct{"surface.masking", {"none", "integral"}, "v-cavity"};
  static const std::vector<Conflict> all = {
      {multiple, {"surface.masking", {"none", "integral", "smith"}, "v-cavity"}},
      {direct, without_direct},
      {direct, multiple},
      {bracket, without_direct},
      {bracket, multiple},
      {bracket, {"emission.model", {"fresnel"}, "moments"}},
      {bracket, {"geometry.mode", {"bistatic"}, "hemispherical"}},
  };
  return all;
}

std::optional<std::string> word_in(const std::vector<Setting>& changes, const std::string& key) {
  const auto found = std::ranges::find(changes, key, &Setting::key);
  return found == changes.end() ? std::nullopt : std::optional(word_of(found->value));
}

std::vector<Setting> all_choices(const Scene& scene) {
  std::vector<Setting> words;
  for (const Choice& choice : choices()) {
    const auto word = choice.word(scene);
    if (word) words.push_back({choice.key->key, TomlText{choice.key->words[*word]}});
  }
  return words;
}

}  // namespace

SceneEdits::SceneEdits(const Scene& opened)
    : given_(opened.settings()), saved_(given_), changes_(opened.settings()), opened_(opened), scene_(opened) {}

bool SceneEdits::is_same_file(const SceneEdits& other) const {
  return opened_.name() == other.opened_.name() && opened_.text() == other.opened_.text() && given_ == other.given_;
}

void SceneEdits::go_to(const SceneEdits& other) {
  std::vector<Setting> saved = is_same_file(other) ? saved_ : other.saved_;
  *this = other;
  saved_ = std::move(saved);
}

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
    if (std::ranges::find(keys, change.key) == keys.end()) left.push_back(change);
  }
  return left;
}

std::string word_of(const Value& value) {
  const auto* word = std::get_if<std::string>(&value.content());
  return word ? *word : value.text();
}

std::vector<Setting> choices_of(const Scene& scene, const std::string& table) {
  std::vector<Setting> words = all_choices(scene);
  std::erase_if(words, [&](const Setting& choice) { return table_of(choice.key) != table; });
  return words;
}

std::vector<Setting> asked_for(const Scene& scene, const std::vector<Setting>& chosen) {
  const std::vector<Setting> words = all_choices(scene);
  std::vector<Setting> asked;
  for (const Conflict& conflict : conflicts()) {
    for (const bool is_second : {false, true}) {
      const Side& own = conflict[is_second ? 1 : 0];
      const Side& other = conflict[is_second ? 0 : 1];
      const auto word = word_in(chosen, own.key);
      if (!word || !own.excludes(*word) || word_in(chosen, other.key) || word_in(asked, other.key)) continue;
      const auto now = word_in(words, other.key);
      if (now && other.excludes(*now)) asked.push_back({other.key, TomlText{other.instead}});
    }
  }
  // A wind gives Gaussian slopes; another distribution begins with its sigma.
  if (word_in(chosen, "surface.distribution") == "cauchy" && scene.number("surface.wind_m_s"))
    asked.push_back({"surface.sigma", scene.number("surface.sigma").value()});
  return asked;
}

}  // namespace dolp::explore
