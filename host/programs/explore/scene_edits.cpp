#include "explore/scene_edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "base/text.hpp"
#include "explore/points.hpp"

namespace dolp::explore {
namespace {

bool is_cauchy(const Scene& s) { return s.word("surface.distribution") == "cauchy"; }
bool has_no_wind(const Scene& s) { return !has_wind(s); }
bool is_diffuse(const Scene& s) { return s.number("surface.diffuse") > 0.0; }
bool has_index(const Scene& s) { return !s.word("surface.reflectance_file"); }

std::string with_number(const Scene& scene, const char* symbol, const std::string& key, const char* unit = "") {
  return fmt::format("{} {:.4g}{}", symbol, scene.number(key).value(), unit);
}

/// The material of a surface or of a film, from the table of either: a name, a file, or n and k.
std::string material_of(const Scene& scene, const std::string& table) {
  if (table == "surface" && !has_index(scene)) return *scene.word("surface.reflectance_file");
  for (const char* name : {".material", ".material_file"}) {
    if (const auto word = scene.word(table + name)) return *word;
  }
  return with_number(scene, "n", table + ".n") + ' ' + with_number(scene, "k", table + ".k");
}

/// The words that describe the shape of a surface, grouped.
std::vector<std::vector<std::string>> shape_words(const Scene& scene) {
  std::vector<std::vector<std::string>> groups = {
      {scene.word("surface.distribution").value(), has_wind(scene) ? with_number(scene, "U", "surface.wind_m_s", " m/s")
                                                                   : with_number(scene, "σ", "surface.sigma")},
      {scene.word("surface.masking").value()}};
  if (is_cauchy(scene)) groups[0].push_back(with_number(scene, "q", "surface.q"));
  if (scene.word("surface.scattering") == "multiple") groups.push_back({"all bounces"});
  return groups;
}

/// The material of a surface and its films.
std::string material_name(const Scene& scene) {
  std::string name = material_of(scene, "surface");
  for (std::size_t layer = 1; layer <= films_of(scene).size(); ++layer) {
    const std::string film = fmt::format("surface.coating.{}", layer);
    name += fmt::format(", film {} {:.4g} µm", material_of(scene, film), scene.number(film + ".thickness_um").value());
  }
  return name;
}

/// The numbers and the sky of a scene that differ from another scene's: "T 300 K, clear-sky".
std::string different_numbers(const Scene& scene, const Scene& other) {
  std::vector<std::string> words;
  for (const Parameter& parameter : parameters()) {
    const std::optional<double> value = parameter.value(scene);
    if (!value || value == parameter.value(other)) continue;
    const std::string unit = unit_text(*parameter.key);
    words.push_back(fmt::format("{} {:.4g}{}{}", parameter.symbol, *value, unit.empty() ? "" : " ", unit));
  }
  const std::string sky = scene.word("surroundings.profile").value_or("");
  if (!sky.empty() && sky != other.word("surroundings.profile"))
    words.push_back(std::filesystem::path(sky).stem().string());
  return join(words);
}

std::vector<Parameter> parameters_without_films() {
  const auto key = [](const char* name) { return &described(name); };
  return {
      {key("surface.n"), "n", {1.0, 40.0, true}, "N = n + ik", has_index},
      {key("surface.k"), "k", {0.0, 100.0}, "N = n + ik, k ≥ 0 absorbs", has_index},
      {key("surface.sigma"), "σ", {0.01, 2.0, true}, "m² = 2σ²; D(α) of eq. (8) or (1)", has_no_wind},
      {key("surface.wind_m_s"), "U", {0.0, 30.0}, "m² = 0.003 + 0.00512 U (Cox and Munk 1954), D(α) of eq. (1)"},
      {key("surface.q"), "q", {1.1, 20.0, true}, "D = (q−1)/(π m² cos⁴α) · (1 + tan²α/m²)^(−q), eq. (8)", is_cauchy},
      {key("surface.specular"), "k_s", {0.0, 1.0}, "f_s = k_s D G M / (4 cos θi cos θr), eqs. (7), (15)"},
      {key("surface.diffuse"), "k_d", {0.0, 1.0}, "f_d = (k_d/π)(cos θi cos θr)^c, eq. (14)"},
      {key("surface.diffuse_exponent"), "c", {-0.95, 0.0}, "f_d = (k_d/π)(cos θi cos θr)^c, eq. (14)", is_diffuse},
      {key("emission.temperature_K"), "T", {200.0, 400.0}, "emits (1 − ρ) B(λ, T), eq. (18)"},
      {key("source.irradiance"), "E0", {0.001, 1000.0, true}, "reflects E0 cos θ ρ, eq. (18)"},
      {key("source.relative_irradiance"), "e", {0.001, 10.0, true}, "e = E0/(π B(T)), eq. (18)"},
      {key("source.scale"), "scale", {0.01, 100.0, true}, "E0 → scale · E0"},
      {key("surroundings.temperature_K"), "T_surr", {0.0, 400.0}, "reflects B(λ, T_surr) ρ"},
      {key("path.transmittance"), "τ", {0.0, 1.0}, "I → τ I + L_path"},
      {key("path.temperature_K"), "T_path", {0.0, 400.0}, "L_path = (1 − τ) B(λ, T_path)"},
      {key("path.radiance"), "L_path", {0.001, 100.0, true}, "I → τ I + L_path"},
      {key("spectrum.wavelength_um"), "λ", {1.0, 20.0}, "B(λ, T), N(λ)"},
      {key("geometry.view_zenith_deg"), "θv", {0.0, 90.0}, "direction of the view, eq. (2)", is_bistatic},
      {key("geometry.relative_azimuth_deg"), "Δφ", {0.0, 360.0}, "cos 2β = ωi · ωr, eq. (2)", is_bistatic},
      {key("accuracy.tolerance"), "tolerance", {1e-9, 1e-2, true}, "|δDOLP|, |δρ|/ρ_I ≤ tolerance"},
  };
}

/// The control of n, k or the thickness of a film.
Parameter film_parameter(const Key& key) {
  const std::string part = key.key.substr(key.key.rfind('.') + 1);
  if (part == "n") return {&key, fmt::format("n_{}", key.layer), {0.1, 10.0, true}, "N = n + ik of the film"};
  if (part == "k") return {&key, fmt::format("k_{}", key.layer), {0.0, 10.0}, "N = n + ik of the film"};
  return {&key, fmt::format("d_{}", key.layer), {1e-3, 100.0, true}, "δ = 2π d √(N² − sin²β)/λ, the phase of a film"};
}

constexpr const char* kCoating = "surface.coating";

/// True if a change makes an older change of `other` ineffective.
bool replaces(const Setting& change, const std::string& other) {
  const std::string& key = change.key;
  if (other == key || other == table_of(key)) return true;
  if (key == kCoating) return other.starts_with(kCoating);
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return table_of(other) == key;
  return std::ranges::count(described(key).rivals, other) > 0;
}

/// Words of one key that exclude words of another key, and the replacement word of that key.
struct Side {
  const char* key;
  std::vector<std::string_view> words;
  const char* instead;

