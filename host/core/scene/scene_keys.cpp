#include "scene/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/number_range.hpp>
#include <iterator>
#include <type_traits>
#include <utility>

#include "base/text.hpp"
#include "model/choices.hpp"
#include "model/slopes.hpp"
#include "scene/sky_profile.hpp"

namespace dolp {
namespace {

using Type = Key::Type;

template <class Content>
void assign(Content& content, const KeyValue& value) {
  if constexpr (std::is_enum_v<Content>) {
    content = named<Content>(std::get<std::string>(value)).value();
  } else if constexpr (std::is_same_v<Content, std::optional<double>>) {
    content = std::get<double>(value);
  } else {
    content = std::get<Content>(value);
  }
}

/// The value at `at`. nullopt for a null pointer, an empty text or list, and an absent number.
template <class Content>
std::optional<KeyValue> value_at(const Content* at) {
  if (!at) return std::nullopt;
  if constexpr (std::is_enum_v<Content>) {
    return std::string(to_name(*at));
  } else if constexpr (std::is_same_v<Content, std::optional<double>>) {
    return *at ? std::optional<KeyValue>(**at) : std::nullopt;
  } else if constexpr (requires { at->empty(); }) {
    return at->empty() ? std::nullopt : std::optional<KeyValue>(*at);
  } else {
    return *at;
  }
}

bool always(const SceneValues&) { return true; }

/// Makes a key. `address(scene)`: pointer to the value, or null. `is_there(scene)`: true if the scene has the value.
template <class Address, class IsThere = decltype(&always)>
SceneKey key_at(Key description, Address address, IsThere is_there = always) {
  return {std::move(description), [address](SceneValues& s, const KeyValue& v) { assign(*address(s), v); },
          [address, is_there](const SceneValues& s) { return is_there(s) ? value_at(address(s)) : std::nullopt; }};
}

template <class Address, class IsThere = decltype(&always)>
SceneKey number(const std::string& key, const char* unit, const NumberRange& range, const char* fallback,
                const char* meaning, Address address, IsThere is_there = always) {
  return key_at({key, Type::kNumber, unit, range, {}, fallback, meaning}, address, is_there);
}

template <class Choice, class Address>
SceneKey choice(const char* key, Choice fallback, const char* meaning, Address address) {
  const auto words = choice_names(fallback);
  return key_at({key, Type::kWord, "", {}, {words.begin(), words.end()}, to_name(fallback), meaning}, address);
}

template <class Address>
SceneKey flag(const char* key, const char* meaning, Address address) {
  return key_at({key, Type::kFlag, "", {}, {"false", "true"}, "false", meaning}, address);
}

template <class Address, class IsThere = decltype(&always)>
SceneKey text(const std::string& key, const char* meaning, Address address, IsThere is_there = always) {
  return key_at({key, Type::kText, "", {}, {}, "", meaning}, address, is_there);
}

SceneKey grid_axis(Axis axis, const char* fallback, const char* meaning) {
  const AxisDescription& described = describe(axis);
  return key_at(
      {std::string("grid.") + described.column, Type::kAxis, described.units, described.range, {}, fallback, meaning},
      [axis](auto& s) { return &s.grid[axis]; });
}

template <class Element>
void append(std::vector<Element>& all, std::vector<Element> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

bool has_own_index(const SceneValues& s) {
  return s.names.material.empty() && s.names.material_file.empty() && s.labels[Axis::kMaterial].empty();
}

/// Layer number `layer` of the coating, counted from 1. Adds missing layers if the scene is not const.
template <class Scene>
auto& coating_layer(Scene& s, std::size_t layer) {
  if constexpr (!std::is_const_v<Scene>) {
    s.surface.coating.resize(std::max(s.surface.coating.size(), layer));
    s.names.coating.resize(s.surface.coating.size());
  }
  return s.surface.coating[layer - 1];
}

std::vector<SceneKey> layer_keys(std::size_t layer) {
  const std::string begin = fmt::format("surface.coating.{}.", layer);
  const auto has_layer = [layer](const SceneValues& s) { return s.surface.coating.size() >= layer; };
  const auto has_index = [=](const SceneValues& s) {
    return has_layer(s) && s.names.coating[layer - 1].material.empty() &&
           s.names.coating[layer - 1].material_file.empty();
  };
  const auto index_address = [=](auto OpticalConstants::*part) {
    return [=](auto& s) { return &(coating_layer(s, layer).material.constant.*part); };
  };
  const auto name_address = [=](auto MaterialNames::*name) {
    return [=](auto& s) {
      coating_layer(s, layer);
      return &(s.names.coating[layer - 1].*name);
    };
  };
  std::vector<SceneKey> keys = {
      number(begin + "n", "1", kNRange, "",
             "n of a film on the surface; the number in the key counts films from the outside in",
             index_address(&OpticalConstants::n), has_index),
      number(begin + "k", "1", kKRange, "0", "k of the film, with n", index_address(&OpticalConstants::k), has_index),
      text(begin + "material", "a built-in material by name, instead of the film's n and k",
           name_address(&MaterialNames::material), has_layer),
      text(begin + "material_file", "file with your own values of the film's n and k, instead of n and k",
           name_address(&MaterialNames::material_file), has_layer),
      number(
          begin + "thickness_um", "um", kThicknessUmRange, "required", "thickness of the film",
          [=](auto& s) { return &coating_layer(s, layer).thickness_um; }, has_layer),
      number(
          begin + "thickness_spread_um", "um", kThicknessUmRange, "0",
          "standard deviation of the thickness over the surface, which blurs the interference; at most two films have "
          "one",
          [=](auto& s) { return &coating_layer(s, layer).thickness_spread_um; }, has_layer),
  };
  for (SceneKey& key : keys) key.description.layer = layer;
  return keys;
}

std::vector<SceneKey> surface_keys() {
  return {
      text("title", "name of the scene, for the table and the window", [](auto& s) { return &s.title; }),
      number(
          "surface.n", "1", kNRange, "",
          "real part n of the refractive index n + ik (instead of n: material, material_file or reflectance_file)",
          [](auto& s) { return &s.surface.material.constant.n; }, has_own_index),
      number(
          "surface.k", "1", kKRange, "0", "imaginary part k of the refractive index n + ik, only together with n",
          [](auto& s) { return &s.surface.material.constant.k; }, has_own_index),
      text("surface.material", "name of a built-in material (dolp materials lists the names), instead of n and k",
           [](auto& s) { return &s.names.material; }),
      text("surface.material_file",
           "file with your own values of n and k (refractiveindex.info YAML, or CSV), instead of n and k",
           [](auto& s) { return &s.names.material_file; }),
      text("surface.reflectance_file",
           "CSV file with measured reflectances of the smooth surface (columns beta_deg, r_s, r_p, and wavelength_um "
           "if they depend on it), instead of n, k and a coating",
           [](auto& s) { return &s.names.reflectance_file; }),
      choice("surface.distribution", Surface().distribution, "slope distribution D",
             [](auto& s) { return &s.surface.distribution; }),
      number("surface.sigma", "1", kSigmaRange, "required",
             "slope width sigma, with m^2 = 2 sigma^2; if absent, the first value of grid.sigma",
             [](auto& s) { return &s.surface.sigma; }),
      number("surface.wind_m_s", "m s-1", kWindRange, "",
             "wind over a sea; sets sigma by 2 sigma^2 = 0.003 + 0.00512 wind; only with distribution gaussian",
             [](auto& s) { return &s.surface.wind_m_s; }),
      choice("surface.wind_model", Surface().wind_model,
             "isotropic: the wind gives one slope width; directional: sigma^2 = 0.00316 wind along it, and 0.003 + "
             "0.00192 wind across (masking none or v-cavity; smith only with emission.model = direct)",
             [](auto& s) { return &s.surface.wind_model; }),
      number(
          "surface.sigma_cross", "1", kSigmaCrossRange, "surface.sigma",
          "slope width across, along the surface's y axis, as of brushed metal; sigma is the width along x "
          "(masking none or v-cavity; smith only with emission.model = direct)",
          [](auto& s) { return &s.surface.sigma_cross; },
          [](const SceneValues& s) { return s.surface.sigma_cross > 0.0; }),
      number("surface.q", "1", kQRange, "2", "tail exponent q of the cauchy distribution; 2 is GGX",
             [](auto& s) { return &s.surface.q; }),
      choice("surface.masking", Surface().masking, "geometric attenuation G; smith with cauchy needs every q > 1.5",
             [](auto& s) { return &s.surface.masking; }),
      choice("surface.scattering", Surface().scattering,
             "single: light is followed to its first facet; multiple: through all bounces in V-grooves (only masking "
             "v-cavity)",
             [](auto& s) { return &s.surface.scattering; }),
      number("surface.specular", "1", kFractionRange, "1", "specular factor k_s",
             [](auto& s) { return &s.surface.specular; }),
      number(
          "surface.diffuse", "1", kFractionRange, "0", "diffuse factor k_d (instead of it: diffuse_file)",
          [](auto& s) { return &s.surface.diffuse; },
          [](const SceneValues& s) { return s.names.diffuse_file.empty(); }),
      text("surface.diffuse_file",
           "file with k_d over the wavelength, instead of diffuse: CSV (columns wavelength_um, reflectance), or a file "
           "of the ECOSTRESS spectral library; with diffuse_exponent 0",
           [](auto& s) { return &s.names.diffuse_file; }),
      number("surface.diffuse_exponent", "1", kDiffuseExponentRange, "-0.5",
             "exponent c of the diffuse term (cos theta_i cos theta_r)^c; 0 with diffuse_file",
             [](auto& s) { return &s.surface.diffuse_exponent; }),
      choice("surface.diffuse_polarisation", Surface().diffuse_polarisation,
             "none: diffuse light is unpolarised; transmission: it is polarised when it leaves the body through the "
             "smooth surface, as in paint (without coating and reflectance_file)",
             [](auto& s) { return &s.surface.diffuse_polarisation; }),
  };
}

std::vector<SceneKey> radiation_keys() {
  return {
      number("emission.temperature_K", "K", kEmissionTemperatureRange, "required", "temperature T of the surface",
             [](auto& s) { return s.emission ? &s.emission->temperature_K : nullptr; }),
      choice(
          "emission.model", Emission().model,
          "moments: emissivity 1 - rho of the rough surface; fresnel: emissivity 1 - R of the smooth surface; direct: "
          "light that facets emit straight to the viewer, without the light that one facet emits and another reflects; "
          "for comparison with Masuda et al. 1988 (only masking smith or v-cavity)",
          [](auto& s) { return s.emission ? &s.emission->model : nullptr; }),
      flag("emission.bracket",
           "adds dolp_low and dolp_high, which enclose the DOLP that all bounces of light give (only masking smith "
           "or v-cavity)",
           [](auto& s) { return s.emission ? &s.emission->has_bracket : nullptr; }),
      number(
          "source.irradiance", "W m-2 um-1", kNonNegativeRange, "",
          "irradiance E0 of the source at normal incidence, constant over a band",
          [](auto& s) { return s.source ? &s.source->irradiance : nullptr; },
          [](const SceneValues& s) { return s.source && !s.source->relative_irradiance && !s.source->table; }),
      number("source.relative_irradiance", "1", kNonNegativeRange, "",
             "E0/(pi B(T)) at each wavelength, with T = emission.temperature_K; instead of irradiance",
             [](auto& s) { return s.source ? &s.source->relative_irradiance : nullptr; }),
      key_at({"source.preset",
              Type::kWord,
              "",
              {},
              {"sun"},
              "",
              "E0 of the sun at the top of the atmosphere, instead of source.irradiance"},
             [](auto& s) { return &s.names.source_preset; }),
      text("source.file", "CSV file with your own E0 (columns wavelength_um, irradiance), instead of source.irradiance",
           [](auto& s) { return &s.names.source_file; }),
      number("source.scale", "1", kNonNegativeRange, "1", "factor that multiplies E0, however E0 is given",
             [](auto& s) { return s.source ? &s.source->scale : nullptr; }),
      number(
          "surroundings.temperature_K", "K", kBackgroundTemperatureRange, "",
          "temperature T_surr of the black surroundings that the surface reflects (instead of it: profile, or "
          "zenith_temperature_K and horizon_temperature_K)",
          [](auto& s) { return s.surroundings ? &s.surroundings->temperature_K : nullptr; },
          [](const SceneValues& s) {
            return s.names.profile.empty() && !(s.surroundings && s.surroundings->zenith_K);
          }),
      number("surroundings.zenith_temperature_K", "K", kBackgroundTemperatureRange, "",
             "brightness temperature of the sky in the zenith; between zenith and horizon it is a straight line in "
             "the zenith angle",
             [](auto& s) { return s.surroundings ? &s.surroundings->zenith_K : nullptr; }),
      number("surroundings.horizon_temperature_K", "K", kBackgroundTemperatureRange, "",
             "brightness temperature of the sky at the horizon",
             [](auto& s) { return s.surroundings ? &s.surroundings->horizon_K : nullptr; }),
      text("surroundings.profile",
           "sky that changes with the zenith, instead of temperature_K: clear-sky, overcast, or your own CSV file "
           "(columns zenith_deg, temperature_K or radiance; wavelength_um if the sky depends on the wavelength)",
           [](auto& s) { return &s.names.profile; }),
      number("surroundings.vapour_cm", "cm", kVapourRange, "",
             "precipitable water of the air of clear-sky or overcast; if absent, 1.27 cm, or all that the air "
             "holds if this is less",
             [](auto& s) { return s.surroundings ? &s.surroundings->air.vapour_cm : nullptr; }),
      number("surroundings.air_temperature_K", "K", kAirTemperatureRange, "",
             "temperature of the air at the ground under clear-sky or overcast; if absent, 288.15 K",
             [](auto& s) { return s.surroundings ? &s.surroundings->air.temperature_K : nullptr; }),
      number("path.transmittance", "1", kFractionRange, "1", "transmittance tau of the path to the sensor",
             [](auto& s) { return s.path ? &s.path->transmittance : nullptr; }),
      number("path.temperature_K", "K", kBackgroundTemperatureRange, "",
             "temperature T of the path, which then has the radiance (1 - tau) B(T); without this key and "
             "path.radiance the path emits nothing",
             [](auto& s) { return s.path ? &s.path->temperature_K : nullptr; }),
      number("path.radiance", "W m-2 sr-1 um-1", kNonNegativeRange, "",
             "radiance L_path of the path, instead of path.temperature_K",
             [](auto& s) { return s.path ? &s.path->radiance : nullptr; }),
  };
}

std::vector<SceneKey> geometry_keys() {
  return {
      {{"spectrum.wavelength_um", Type::kNumber, "um", kWavelengthUmRange, {}, "", "a single wavelength lambda"},
       [](SceneValues& s, const KeyValue& v) { s.spectrum.min_um = s.spectrum.max_um = std::get<double>(v); },
       [](const SceneValues& s) { return s.spectrum.is_band() ? std::nullopt : value_at(&s.spectrum.min_um); }},
      {{"spectrum.band_um", Type::kPair, "um", kWavelengthUmRange, {}, "", "band [lambda1, lambda2] to integrate over"},
       [](SceneValues& s, const KeyValue& v) {
         const auto& ends_um = std::get<std::vector<double>>(v);
         s.spectrum.min_um = ends_um[0];
         s.spectrum.max_um = ends_um[1];
       },
       [](const SceneValues& s) -> std::optional<KeyValue> {
         if (!s.spectrum.is_band()) return std::nullopt;
         return std::vector{s.spectrum.min_um, s.spectrum.max_um};
       }},
      text("spectrum.response_file",
           "CSV file with the response of your camera (columns wavelength_um, response), instead of band_um",
           [](auto& s) { return &s.names.response_file; }),
      choice("spectrum.response_per", Spectrum().response_per,
             "power: the response is the signal per radiant power; photon: per photon, as a quantum efficiency",
             [](auto& s) { return &s.spectrum.response_per; }),
      choice("geometry.mode", Geometry().mode,
             "hemispherical: the results are exitances; bistatic: the results are radiances toward a view; in "
             "both modes a source has the zenith theta",
             [](auto& s) { return &s.geometry.mode; }),
      number("geometry.view_zenith_deg", "degree", kZenithDegRange, "60", "view zenith theta_v in bistatic mode",
             [](auto& s) { return &s.geometry.view_zenith_deg; }),
      number("geometry.relative_azimuth_deg", "degree", kAzimuthDegRange, "180",
             "azimuth Delta phi between source and view in bistatic mode; 180 is the specular side",
             [](auto& s) { return &s.geometry.relative_azimuth_deg; }),
      number("geometry.surface_azimuth_deg", "degree", kAzimuthDegRange, "0",
             "azimuth of the surface's x axis (upwind), from the viewer's horizontal direction, counter-clockwise from "
             "above; without effect if slopes are equal along and across",
             [](auto& s) { return &s.geometry.surface_azimuth_deg; }),
      grid_axis(Axis::kTheta, "{ from = 0, to = 90, count = 91 }",
                "zenith theta of the view (hemispherical mode) or of the source (bistatic mode)"),
      grid_axis(Axis::kViewZenith, "",
                "view zeniths of a table in bistatic mode; the first one replaces a missing geometry.view_zenith_deg"),
      grid_axis(Axis::kRelativeAzimuth, "",
                "azimuths between source and view of a table in bistatic mode; the first one replaces a missing "
                "geometry.relative_azimuth_deg"),
      grid_axis(Axis::kSigma, "surface.sigma", "slope widths sigma of the table"),
      key_at(
          {"grid.wind_m_s", Type::kAxis, kWind.units, kWind.range, {}, "", "winds of the table, instead of grid.sigma"},
          [](auto& s) { return &s.wind_m_s; }),
      key_at({"grid.material",
              Type::kNames,
              "",
              {},
              {},
              "",
              "names of built-in materials for the table, or \"all\"; instead of n and k"},
             [](auto& s) { return &s.labels[Axis::kMaterial]; }),
      {{"grid.band_um", Type::kPairs, "um", kWavelengthUmRange, {}, "", "bands of the table, instead of [spectrum]"},
       [](SceneValues& s, const KeyValue& v) {
         const auto& ends_um = std::get<std::vector<double>>(v);
         for (std::size_t i = 0; i < ends_um.size(); i += 2) s.bands.push_back({ends_um[i], ends_um[i + 1]});
       },
       [](const SceneValues& s) {
         std::vector<double> ends;
         for (const Spectrum& band : s.bands) ends.insert(ends.end(), {band.min_um, band.max_um});
         return value_at(&ends);
       }},
      grid_axis(Axis::kTemperature, "",
                "temperatures of the surface in the table; the first one replaces a missing emission.temperature_K"),
      grid_axis(Axis::kQ, "surface.q", "tail exponents q of the table"),
      grid_axis(Axis::kSigmaCross, "",
                "slope widths across of the table; the first one replaces a missing surface.sigma_cross"),
      grid_axis(Axis::kSurfaceAzimuth, "",
                "azimuths of the surface's x axis; the first one replaces a missing geometry.surface_azimuth_deg"),
      grid_axis(Axis::kWavelength, "",
                "wavelengths of the table, not a band; the first one replaces a missing spectrum.wavelength_um"),
      grid_axis(Axis::kN, "",
                "values of n in the table, instead of a material; the first one replaces a missing surface.n"),
      grid_axis(Axis::kK, "",
                "values of k in the table, instead of a material; the first one replaces a missing surface.k"),
      number("accuracy.tolerance", "1", kToleranceRange, "1e-4",
             "largest error of rho relative to rho_I, and largest absolute error of DOLP",
             [](auto& s) { return &s.accuracy.tolerance; }),
      choice("accuracy.precision", Accuracy().precision,
             "arithmetic of the kernels; auto takes float, and double for what float cannot compute to the tolerance",
             [](auto& s) { return &s.accuracy.precision; }),
      {{"accuracy.interpolation",
        Type::kWord,
        "",
        {},
        {"auto", "off"},
        "auto",
        "auto: within the tolerance the program may interpolate over a dense grid of sigma and q, or over many "
        "points, and compute many indices in one pass; off: it integrates every entry"},
       [](SceneValues& s, const KeyValue& v) { s.accuracy.may_interpolate = std::get<std::string>(v) == "auto"; },
       [](const SceneValues& s) { return std::string(s.accuracy.may_interpolate ? "auto" : "off"); }},
  };
}

std::string range_end_text(double value) {
  const std::string text = fmt::format("{:g}", value);
  const double exponent = std::log10(value);
  const bool is_large_power_of_ten = value >= 1e4 && exponent == std::round(exponent);
  return is_large_power_of_ten && std::isfinite(value) ? fmt::format("1e{}", static_cast<int>(exponent)) : text;
}

}  // namespace

const std::vector<SceneKey>& scene_key_table() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all = surface_keys();
    for (std::size_t layer = 1; layer <= kMostLayers; ++layer) append(all, layer_keys(layer));
    append(all, radiation_keys());
    append(all, geometry_keys());
    return all;
  }();
  return keys;
}

