#include "scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <dolp/errors.hpp>
#include <iterator>
#include <numeric>

#include "base/text.hpp"
#include "model/films.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

void append_layer_keys(const SceneDocument& document, const std::string& coating, const toml::node& node,
                       std::vector<std::string>& keys) {
  const std::string allowed = fmt::format(
      "must be a list of at most {} tables, from the outside in: [{{ material = \"...\", thickness_um = 0.5 }}]",
      kMostLayers);
  const toml::array* layers = node.as_array();
  if (!layers || layers->size() > kMostLayers) document.fail(coating, allowed);
  for (std::size_t i = 0; i < layers->size(); ++i) {
    const std::string layer = fmt::format("{}.{}", coating, i + 1);
    const toml::table* table = layers->get(i)->as_table();
    if (!table) document.fail(layer, allowed);
    for (const auto& [name, value] : *table) keys.push_back(layer + '.' + std::string(name.str()));
  }
}

/// All keys of the document, known or not, in the order of their lines. Keys in tables and layers have dots.
std::vector<std::string> document_keys(const SceneDocument& document) {
  std::vector<std::string> keys;
  const std::vector<std::string> tables = scene_tables();
  for (const auto& [name, node] : document.root()) {
    const std::string key(name.str());
    const bool is_table = std::find(tables.begin(), tables.end(), key) != tables.end();
    if (!is_table) {
      keys.push_back(key);
      continue;
    }
    if (!node.is_table()) document.fail(key, fmt::format("must be a table, [{}]", key));
    for (const auto& [inner, inner_node] : *node.as_table()) {
      const std::string inner_key = key + '.' + std::string(inner.str());
      if (is_coating(inner_key)) {
        append_layer_keys(document, inner_key, inner_node, keys);
      } else {
        keys.push_back(inner_key);
      }
    }
  }
  std::stable_sort(keys.begin(), keys.end(), [&](const std::string& a, const std::string& b) {
    return document.line_number(a) < document.line_number(b);
  });
  return keys;
}

/// The first of KeyAlternative::heads in the document, or null. Refuses two alternatives, and companions without head.
const std::string* chosen_key(const SceneDocument& document, const KeyChoice& choice) {
  const auto first_given = [&](const std::vector<std::string>& keys) -> const std::string* {
    const auto found = std::ranges::find_if(keys, [&](const std::string& key) { return document.find(key); });
    return found == keys.end() ? nullptr : &*found;
  };
  const std::string* chosen = nullptr;
  for (const KeyAlternative& alternative : choice.alternatives) {
    const std::string* const head = first_given(alternative.heads);
    if (const std::string* const companion = first_given(alternative.companions); companion && !head)
      document.fail(*companion, "needs " + alternative.heads.front() + " beside it");
    if (chosen && head) document.fail(*head, "cannot be combined with " + *chosen);
    chosen = head ? head : chosen;
  }
  return chosen;
}

void check_choice(const SceneDocument& document, const KeyChoice& choice) {
  const bool is_present = document.find(choice.table) != nullptr;
  if (chosen_key(document, choice) || !choice.is_required) return;
  if (!is_present && (is_effect_table(choice.table) || is_coating(choice.table))) return;
  std::vector<std::string> heads;
  for (const KeyAlternative& alternative : choice.alternatives) heads.push_back(alternative.heads.front());
  document.fail(heads.front(), fmt::format("missing; must be {}, or give one of {}",
                                           find_scene_key(heads.front())->description.allowed(), join(heads)));
}

struct Needs {
  bool are_met;
  const char* text;
};
/// Refuses a key of the document whose needs are not met.
void check_needs(const SceneDocument& document, std::string_view key, const std::vector<Needs>& needs) {
  if (!document.find(key)) return;
  std::vector<std::string> missing;
  for (const Needs& need : needs) {
    if (!need.are_met) missing.emplace_back(need.text);
  }
  if (!missing.empty()) document.fail(key, fmt::format("needs {}", fmt::join(missing, " and ")));
}

