#include "explore/scene_edits.hpp"

#include <fmt/format.h>

#include <algorithm>
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
bool may_have_cross(const Scene& s) {
  const auto masking = s.word("surface.masking");
  const bool has_smith = masking == "smith" && s.word("emission.model") == "direct";
  return has_no_wind(s) && (masking == "none" || masking == "v-cavity" || has_smith);
}
bool is_diffuse(const Scene& s) { return s.number("surface.diffuse") > 0.0; }
bool has_air(const Scene& s) {
  const auto sky = s.word("surroundings.profile");
  return sky == "clear-sky" || sky == "overcast";
}
bool has_sky_ends(const Scene& s) { return s.number(kZenithSky).has_value(); }
bool has_response(const Scene& s) { return s.word("spectrum.response_file").has_value(); }
bool has_index(const Scene& s) { return !s.word("surface.reflectance_file"); }

std::string number_text(const Scene& scene, const char* key) { return control(key).text(scene.number(key).value()); }

/// The material in `table`, a TOML table such as "surface.coating.1", as text: a name, a file, or n and k.
std::string medium_name(const Scene& scene, const std::string& table) {
  if (table == "surface" && !has_index(scene)) return *scene.word("surface.reflectance_file");
  for (const char* name : {".material", ".material_file"}) {
    if (const auto word = scene.word(table + name)) return *word;
  }
  return fmt::format("n {:.4g} k {:.4g}", scene.number(table + ".n").value(), scene.number(table + ".k").value());
}

std::string width_name(const Scene& scene) {
  const bool has_cross = has_cross_slopes(scene);
  if (has_wind(scene)) return number_text(scene, "surface.wind_m_s") + (has_cross ? " directional" : "");
  const std::string width = number_text(scene, "surface.sigma");
  return has_cross ? width + ' ' + number_text(scene, kSigmaCross) : width;
}

std::vector<std::vector<std::string>> shape_words(const Scene& scene) {
  std::vector<std::vector<std::string>> groups = {{scene.word("surface.distribution").value(), width_name(scene)},
                                                  {scene.word("surface.masking").value()}};
  if (is_cauchy(scene)) groups[0].push_back(number_text(scene, "surface.q"));
  if (has_cross_slopes(scene)) groups[0].push_back(number_text(scene, kSurfaceAzimuth));
  if (scene.word("surface.scattering") == "multiple") groups.push_back({"all bounces"});
  return groups;
}

/// The numbers and the sky of `scene` that differ from `other`: "T 300 K, clear-sky".
std::string different_numbers(const Scene& scene, const Scene& other) {
  std::vector<std::string> words;
  for (const Control& control : controls()) {
    const std::optional<double> value = control.value(scene);
    if (!value || value == control.value(other) || !scene.number(control.key->key)) continue;
    words.push_back(control.text(*value));
  }
  const std::string sky = scene.word("surroundings.profile").value_or("");
  if (!sky.empty() && sky != other.word("surroundings.profile"))
    words.push_back(std::filesystem::path(sky).stem().string());
  return join(words);
}

bool has_value(const Scene& scene, const Key& key) {
  if (key.type == Key::Type::kNumber) return scene.number(key.key).has_value();
  if (key.type == Key::Type::kText) return scene.word(key.key).has_value();
  return key.type == Key::Type::kPair && !scene.numbers(key.key).empty();
}

