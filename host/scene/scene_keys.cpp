#include "scene/scene_keys.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/text.hpp"
#include "model/choices.hpp"

namespace dolp {
namespace {

using Type = KeyDescription::Type;
using Draft = SceneDraft;
using Value = KeyValue;
using Set = void (*)(SceneDraft&, const KeyValue&);

SceneKey number(const char* key, const char* unit, const NumberRange& range, const char* fallback, const char* meaning,
                Set set) {
  return {{key, Type::kNumber, unit, range, {}, fallback, meaning}, set};
}

/// The words are in the order of the enumeration they stand for.
SceneKey word(const char* key, std::vector<std::string> words, const char* fallback, const char* meaning, Set set) {
  return {{key, Type::kWord, "", {}, std::move(words), fallback, meaning}, set};
}

template <class Choice>
SceneKey choice(const char* key, Choice fallback, const char* meaning, Set set) {
  const auto& words = Names<Choice>::kAll;
  return word(key, {words.begin(), words.end()}, name_of(fallback), meaning, set);
}

SceneKey flag(const char* key, const char* meaning, Set set) {
  return {{key, Type::kFlag, "", {}, {}, "false", meaning}, set};
}

SceneKey text(const char* key, const char* meaning, Set set) {
  return {{key, Type::kText, "", {}, {}, "", meaning}, set};
}

SceneKey axis(const char* key, const char* unit, const NumberRange& range, const char* fallback, const char* meaning,
              Set set) {
  return {{key, Type::kAxis, unit, range, {}, fallback, meaning}, set};
}

void append(std::vector<SceneKey>& keys, std::vector<SceneKey> more) {
  std::move(more.begin(), more.end(), std::back_inserter(keys));
}

std::vector<SceneKey> surface_keys() {
  return {
      text("title", "name of the scene, for the table and the window",
           [](Draft& d, const Value& v) { d.scene.title = v.text; }),
      number("surface.n", "1", kNRange, "", "real part n of the refractive index n + ik; or material, or material_file",
             [](Draft& d, const Value& v) { d.scene.surface.material.constant.n = v.number; }),
      number("surface.k", "1", kKRange, "0", "imaginary part k of the refractive index n + ik, with surface.n",
             [](Draft& d, const Value& v) { d.scene.surface.material.constant.k = v.number; }),
      text("surface.material", "a built-in material by name (dolp materials lists them), instead of n and k",
           [](Draft& d, const Value& v) { d.material = v.text; }),
      text("surface.material_file", "your own n and k: refractiveindex.info YAML or CSV, instead of n and k",
           [](Draft& d, const Value& v) { d.material_file = v.text; }),
      choice("surface.distribution", Surface().distribution, "slope distribution D",
             [](Draft& d, const Value& v) { d.scene.surface.distribution = static_cast<Distribution>(v.word); }),
      number("surface.sigma", "1", kSigmaRange, "required",
             "slope width sigma (m^2 = 2 sigma^2); may be absent with grid.sigma, whose first value it then is",
             [](Draft& d, const Value& v) { d.scene.surface.sigma = v.number; }),
      number("surface.q", "1", kQRange, "2", "tail exponent q of the cauchy distribution; 2 is GGX",
             [](Draft& d, const Value& v) { d.scene.surface.q = v.number; }),
      choice("surface.masking", Surface().masking, "geometric attenuation G; smith with cauchy needs every q > 1.5",
             [](Draft& d, const Value& v) { d.scene.surface.masking = static_cast<Masking>(v.word); }),
      choice("surface.scattering", Surface().scattering,
             "light followed to its first facet, or through all bounces in V-grooves (masking v-cavity)",
             [](Draft& d, const Value& v) { d.scene.surface.scattering = static_cast<Scattering>(v.word); }),
      number("surface.specular", "1", kFractionRange, "1", "specular factor k_s",
             [](Draft& d, const Value& v) { d.scene.surface.specular = v.number; }),
      number("surface.diffuse", "1", kFractionRange, "0", "diffuse factor k_d",
             [](Draft& d, const Value& v) { d.scene.surface.diffuse = v.number; }),
      number("surface.diffuse_exponent", "1", kDiffuseExponentRange, "-0.5",
             "exponent c of the diffuse term (cos theta_i cos theta_r)^c",
             [](Draft& d, const Value& v) { d.scene.surface.diffuse_exponent = v.number; }),
  };
}

std::vector<SceneKey> radiation_keys() {
  return {
      number("emission.temperature_K", "K", kEmissionTemperatureRange, "required", "temperature T of the surface",
             [](Draft& d, const Value& v) { d.scene.emission->temperature_K = v.number; }),
      choice(
          "emission.model", Emission().model,
          "emissivity 1 - rho of the rough surface, 1 - R of the smooth surface, or what the facets emit straight to "
          "the viewer (masking smith or v-cavity)",
          [](Draft& d, const Value& v) { d.scene.emission->model = static_cast<EmissionModel>(v.word); }),
      flag("emission.bracket",
           "adds dolp_low, dolp_high: what DOLP lies between with all bounces (masking smith or v-cavity)",
           [](Draft& d, const Value& v) { d.scene.emission->has_bracket = v.is_set; }),
      number("source.irradiance", "W m-2 um-1", kNonNegativeRange, "", "E0 at normal incidence, flat over a band",
             [](Draft& d, const Value& v) {
               d.scene.source->kind = Source::Kind::kFlat;
               d.scene.source->irradiance = v.number;
             }),
      number("source.relative_irradiance", "1", kNonNegativeRange, "",
             "e = E0/(pi B(T)) at each wavelength, T of the emission; instead of irradiance",
             [](Draft& d, const Value& v) {
               d.scene.source->kind = Source::Kind::kRelative;
               d.scene.source->relative_irradiance = v.number;
             }),
      word("source.preset", {"sun"}, "", "E0 of the sun at the top of the atmosphere; instead of irradiance",
           [](Draft& d, const Value& v) { d.source_preset = v.text; }),
      text("source.file", "your own E0: CSV of wavelength_um, irradiance; instead of irradiance",
           [](Draft& d, const Value& v) { d.source_file = v.text; }),
      number("source.scale", "1", kNonNegativeRange, "1", "factor on E0, whatever its kind",
             [](Draft& d, const Value& v) { d.scene.source->scale = v.number; }),
      number("surroundings.temperature_K", "K", kBackgroundTemperatureRange, "required",
             "temperature T_surr of the black surroundings that the surface reflects",
             [](Draft& d, const Value& v) { d.scene.surroundings->temperature_K = v.number; }),
      number("path.transmittance", "1", kFractionRange, "1", "transmittance tau of the path to the sensor",
             [](Draft& d, const Value& v) { d.scene.path->transmittance = v.number; }),
      number("path.temperature_K", "K", kBackgroundTemperatureRange, "",
             "temperature of the path, whose radiance is (1 - tau) B(T); without it and radiance, none",
             [](Draft& d, const Value& v) { d.scene.path->temperature_K = v.number; }),
      number("path.radiance", "W m-2 sr-1 um-1", kNonNegativeRange, "",
             "path radiance L_path; instead of path.temperature_K",
             [](Draft& d, const Value& v) { d.scene.path->radiance = v.number; }),
  };
}

std::vector<SceneKey> geometry_keys() {
  return {
      number("spectrum.wavelength_um", "um", kWavelengthUmRange, "", "wavelength lambda; or band_um",
             [](Draft& d, const Value& v) {
               d.scene.spectrum = {v.number, v.number};
             }),
      {{"spectrum.band_um", Type::kPair, "um", kWavelengthUmRange, {}, "", "band [lambda1, lambda2] to integrate over"},
       [](Draft& d, const Value& v) {
         d.scene.spectrum = {v.numbers[0], v.numbers[1]};
       }},
      choice("geometry.mode", Geometry().mode,
             "exitances, with rho(theta) for emission, surroundings and a source at zenith theta; or radiances in a "
             "fixed view, with a source at zenith theta",
             [](Draft& d, const Value& v) { d.scene.geometry.mode = static_cast<Mode>(v.word); }),
      number("geometry.view_zenith_deg", "degree", kZenithDegRange, "60", "bistatic: view zenith theta_v",
             [](Draft& d, const Value& v) { d.scene.geometry.view_zenith_deg = v.number; }),
      number("geometry.relative_azimuth_deg", "degree", kAzimuthDegRange, "180",
             "bistatic: azimuth Delta phi between source and view; 180 is the specular side",
             [](Draft& d, const Value& v) { d.scene.geometry.relative_azimuth_deg = v.number; }),
      axis("grid.theta_deg", "degree", kZenithDegRange, "{ from = 0, to = 90, count = 91 }",
           "zenith theta: of the view (hemispherical) or of the source (bistatic)",
           [](Draft& d, const Value& v) { d.scene.grid.theta_deg = v.numbers; }),
      axis("grid.sigma", "1", kSigmaRange, "surface.sigma", "slope widths sigma of the table",
           [](Draft& d, const Value& v) { d.scene.grid.sigma = v.numbers; }),
      axis("grid.q", "1", kQRange, "surface.q", "tail exponents q of the table",
           [](Draft& d, const Value& v) { d.scene.grid.q = v.numbers; }),
      axis("grid.wavelength_um", "um", kWavelengthUmRange, "",
           "wavelengths of the table, without a band; spectrum.wavelength_um may then be absent, and is the first",
           [](Draft& d, const Value& v) { d.scene.grid.wavelength_um = v.numbers; }),
      axis("grid.n", "1", kNRange, "", "n of the table, without a material; surface.n may then be absent",
           [](Draft& d, const Value& v) { d.scene.grid.n = v.numbers; }),
      axis("grid.k", "1", kKRange, "", "k of the table, without a material",
           [](Draft& d, const Value& v) { d.scene.grid.k = v.numbers; }),
      number("accuracy.tolerance", "1", kToleranceRange, "1e-4",
             "largest error of rho, relative to rho_I, and of DOLP, absolute",
             [](Draft& d, const Value& v) { d.scene.accuracy.tolerance = v.number; }),
      choice("accuracy.precision", Accuracy().precision, "arithmetic of the device",
             [](Draft& d, const Value& v) { d.scene.accuracy.precision = static_cast<Precision>(v.word); }),
      word("accuracy.interpolation", {"auto", "off"}, "auto",
           "between slope distributions of a dense grid and from some of many indices to all, within the tolerance; "
           "off: "
           "every entry is integrated by itself",
           [](Draft& d, const Value& v) { d.scene.accuracy.may_interpolate = v.word == 0; }),
  };
}

}  // namespace

const std::vector<SceneKey>& scene_key_table() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all = surface_keys();
    append(all, radiation_keys());
    append(all, geometry_keys());
    return all;
  }();
  return keys;
}