const std::vector<KeyChoice>& key_choices() {
  static const std::vector<KeyChoice> choices = [] {
    std::vector<KeyChoice> all = {
        {"surface",
         {{{"surface.n", "grid.n"}, {"surface.k", "grid.k"}},
          {{"surface.material"}},
          {{"surface.material_file"}},
          {{"surface.reflectance_file"}},
          {{"grid.material"}}}},
        {"surface",
         {{{"surface.sigma", "grid.sigma"}, {"surface.sigma_cross", "grid.sigma_cross"}},
          {{"surface.wind_m_s", "grid.wind_m_s"}, {"surface.wind_model"}}}},
        {"source", {{{"source.irradiance"}}, {{"source.relative_irradiance"}}, {{"source.preset"}}, {{"source.file"}}}},
        {"surroundings",
         {{{"surroundings.temperature_K"}},
          {{"surroundings.zenith_temperature_K", "surroundings.horizon_temperature_K"}},
          {{"surroundings.profile"}, {"surroundings.vapour_cm", "surroundings.air_temperature_K"}}}},
        {"path", {{{"path.temperature_K"}}, {{"path.radiance"}}}, false},
        {"surface", {{{"surface.diffuse"}}, {{"surface.diffuse_file"}}}, false},
        {"spectrum",
         {{{"spectrum.wavelength_um", "grid.wavelength_um"}},
          {{"spectrum.band_um"}},
          {{"spectrum.response_file"}, {"spectrum.response_per"}},
          {{"grid.band_um"}}}},
    };
    for (std::size_t layer = 1; layer <= kMostLayers; ++layer) {
      const std::string table = fmt::format("surface.coating.{}", layer);
      const auto key = [&](const char* name) { return table + '.' + name; };
      all.push_back({table, {{{key("n")}, {key("k")}}, {{key("material")}}, {{key("material_file")}}}});
    }
    return all;
  }();
  return choices;
}