std::vector<Control> controls_without_films() {
  const auto key = [](const char* name) { return &described(name); };
  constexpr const char* kDiffuse = "f_d = (k_d/π)(cos θi cos θr)^c, eq. (14)";
  constexpr const char* kSkyEnds = "brightness temperature; a straight line in the zenith angle between both ends";
  constexpr const char* kXAxis = "from the viewer's direction to the surface's x axis (upwind, or along the brush)";
  constexpr const char* kAir = "Idso (1981): radiance of the sky from vapour and temperature of the air at the ground";
  constexpr const char* kCross =
      "the slope width along the surface's y axis, manual section 12; at most 3 times more or less than σ";
  using Need = Control::Need;
  constexpr Need kDiffusePart{is_diffuse, "a diffuse part, k_d > 0"};
  constexpr Need kIndex{has_index, "n and k instead of measured reflectances"};
  constexpr Need kOneWidth{may_have_cross,
                           "the masking none or v-cavity (or smith with the emissivity direct), and no wind"};
  constexpr Need kBuiltInSky{has_air, "the sky clear-sky or overcast"};
  constexpr Need kTwoTemperatures{has_sky_ends, "the sky zenith and horizon"};
  constexpr Need kBistatic{is_bistatic, "the mode bistatic"};
  return {
      {key("surface.distribution"), "distribution", "D(α): eq. (8) cauchy, eq. (1) gaussian"},
      {key("surface.masking"), "masking", "G: eqs. (9)–(13) for integral"},
      {key("surface.scattering"), "scattering", "only the first facet, or all bounces in V-grooves"},
      {key("surface.diffuse_polarisation"), "diffuse light", "1 − R on the way out", {}, kDiffusePart},
      {key("surface.wind_model"), "wind", "σ² = 0.00316 U upwind, 0.003 + 0.00192 U across", {}, {has_wind, "a wind"}},
      {key("surface.n"), "n", "N = n + ik", {1.0, 40.0, true}, kIndex},
      {key("surface.k"), "k", "N = n + ik, k ≥ 0 absorbs", {0.0, 100.0}, kIndex},
      {key("surface.sigma"), "σ", "m² = 2σ²; D(α) of eq. (8) or (1)", {0.01, 2.0, true}, {has_no_wind, "no wind"}},
      {key(kSigmaCross), "σ_c", kCross, {0.01, 2.0, true}, kOneWidth, "surface.sigma"},
      {key("surface.wind_m_s"), "U", "m² = 0.003 + 0.00512 U (Cox and Munk 1954), D(α) of eq. (1)", {0.0, 30.0}},
      {key("surface.q"),
       "q",
       "D = (q−1)/(π m² cos⁴α) · (1 + tan²α/m²)^(−q), eq. (8)",
       {1.1, 20.0, true},
       {is_cauchy, "the distribution cauchy"}},
      {key("surface.specular"), "k_s", "f_s = k_s D G M / (4 cos θi cos θr), eqs. (7), (15)", {0.0, 1.0}},
      {key("surface.diffuse"), "k_d", kDiffuse, {0.0, 1.0}},
      {key("surface.diffuse_exponent"), "c", kDiffuse, {-0.95, 0.0}, kDiffusePart},
      {key("emission.model"), "emissivity",
       "1 − ρ of the rough surface, 1 − R(θ) of the smooth one, or (1 − R) G of the facets in view"},
      {key("emission.bracket"), "bracket", "ε_I between the direct emission and 1 − ρ_I"},
      {key("emission.temperature_K"), "T", "emits (1 − ρ) B(λ, T), eq. (18)", {200.0, 400.0}},
      {key("source.irradiance"), "E0", "reflects E0 cos θ ρ, eq. (18)", {0.001, 1000.0, true}},
      {key("source.relative_irradiance"), "e", "e = E0/(π B(T)), eq. (18)", {0.001, 10.0, true}},
      {key("source.scale"), "scale", "E0 → scale · E0", {0.01, 100.0, true}},
      {key("surroundings.temperature_K"), "T_surr", "reflects B(λ, T_surr) ρ", {0.0, 400.0}},
      {key(kZenithSky), "T_zenith", kSkyEnds, {150.0, 350.0}, kTwoTemperatures},
      {key(kHorizonSky), "T_horizon", kSkyEnds, {150.0, 350.0}, kTwoTemperatures},
      {key("surroundings.vapour_cm"), "water", kAir, {0.0, 2.7}, kBuiltInSky, "1.27"},
      {key("surroundings.air_temperature_K"), "T_air", kAir, {230.0, 320.0}, kBuiltInSky, "288.15"},
      {key("path.transmittance"), "τ", "I → τ I + L_path", {0.0, 1.0}},
      {key("path.temperature_K"), "T_path", "L_path = (1 − τ) B(λ, T_path)", {0.0, 400.0}},
      {key("path.radiance"), "L_path", "I → τ I + L_path", {0.001, 100.0, true}},
      {key("spectrum.wavelength_um"), "λ", "B(λ, T), N(λ)", {1.0, 20.0}},
      {key("spectrum.response_per"),
       "response",
       "weight R, or R λ/λ0 if R is per photon",
       {},
       {has_response, "a response of the camera"}},
      {key("geometry.mode"), "mode", "eq. (18) all around, or f of eq. (7) for one source and view"},
      {key("geometry.view_zenith_deg"), "θv", "direction of the view, eq. (2)", {0.0, 90.0}, kBistatic},
      {key("geometry.relative_azimuth_deg"), "Δφ", "cos 2β = ωi · ωr, eq. (2)", {0.0, 360.0}, kBistatic},
      {key(kSurfaceAzimuth), "φ_w", kXAxis, {0.0, 180.0}, {has_cross_slopes, "slopes that differ along and across"}},
      {key("accuracy.tolerance"), "tolerance", "|δDOLP|, |δρ|/ρ_I ≤ tolerance", {1e-9, 1e-2, true}},
      {key("accuracy.precision"), "precision", "arithmetic of the device"},
  };
}