  bool excludes(std::string_view word) const { return std::ranges::count(words, word) > 0; }
};

// The replacement words exclude nothing, so one conflict never causes another.
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

const Key& described(const std::string& key) {
  const auto found = std::ranges::find(dolp::keys(), key, &Key::key);
  if (found == dolp::keys().end()) throw std::logic_error("no scene key " + key);
  return *found;
}

std::optional<double> Parameter::value(const Scene& scene) const {
  return is_used && !is_used(scene) ? std::nullopt : scene.number(key->key);
}

std::string Parameter::label() const {
  const std::string unit = unit_text(*key);
  return unit.empty() ? symbol : fmt::format("{} [{}]", symbol, unit);
}

std::optional<std::size_t> Choice::word(const Scene& scene) const {
  const std::optional<std::string> word = scene.word(key->key);
  if (!word) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find(key->words, *word) - key->words.begin());
}

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> known = parameters_without_films();
    for (const Key& key : dolp::keys()) {
      if (key.layer > 0 && key.type == Key::Type::kNumber) known.push_back(film_parameter(key));
    }
    return known;
  }();
  return all;
}

const std::vector<Choice>& choices() {
  const auto key = [](const char* name) { return &described(name); };
  static const std::vector<Choice> all = {
      {key("surface.distribution"), "distribution", "D(α): eq. (8) cauchy, eq. (1) gaussian"},
      {key("surface.masking"), "masking", "G: eqs. (9)–(13) for integral"},
      {key("surface.scattering"), "scattering", "only the first facet, or all bounces in V-grooves"},
      {key("emission.model"), "emissivity",
       "1 − ρ of the rough surface, 1 − R(θ) of the smooth one, or (1 − R) G of the facets in view"},
      {key("emission.bracket"), "bracket", "ε_I between the direct emission and 1 − ρ_I"},
      {key("geometry.mode"), "mode", "eq. (18) all around, or f of eq. (7) for one source and view"},
      {key("accuracy.precision"), "precision", "arithmetic of the device"},
  };
  return all;
}