std::vector<std::string> KeyAlternative::keys() const {
  std::vector<std::string> all = heads;
  append(all, companions);
  return all;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> descriptions = [] {
    std::vector<Key> all;
    for (const SceneKey& key : scene_key_table()) all.push_back(key.description);
    for (const KeyChoice& choice : key_choices()) {
      for (const KeyAlternative& own : choice.alternatives) {
        for (const std::string& key : own.keys()) {
          for (const KeyAlternative& other : choice.alternatives)
            if (&other != &own) append(std::ranges::find(all, key, &Key::key)->rivals, other.keys());
        }
      }
    }
    return all;
  }();
  return descriptions;
}

std::vector<std::string> keys_replaced_by(std::string_view key) {
  const auto known = std::ranges::find(dolp::keys(), key, &Key::key);
  return known == dolp::keys().end() ? std::vector<std::string>{} : known->rivals;
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

std::string last_part(std::string_view key) { return std::string(key.substr(key.rfind('.') + 1)); }

bool is_effect_table(std::string_view table) {
  return table == "emission" || table == "source" || table == "surroundings" || table == "path";
}

bool is_coating(std::string_view key) {
  constexpr std::string_view kCoating = "surface.coating";
  if (!key.starts_with(kCoating)) return false;
  const std::string_view layer = key.substr(kCoating.size());
  return layer.empty() || (layer.front() == '.' && layer.find('.', 1) == std::string_view::npos);
}

bool is_removed_by_none(std::string_view key) {
  const SceneKey* known = find_scene_key(key);
  if (!known) return is_effect_table(key) || is_coating(key);
  return known->description.type != Key::Type::kWord && known->description.type != Key::Type::kText;
}

void add_effect(SceneValues& scene, std::string_view table) {
  if (table == "emission") scene.emission.emplace();
  if (table == "source") scene.source.emplace();
  if (table == "surroundings") scene.surroundings.emplace();
  if (table == "path") scene.path.emplace();
}

void follow_keys(SceneValues& scene) {
  const auto width = [&](double wind_m_s) { return sigma_in_wind(wind_m_s, scene.surface.wind_model); };
  if (scene.surface.wind_m_s) scene.surface.sigma = width(*scene.surface.wind_m_s);
  std::vector<double>& sigmas = scene.grid[Axis::kSigma];
  if (!scene.wind_m_s.empty()) sigmas.clear();
  std::ranges::transform(scene.wind_m_s, std::back_inserter(sigmas), width);
  if (!scene.surroundings) return;
  Surroundings& sky = *scene.surroundings;
  if (sky.zenith_K && sky.horizon_K)
    sky.set_sky({.zenith_deg = {0.0, 90.0}, .values = {*sky.zenith_K, *sky.horizon_K}});
  if (sky.profile && sky.profile->kind == SkyProfile::Kind::kLayers)
    sky.set_sky(built_in_sky(scene.names.profile, sky.air, "surroundings.vapour_cm: ").value());
}

std::string Key::allowed() const {
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
    case Type::kNames:
      return "a text, or a list of texts";
    case Type::kPairs:
      return "a list of pairs of ascending numbers in " + range.text();
    case Type::kAxis:
      return "a number in " + range.text() + ", a list of them, or a range { from = ..., to = ..., count = ... }";
  }
  return {};
}

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  const bool above = ends == Ends::kOpenBelow ? value > min : value >= min;
  const bool below = ends == Ends::kOpenAbove ? value < max : value <= max;
  return above && below;
}

std::string NumberRange::text() const {
  const bool open_below = ends == Ends::kOpenBelow || std::isinf(min);
  const bool open_above = ends == Ends::kOpenAbove || std::isinf(max);
  return fmt::format("{}{}, {}{}", open_below ? '(' : '[', range_end_text(min), range_end_text(max),
                     open_above ? ')' : ']');
}

}  // namespace dolp