void check_wind(const SceneValues& scene, const SceneDocument& document) {
  const bool is_gaussian = scene.surface.distribution == Distribution::kGaussian;
  for (const char* key : {"surface.wind_m_s", "grid.wind_m_s"}) {
    check_needs(document, key,
                {{is_gaussian, "surface.distribution = \"gaussian\""},
                 {!document.find("surface.sigma"), "no surface.sigma beside it"},
                 {!document.find("grid.sigma"), "no grid.sigma beside it"}});
  }
}

void check_required(const SceneDocument& document, const Key& known) {
  if (known.fallback != "required" || !known.rivals.empty() || document.find(known.key)) return;
  if (known.key == "emission.temperature_K" && document.find("grid.temperature_K")) return;
  const std::string table = known.key.substr(0, known.key.rfind('.'));
  const bool may_lack = is_effect_table(table) || known.layer > 0;
  if (document.find(table) || !may_lack) document.fail(known.key, "missing; must be " + known.allowed());
}

/// Collects errors, so that one message reports up to kMostTold of them.
class Mistakes {
 public:
  template <class Check>
  void of(const Check& check) {
    try {
      check();
    } catch (const InputError& error) {
      if (count_++ < kMostTold) text_ += (text_.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  void tell() const {
    if (count_ > kMostTold) throw InputError(fmt::format("{}; and {} more", text_, count_ - kMostTold));
    if (count_ > 0) throw InputError(text_);
  }

 private:
  static constexpr std::size_t kMostTold = 5;
  std::string text_;
  std::size_t count_ = 0;
};

SceneValues read_keys(const SceneDocument& document) {
  SceneValues scene;
  Mistakes mistakes;
  const std::vector<std::string> keys = document_keys(document);
  for (const std::string& key : keys) {
    mistakes.of([&] {
      if (!find_scene_key(key)) document.fail(key, "unknown key; the nearest known key is " + key_hint(key));
      if (!document.find(key)) document.fail(key, "its dot is inside of quotes; write it without them");
    });
  }
  for (const std::string& table : scene_tables()) {
    if (document.find(table)) add_effect(scene, table);
  }
  for (const std::string& key : keys) {
    const SceneKey* const known = find_scene_key(key);
    if (known != nullptr && document.find(key) != nullptr)
      mistakes.of([&] { known->set(scene, read_value(document, known->description)); });
  }
  mistakes.tell();
  follow_keys(scene);
  check_wind(scene, document);
  for (const KeyChoice& choice : key_choices()) mistakes.of([&] { check_choice(document, choice); });
  for (const Key& known : dolp::keys()) mistakes.of([&] { check_required(document, known); });
  mistakes.tell();
  return scene;
}

/// If the scene gives a quantity only as an axis, stores the first value of the axis as the scene's value.
void fill_from_grid(SceneValues& scene, const SceneDocument& document) {
  Axes& grid = scene.grid;
  check_needs(document, "grid.temperature_K", {{document.find("emission") != nullptr, "the table [emission]"}});
  for (const char* key : {"grid.view_zenith_deg", "grid.relative_azimuth_deg"})
    check_needs(document, key, {{scene.geometry.mode == Mode::kBistatic, "geometry.mode = \"bistatic\""}});
  for (const Axis axis : kAllAxes) {
    const SceneKey* const key = find_scene_key(describe(axis).key);
    const bool is_filled = key && !describe(axis).is_required && !grid[axis].empty();
    if (is_filled && !document.find(describe(axis).key)) key->set(scene, grid[axis].front());
  }
  if (!scene.bands.empty()) scene.spectrum = scene.bands.front();
  for (const Spectrum& band : scene.bands) {
    std::vector<std::string>& labels = scene.labels[Axis::kBand];
    grid[Axis::kBand].push_back(static_cast<double>(labels.size()));
    labels.push_back(band.label());
    if (std::ranges::count(labels, labels.back()) > 1) document.fail("grid.band_um", labels.back() + " appears twice");
  }
}

void fill_grid(SceneValues& scene, const SceneDocument& document) {
  constexpr std::size_t kDefaultThetaCount = 91;
  Axes& grid = scene.grid;
  std::vector<double>& theta_deg = grid[Axis::kTheta];
  if (theta_deg.empty()) {
    theta_deg.resize(kDefaultThetaCount);
    std::iota(theta_deg.begin(), theta_deg.end(), 0.0);
  }
  if (!document.find("surface.sigma") && !scene.surface.wind_m_s) scene.surface.sigma = grid[Axis::kSigma].front();
  if (grid[Axis::kSigma].empty()) {
    grid[Axis::kSigma] = {scene.surface.sigma};
    if (scene.surface.wind_m_s) scene.wind_m_s = {*scene.surface.wind_m_s};
  }
  if (grid[Axis::kQ].empty()) grid[Axis::kQ] = {scene.surface.q};
}

void fill_diffuse(SceneValues& scene, const SceneDocument& document) {
  double& exponent = scene.surface.diffuse_exponent;
  if (!scene.surface.diffuse_table) return;
  if (document.find("surface.diffuse_exponent") && exponent != 0.0)
    document.fail("surface.diffuse_exponent",
                  fmt::format("{} must be 0, or absent, beside surface.diffuse_file", exponent));
  exponent = 0.0;
}

void check_smith(const SceneValues& scene, const SceneDocument& document) {
  if (!scene.surface.needs_mean_slope()) return;
  const std::string what = "masking = \"smith\" with distribution = \"cauchy\" needs q in " + kSmithCauchyQRange.text();
  if (!kSmithCauchyQRange.contains(scene.surface.q)) document.fail("surface.q", what);
  for (const double q : scene.grid[Axis::kQ]) {
    if (!kSmithCauchyQRange.contains(q)) document.fail("grid.q", fmt::format("{} is out of range; {}", q, what));
  }
}

void check_scattering(const SceneValues& scene, const SceneDocument& document) {
  const Surface& surface = scene.surface;
  const Emission emission = scene.emission.value_or(Emission());
  const bool is_direct = emission.model == EmissionModel::kDirect;
  if (surface.scattering == Scattering::kMultiple) {
    check_needs(document, "surface.scattering",
                {{surface.masking == Masking::kVCavity, "surface.masking = \"v-cavity\""},
                 {surface.is_bare(), "no surface.coating or surface.reflectance_file"},
                 {!is_direct, "emission.model = \"moments\" or \"fresnel\""},
                 {!emission.has_bracket, "emission.bracket = false"}});
  }
  if (surface.diffuse_polarisation != DiffusePolarisation::kNone)
    check_needs(document, "surface.diffuse_polarisation",
                {{surface.is_bare(), "no surface.coating or surface.reflectance_file"},
                 {!surface.diffuse_table, "no surface.diffuse_file"}});
  const bool can_be_direct = keeps_projected_area(surface.masking);
  const char* const maskings = "surface.masking = \"smith\" or \"v-cavity\"";
  if (emission.has_bracket) {
    check_needs(document, "emission.bracket",
                {{can_be_direct, maskings},
                 {emission.model != EmissionModel::kFresnel, "emission.model = \"moments\" or \"direct\""},
                 {scene.geometry.mode == Mode::kHemispherical, "geometry.mode = \"hemispherical\""}});
  }
  if (is_direct) check_needs(document, "emission.model", {{can_be_direct, maskings}});
}

void check_cross_slopes(const SceneValues& scene, const SceneDocument& document) {
  const Surface& surface = scene.surface;
  const bool is_directional = surface.wind_model == WindModel::kDirectional;
  const bool has_smith = surface.masking == Masking::kSmith;
  const bool is_direct = scene.emission && scene.emission->model == EmissionModel::kDirect;
  const bool reflects = scene.surroundings || scene.source;
  const bool has_bracket = scene.emission && scene.emission->has_bracket;
  for (const char* key : {"surface.sigma_cross", "grid.sigma_cross", "surface.wind_model"}) {
    if (key == std::string_view("surface.wind_model") && !is_directional) continue;
    check_needs(
        document, key,
        {{surface.masking != Masking::kIntegral, "surface.masking = \"none\", \"v-cavity\" or \"smith\""},
         {!has_smith || is_direct, "emission.model = \"direct\" (or surface.masking = \"none\" or \"v-cavity\")"},
         {!has_smith || !reflects, "no [surroundings] and no [source] (or surface.masking = \"none\" or \"v-cavity\")"},
         {!has_bracket, "emission.bracket = false"}});
  }
}

void check_coating(const SceneValues& scene, const SceneDocument& document) {
  std::size_t varied = 0;
  for (std::size_t i = 0; i < scene.surface.coating.size(); ++i) {
    if (scene.surface.coating[i].thickness_spread_um > 0.0) ++varied;
    if (varied <= kMostVariedFilms) continue;
    document.fail(fmt::format("surface.coating.{}.thickness_spread_um", i + 1),
                  fmt::format("at most {} films of a coating can have a spread", kMostVariedFilms));
  }
}

void check_radiation(const SceneValues& scene, const SceneDocument& document) {
  for (const char* key : {"surroundings.vapour_cm", "surroundings.air_temperature_K"}) {
    if (!document.find(key) || built_in_sky(scene.names.profile)) continue;
    const std::string needs = "needs surroundings.profile = \"clear-sky\" or \"overcast\"";
    if (document.is_set(key) || !document.is_set("surroundings.profile")) document.fail(key, needs);
    document.fail("surroundings.profile", fmt::format("{0} in the scene {1}; {0} = none removes it", key, needs));
  }
  const std::array<std::string, 2> ends = {"surroundings.zenith_temperature_K", "surroundings.horizon_temperature_K"};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (document.find(ends[i]) && !document.find(ends[1 - i]))
      document.fail(ends[i], "needs " + ends[1 - i] + " beside it");
  }
  if (!scene.emission && !scene.source && !scene.surroundings) {
    document.fail("emission", "missing; nothing radiates without one of the tables emission, source, surroundings");
  }
  check_needs(document, "source.relative_irradiance",
              {{scene.emission.has_value(), "the table [emission], whose temperature it is relative to"}});
}

}  // namespace

SceneValues parse_scene(const std::string& text, const std::string& path_name, const std::vector<Setting>& settings,
                        std::shared_ptr<KnownData> known) {
  SceneDocument document(text, path_name);
  for (const Setting& setting : settings) document.apply(setting);
  SceneValues scene = read_keys(document);
  fill_from_grid(scene, document);
  scene.path_name = path_name;
  scene.text = text;
  scene.settings = settings;
  scene.known = std::move(known);
  load_named_data(scene, document);
  fill_grid(scene, document);
  fill_diffuse(scene, document);
  check_smith(scene, document);
  check_radiation(scene, document);
  check_scattering(scene, document);
  check_coating(scene, document);
  check_cross_slopes(scene, document);
  scene.document = std::make_shared<const SceneDocument>(std::move(document));
  return scene;
}

SceneValues read_scene(const std::string& path, const std::vector<Setting>& settings) {
  return parse_scene(read_text(path, input_name(path) + ": "), path, settings);
}

SceneValues with_settings(const SceneValues& scene, const std::vector<Setting>& settings) {
  const auto is_replaced = [&](const Setting& old) {
    return std::ranges::any_of(settings, [&](const Setting& setting) {
      const std::vector<std::string> replaced = keys_replaced_by(setting.key);
      return std::ranges::find(replaced, old.key) != replaced.end();
    });
  };
  std::vector<Setting> all;
  std::ranges::remove_copy_if(scene.settings, std::back_inserter(all), is_replaced);
  all.insert(all.end(), settings.begin(), settings.end());
  return parse_scene(scene.text, scene.path_name, all, scene.known);
}

}  // namespace dolp