const std::vector<KeyDescription>& scene_keys() {
  static const std::vector<KeyDescription> descriptions = [] {
    std::vector<KeyDescription> all;
    for (const SceneKey& key : scene_key_table()) all.push_back(key.description);
    return all;
  }();
  return descriptions;
}

const std::vector<KeyChoice>& key_choices() {
  static const std::vector<KeyChoice> choices = {
      {"surface", {{"surface.n", "surface.k"}, {"surface.material"}, {"surface.material_file"}}, true, "grid.n"},
      {"source", {{"source.irradiance"}, {"source.relative_irradiance"}, {"source.preset"}, {"source.file"}}},
      {"path", {{"path.temperature_K"}, {"path.radiance"}}, false},
      {"spectrum", {{"spectrum.wavelength_um"}, {"spectrum.band_um"}}, true, "grid.wavelength_um"},
  };
  return choices;
}

const SceneKey* find_scene_key(std::string_view key) {
  for (const SceneKey& known : scene_key_table()) {
    if (known.description.key == key) return &known;
  }
  return nullptr;
}

std::vector<std::string> scene_tables() {
  std::vector<std::string> tables;
  for (const SceneKey& known : scene_key_table()) {
    const std::string& key = known.description.key;
    const std::size_t dot = key.find('.');
    if (dot == std::string::npos) continue;
    if (tables.empty() || tables.back() != key.substr(0, dot)) tables.push_back(key.substr(0, dot));
  }
  return tables;
}

bool is_effect_table(std::string_view table) {
  return table == "emission" || table == "source" || table == "surroundings" || table == "path";
}

void add_effect(SceneDraft& draft, std::string_view table) {
  if (table == "emission") draft.scene.emission.emplace();
  if (table == "source") draft.scene.source.emplace();
  if (table == "surroundings") draft.scene.surroundings.emplace();
  if (table == "path") draft.scene.path.emplace();
}

std::string KeyDescription::allowed() const {
  switch (type) {
    case Type::kNumber:
      return "a number in " + range.text();
    case Type::kWord:
      return words.size() == 1 ? '"' + words.front() + '"' : "one of " + join(words);
    case Type::kFlag:
      return "true or false";
    case Type::kText:
      return "a text";
    case Type::kPair:
      return "two ascending numbers in " + range.text();
    case Type::kAxis:
      return "a number in " + range.text() + ", a list of them, or { from, to, count, spacing }";
  }
  return {};
}

}  // namespace dolp