const Parameter& parameter(const std::string& key) {
  const auto found = std::ranges::find(parameters(), key, [](const Parameter& known) { return known.key->key; });
  if (found == parameters().end()) throw std::logic_error("no parameter " + key);
  return *found;
}

Scale range_in(const Scene& scene, const Parameter& parameter) {
  constexpr Scale kSmithQ{1.6, 20.0, true};  // smith masking needs q > 1.5
  const bool is_smith = scene.word("surface.masking") == "smith" && is_cauchy(scene);
  return is_smith && parameter.key->key == "surface.q" ? kSmithQ : parameter.slider;
}

std::string table_of(const std::string& key) { return key.substr(0, key.rfind('.')); }

std::string unit_text(const Key& key) {
  if (key.unit == "1") return {};
  if (key.unit == "degree") return "°";
  if (key.unit == "um") return "µm";
  if (key.unit == "m s-1") return "m/s";
  if (key.unit == "W m-2 um-1") return "W/m²/µm";
  if (key.unit == "W m-2 sr-1 um-1") return "W/m²/sr/µm";
  return key.unit;
}

bool is_bistatic(const Scene& scene) { return scene.word("geometry.mode") == "bistatic"; }

std::string surface_name(const Scene& scene, const Scene* other) {
  std::vector<std::string> common, parts;
  if (other) {
    for (const std::vector<std::string>& group : shape_words(*other))
      common.insert(common.end(), group.begin(), group.end());
  }
  for (std::vector<std::string> words : shape_words(scene)) {
    std::erase_if(words, [&](const std::string& word) { return std::ranges::count(common, word) > 0; });
    if (!words.empty()) parts.push_back(fmt::format("{}", fmt::join(words, " ")));
  }
  const std::string material = material_name(scene);
  if (parts.empty() && material == material_name(*other)) {
    const std::string rest = different_numbers(scene, *other);
    parts.push_back(rest.empty() ? "the same surface" : rest);
  }
  parts.push_back(material);
  return join(parts);
}

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

std::vector<Film> films_of(const Scene& scene) {
  std::vector<Film> films;
  for (const Key& key : dolp::keys()) {
    if (key.layer == 0) continue;
    if (key.layer > films.size() + 1) break;
    const bool is_number = key.type == Key::Type::kNumber;
    const std::optional<double> number = is_number ? scene.number(key.key) : std::nullopt;
    const std::optional<std::string> word = is_number ? std::nullopt : scene.word(key.key);
    if (!number && !word) continue;
    films.resize(key.layer);
    films.back().push_back({key.key.substr(key.key.rfind('.') + 1), number ? Value(*number) : Value(*word)});
  }
  return films;
}

Setting coating_of(const std::vector<Film>& films) {
  if (films.empty()) return {kCoating, Value()};
  std::vector<std::string> texts;
  for (const Film& film : films) {
    std::vector<std::string> parts;
    for (const Setting& part : film) parts.push_back(part.key + " = " + part.value.text());
    texts.push_back("{ " + join(parts) + " }");
  }
  return {kCoating, TomlText{'[' + join(texts) + ']'}};
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
  // A wind implies Gaussian slopes. Another distribution starts with their sigma.
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