Control film_control(const Key& key) {
  const std::string name = key.key.substr(key.key.rfind('.') + 1);
  if (name == "n") return {&key, fmt::format("n_{}", key.layer), "N = n + ik of the film", {0.1, 10.0, true}};
  if (name == "k") return {&key, fmt::format("k_{}", key.layer), "N = n + ik of the film", {0.0, 10.0}};
  if (name == "thickness_spread_um")
    return {&key, fmt::format("s_{}", key.layer), "the mean of M over d, with the standard deviation s", {0.0, 10.0}};
  return {&key, fmt::format("d_{}", key.layer), "δ = 2π d √(N² − sin²β)/λ, the phase of a film", {1e-3, 100.0, true}};
}

constexpr const char* kCoating = "surface.coating";

/// True if `change` replaces or removes an earlier setting of the key `other`.
bool replaces(const Setting& change, const std::string& other) {
  const std::string& key = change.key;
  if (other == key || other == parent_table(key)) return true;
  if (key == kCoating) return other.starts_with(kCoating);
  const bool is_table = key.find('.') == std::string::npos && key != "title";
  if (is_table) return parent_table(other) == key;
  return std::ranges::count(described(key).rivals, other) > 0;
}

/// Settings that conflict with nothing, so that change_with_needed() can try them. Vapour and temperature of the air
/// are removed: they require a built-in sky.
std::vector<Setting> compatible_words(const Scene& scene) {
  std::vector<Setting> words = {{"surface.masking", "v-cavity"},    {"surface.scattering", "single"},
                                {"emission.model", "moments"},      {"emission.bracket", false},
                                {"geometry.mode", "hemispherical"}, {"surface.diffuse_polarisation", "none"}};
  std::erase_if(words, [&](const Setting& word) { return !scene.word(word.key); });
  for (const char* key : {"surroundings.vapour_cm", "surroundings.air_temperature_K"}) {
    if (scene.number(key)) words.push_back({key, Value()});
  }
  return words;
}

/// Ways to give the scene one slope width, the gentlest first. A wind also requires Gaussian slopes, so the last way
/// replaces it by its sigma.
std::vector<std::vector<Setting>> ways_to_one_width(const Scene& scene) {
  if (!has_wind(scene)) return {{{kSigmaCross, Value()}, {"grid.sigma_cross", Value()}}};
  return {{{"surface.wind_model", "isotropic"}}, {{"surface.sigma", scene.number("surface.sigma").value()}}};
}

}  // namespace

const Key& described(const std::string& key) {
  const auto found = std::ranges::find(dolp::keys(), key, &Key::key);
  if (found == dolp::keys().end()) throw std::logic_error("no scene key " + key);
  return *found;
}

std::optional<double> Control::value(const Scene& scene) const {
  if (!is_number() || !may_apply(scene)) return std::nullopt;
  const std::optional<double> number = scene.number(key->key);
  if (number || standard.empty()) return number;
  const std::optional<double> typed = parse_number(standard);
  return typed ? typed : scene.number(standard);
}

std::optional<std::size_t> Control::word(const Scene& scene) const {
  const std::optional<std::string> word = is_number() || !may_apply(scene) ? std::nullopt : scene.word(key->key);
  if (!word) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find(key->words, *word) - key->words.begin());
}

std::string Control::text(double number) const {
  const std::string unit = unit_text(*key);
  return fmt::format("{} {:.4g}{}{}", label, number, unit.empty() || unit == "°" ? "" : " ", unit);
}

std::string Control::label_with_unit() const {
  const std::string unit = unit_text(*key);
  return unit.empty() ? label : fmt::format("{} [{}]", label, unit);
}

const std::vector<Control>& controls() {
  static const std::vector<Control> all = [] {
    std::vector<Control> known = controls_without_films();
    for (const Key& key : dolp::keys()) {
      if (key.layer > 0 && key.type == Key::Type::kNumber) known.push_back(film_control(key));
    }
    return known;
  }();
  return all;
}

const Control& control(std::string_view key) {
  const auto found = std::ranges::find(controls(), key, [](const Control& known) { return known.key->key; });
  if (found == controls().end()) throw std::logic_error("no control of " + std::string(key));
  return *found;
}

