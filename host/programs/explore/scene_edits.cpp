#include "explore/scene_edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <variant>

#include "base/text.hpp"
#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kCoating = "surface.coating";

/// True where a change makes an older change of `other` void.
bool replaces(const Setting& change, const std::string& other) {
  const std::string& key = change.key;
  if (other == key || other == table_of(key)) return true;
  if (key == kCoating) return other.starts_with(kCoating);
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return table_of(other) == key;
  return std::ranges::count(described(key).rivals, other) > 0;
}

/// Words of one key that exclude words of another key, and the word that the key takes when it gives way.
struct Side {
  const char* key;
  std::vector<std::string_view> words;
  const char* instead;

  bool excludes(std::string_view word) const { return std::ranges::count(words, word) > 0; }
};

// The words that are taken instead exclude nothing, so that one conflict never leads to the next.
const std::vector<std::array<Side, 2>>& conflicts() {
  const Side multiple{"surface.scattering", {"multiple"}, "single"};
  const Side direct{"emission.model", {"direct"}, "moments"};
  const Side bracket{"emission.bracket", {"true"}, "false"};
  const Side without_direct{"surface.masking", {"none", "integral"}, "v-cavity"};
  static const std::vector<std::array<Side, 2>> all = {
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

constexpr const char* kSkyHeader = "zenith_deg,temperature_K";

}  // namespace

SceneEdits::SceneEdits(const Scene& opened)
    : given_(opened.settings()), saved_(given_), changes_(given_), opened_(opened), scene_(opened) {}

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

std::vector<Setting> SceneEdits::changes_without(const std::vector<std::string>& keys) const {
  std::vector<Setting> left = changes_;
  std::erase_if(left, [&](const Setting& change) { return std::ranges::count(keys, change.key) > 0; });
  return left;
}

std::vector<std::string> films_of(const Scene& scene) {
  std::vector<std::string> films;
  for (const Key& key : dolp::keys()) {
    if (key.layer == 0) continue;
    Value value;
    if (key.type == Key::Type::kNumber) {
      if (const auto number = scene.number(key.key)) value = *number;
    } else if (const auto word = scene.word(key.key)) {
      value = *word;
    }
    if (value == Value()) continue;
    films.resize(key.layer);
    std::string& film = films.back();
    film += fmt::format("{}{} = {}", film.empty() ? "" : ", ", key.key.substr(key.key.rfind('.') + 1), value.text());
  }
  return films;
}

Setting coating_of(const std::vector<std::string>& films) {
  if (films.empty()) return {kCoating, Value()};
  return {kCoating, TomlText{fmt::format("[{{ {} }}]", fmt::join(films, " }, { "))}};
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

std::vector<Setting> needed_with(const Scene& scene, const std::vector<Setting>& chosen) {
  const std::vector<Setting> words = all_choices(scene);
  std::vector<Setting> needed;
  for (const std::array<Side, 2>& conflict : conflicts()) {
    for (const std::size_t i : {0U, 1U}) {
      const Side& side = conflict[i];
      const Side& other = conflict[1 - i];
      const auto word = word_in(chosen, side.key);
      if (!word || !side.excludes(*word) || word_in(chosen, other.key) || word_in(needed, other.key)) continue;
      const auto now = word_in(words, other.key);
      if (now && other.excludes(*now)) needed.push_back({other.key, TomlText{other.instead}});
    }
  }
  // A wind gives Gaussian slopes; another distribution begins with their sigma.
  if (word_in(chosen, "surface.distribution") == "cauchy" && scene.number("surface.wind_m_s"))
    needed.push_back({"surface.sigma", scene.number("surface.sigma").value()});
  return needed;
}

std::string SkyPair::csv() const {
  return std::string(kSkyHeader) + "\n0," + format_number(zenith_K) + "\n90," + format_number(horizon_K) + '\n';
}

std::optional<SkyPair> read_sky_pair(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string header, zenith, horizon, more;
  std::getline(file, header) && std::getline(file, zenith) && std::getline(file, horizon);
  if (header != kSkyHeader || !zenith.starts_with("0,") || !horizon.starts_with("90,") || std::getline(file, more))
    return std::nullopt;
  const std::optional<double> zenith_K = parse_number(zenith.substr(2));
  const std::optional<double> horizon_K = parse_number(horizon.substr(3));
  return zenith_K && horizon_K ? std::optional(SkyPair{*zenith_K, *horizon_K}) : std::nullopt;
}

std::filesystem::path sky_file(const Scene& scene) {
  const std::string name = scene.word("surroundings.profile").value_or("");
  if (name.empty() || name == "clear-sky" || name == "overcast") return {};
  return std::filesystem::path(scene.name()).parent_path() / name;
}

std::string SkyFiles::path(const SkyPair& sky) {
  constexpr const char* kName = "dolp-skies";
  try {
    if (!folder_) folder_.emplace(kName);
  } catch (const IoError&) {
    return kName;
  }
  const std::filesystem::path file =
      folder_->path() / ("sky_" + format_number(sky.zenith_K) + "_" + format_number(sky.horizon_K) + ".csv");
  if (!std::filesystem::exists(file)) std::ofstream(file) << sky.csv();
  return file.string();
}

}  // namespace dolp::explore