Scale range_in(const Scene& scene, const Control& control) {
  constexpr Scale kSmithQ{1.6, 20.0, true};     // smith masking needs q > 1.5
  constexpr Scale kDirectionalWind{0.2, 30.0};  // below 0.12 m/s the quotient of the widths is above kMostRatio
  constexpr double kMostRatio = 3.0;  // at any tolerance, slope widths along and across may have this quotient
  const std::string& key = control.key->key;
  if (key == "surface.q" && scene.word("surface.masking") == "smith" && is_cauchy(scene)) return kSmithQ;
  if (key == "surface.wind_m_s" && has_cross_slopes(scene)) return kDirectionalWind;
  if (key != "surface.sigma" && key != kSigmaCross) return control.slider;
  const std::optional<double> other = scene.number(key == kSigmaCross ? "surface.sigma" : kSigmaCross);
  return other > 0.0 ? Scale{*other / kMostRatio, *other * kMostRatio, true} : control.slider;
}

void ControlRows::follow(const Scene& opened) {
  std::string content = opened.name() + '\n' + opened.text();
  if (content == opened_) return;
  opened_ = std::move(content);
  shown_.clear();
}

bool ControlRows::stays(const Scene& scene, const Control& control) const {
  if (control.applies(scene) || !has(control.key->key)) return false;
  // Of alternatives, such as sigma and wind, only one has a row: the one that applies, otherwise the first.
  return std::ranges::none_of(controls(), [&](const Control& other) {
    const bool share_a_row =
        control.is_number() && other.is_number() && control.standard.empty() && other.standard.empty();
    const bool is_rival = share_a_row && std::ranges::count(control.key->rivals, other.key->key) > 0;
    const bool is_earlier = &other < &control && has(other.key->key);
    return is_rival && (other.applies(scene) || is_earlier);
  });
}

std::string unused_text(const Scene& scene, const Control& control) {
  if (!control.may_apply(scene)) return fmt::format("{}: needs {}", control.key->key, control.need.text);
  for (const std::string& rival : control.key->rivals) {
    if (has_value(scene, described(rival))) return fmt::format("{}: the scene has {} instead", control.key->key, rival);
  }
  return control.key->key + ": not in this scene";
}

std::string parent_table(const std::string& key) { return key.substr(0, key.rfind('.')); }

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

std::string material_name(const Scene& scene) {
  std::string name = medium_name(scene, "surface");
  for (std::size_t layer = 1; layer <= scene_films(scene).size(); ++layer) {
    const std::string film = fmt::format("surface.coating.{}", layer);
    name += fmt::format(", film {} {:.4g} µm", medium_name(scene, film), scene.number(film + ".thickness_um").value());
  }
  return name;
}

std::string slopes_name(const Scene& scene) { return fmt::format("{}", fmt::join(shape_words(scene).front(), " ")); }

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

bool SceneEdits::is_same_file(const SceneEdits& other) const {
  return opened_.name() == other.opened_.name() && opened_.text() == other.opened_.text() &&
         opened_.settings() == other.opened_.settings();
}

void SceneEdits::go_to(const SceneEdits& other) {
  std::vector<Setting> saved = is_same_file(other) ? saved_ : other.saved_;
  *this = other;
  saved_ = std::move(saved);
}

void SceneEdits::set(const std::vector<Setting>& changes) {
  std::vector<Setting> all = scene_.settings();
  for (const Setting& change : changes) {
    std::erase_if(all, [&](const Setting& old) { return replaces(change, old.key); });
  }
  all.insert(all.end(), changes.begin(), changes.end());
  become(all);
}

void SceneEdits::reset(const std::string& key) {
  const std::vector<Key>& keys = dolp::keys();
  const auto known = std::ranges::find(keys, key, &Key::key);
  const std::vector<std::string> rivals = known == keys.end() ? std::vector<std::string>{} : known->rivals;
  const auto is_of_key = [&](const Setting& change) { return change.key == key || parent_table(change.key) == key; };
  // Also the other keys of the alternative, such as k beside n, its rivals, such as a material, and the whole table.
  const auto is_of_alternative = [&](const Setting& change) {
    const auto other = std::ranges::find(keys, change.key, &Key::key);
    const bool is_beside = other != keys.end() && other->rivals == rivals;
    return is_of_key(change) || is_beside || std::ranges::count(rivals, change.key) > 0 ||
           change.key == parent_table(key);
  };
  const auto reset_all = [&](const auto& is_reset) {
    std::vector<Setting> all = changes();
    std::erase_if(all, is_reset);
    std::ranges::copy_if(opened_.settings(), std::back_inserter(all), is_reset);
    become(all);
  };
  const auto was_there = [&](const std::string& rival) { return has_value(opened_, described(rival)); };
  if (std::ranges::any_of(rivals, was_there)) return reset_all(is_of_alternative);
  try {
    reset_all(is_of_key);
  } catch (const InputError&) {
    if (rivals.empty()) throw;
    reset_all(is_of_alternative);
  }
}

std::vector<Setting> SceneEdits::changes_without(const std::vector<std::string>& keys) const {
  std::vector<Setting> left = changes();
  std::erase_if(left, [&](const Setting& change) { return std::ranges::count(keys, change.key) > 0; });
  return left;
}

std::vector<Film> scene_films(const Scene& scene) {
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

Setting coating_setting(const std::vector<Film>& films) {
  if (films.empty()) return {kCoating, Value()};
  std::vector<std::string> texts;
  for (const Film& film : films) {
    std::vector<std::string> parts;
    for (const Setting& part : film) parts.push_back(part.key + " = " + part.value.text());
    texts.push_back("{ " + join(parts) + " }");
  }
  return {kCoating, TomlText{'[' + join(texts) + ']'}};
}

std::vector<Setting> medium_change(const Scene& scene, const std::string& table, const std::vector<Setting>& medium) {
  std::vector<Setting> changes = medium;
  const std::size_t layer = described(table + ".n").layer;
  if (layer == 0) {
    for (Setting& change : changes) change.key = table + '.' + change.key;
    return changes;
  }
  std::vector<Film> films = scene_films(scene);
  Film& film = films.at(layer - 1);  // keeps the thickness and its spread, which are last in a Film
  changes.insert(changes.end(), std::ranges::find(film, "thickness_um", &Setting::key), film.end());
  film = std::move(changes);
  return {coating_setting(films)};
}

bool has_sky_profile(const Scene& scene) { return scene.word("surroundings.profile") || has_sky_ends(scene); }

bool has_effect(const Scene& scene, const std::string& table) {
  if (table == "source") return scene.number("source.scale").has_value();
  if (table == "path") return scene.number("path.transmittance").has_value();
  if (table == "surroundings" && has_sky_profile(scene)) return true;
  return scene.number(table + ".temperature_K").has_value();
}

std::optional<BuiltInMaterial> built_in_material(const Scene& scene) {
  const std::vector<BuiltInMaterial> all = materials();
  const auto found = std::ranges::find(all, scene.word("surface.material"), &BuiltInMaterial::name);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::vector<BuiltInMaterial> sorted_materials() {
  std::vector<BuiltInMaterial> all = materials();
  std::vector<std::string> kinds;  // in the order of the list
  for (const BuiltInMaterial& material : all) {
    if (std::ranges::count(kinds, material.kind) == 0) kinds.push_back(material.kind);
  }
  std::ranges::sort(all, {}, [&](const BuiltInMaterial& material) {
    return std::pair(std::ranges::find(kinds, material.kind) - kinds.begin(), lower_case(material.name));
  });
  return all;
}

bool has_words(const std::string& text, const std::string& search) {
  const std::string known = lower_case(text);
  return std::ranges::all_of(split(lower_case(search), ' '),
                             [&](std::string_view word) { return known.find(word) != std::string::npos; });
}

std::string plain_text(const Value& value) {
  const auto* word = std::get_if<std::string>(&value.content());
  return word ? *word : value.text();
}

std::vector<Setting> change_with_needed(SceneEdits& edits, const std::function<void(SceneEdits&)>& change) {
  const auto changed_after = [&](const std::vector<Setting>& words) -> std::optional<SceneEdits> {
    SceneEdits trial = edits;
    try {
      if (!words.empty()) trial.set(words);
      change(trial);
      return trial;
    } catch (const InputError&) {
      return std::nullopt;
    }
  };
  std::vector<Setting> needed;
  std::optional<SceneEdits> changed = changed_after(needed);
  for (const std::vector<Setting>& one_width : ways_to_one_width(edits.scene())) {
    if (changed) break;
    needed = compatible_words(edits.scene());
    needed.insert(needed.end(), one_width.begin(), one_width.end());
    changed = changed_after(needed);
  }
  if (!changed) change(edits);  // fails again; now the caller gets the InputError
  for (std::size_t i = needed.size(); i-- > 0;) {
    std::vector<Setting> fewer = needed;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    if (const std::optional<SceneEdits> other = changed_after(fewer)) {
      needed = std::move(fewer);
      changed = other;
    }
  }
  edits = *changed;
  return needed;
}

}  // namespace dolp::explore
