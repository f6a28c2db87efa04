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

KeyValue to_key_value(double number) { return {.number = number}; }
KeyValue to_key_value(bool flag) { return {.word = flag ? 1U : 0U, .text = flag ? "true" : "false"}; }
KeyValue to_key_value(const std::string& text) { return {.text = text}; }
KeyValue to_key_value(const std::vector<double>& numbers) { return {.numbers = numbers}; }
KeyValue to_key_value(const std::vector<std::string>& names) { return {.names = names}; }
template <class Choice>
KeyValue to_key_value(Choice choice) requires std::is_enum_v<Choice> {
  return {.word = static_cast<std::size_t>(choice), .text = to_name(choice)};
}
void assign(double& number, const KeyValue& v) { number = v.number; }
void assign(std::optional<double>& number, const KeyValue& v) { number = v.number; }
void assign(bool& flag, const KeyValue& v) { flag = v.word == 1; }
void assign(std::string& text, const KeyValue& v) { text = v.text; }
void assign(std::vector<double>& numbers, const KeyValue& v) { numbers = v.numbers; }
void assign(std::vector<std::string>& names, const KeyValue& v) { names = v.names; }
template <class Choice>
void assign(Choice& choice, const KeyValue& v) requires std::is_enum_v<Choice> {
  choice = static_cast<Choice>(v.word);
}

/// The value at `at`. nullopt for a null pointer, an empty text or list, and an absent number.
template <class Content>
std::optional<KeyValue> value_at(const Content* at) {
  if (!at) return std::nullopt;
  if constexpr (std::is_same_v<Content, std::optional<double>>) {
    return *at ? std::optional(to_key_value(**at)) : std::nullopt;
  } else if constexpr (requires { at->empty(); }) {
    return at->empty() ? std::nullopt : std::optional(to_key_value(*at));
  } else {
    return to_key_value(*at);
  }
}

bool always(const SceneValues&) { return true; }

/// Makes a key. `address(scene)`: pointer to the value, or null. `is_there(scene)`: true if the scene has the value.
template <class Address, class IsThere>
SceneKey key_at(Key description, Address address, IsThere is_there) {
  return {std::move(description), [address](SceneValues& s, const KeyValue& v) { assign(*address(s), v); },
          [address, is_there](const SceneValues& s) { return is_there(s) ? value_at(address(s)) : std::nullopt; }};
}

Key described(const std::string& key, Type type, const char* unit, const NumberRange& range, const char* fallback,
              const char* meaning, std::vector<std::string> words = {}) {
  return {key, type, unit, range, std::move(words), fallback, meaning};
}

SceneKey with_set(SceneKey key, std::function<void(SceneValues& scene, const KeyValue& value)> set) {
  key.set = std::move(set);
  return key;
}

template <class Address, class IsThere = decltype(&always)>
SceneKey number(const std::string& key, const char* unit, const NumberRange& range, const char* fallback,
                const char* meaning, Address address, IsThere is_there = always) {
  return key_at(described(key, Type::kNumber, unit, range, fallback, meaning), address, is_there);
}

template <class Choice, class Address>
SceneKey choice(const char* key, Choice fallback, const char* meaning, Address address) {
  const auto words = choice_names(fallback);
  return key_at(described(key, Type::kWord, "", {}, to_name(fallback), meaning, {words.begin(), words.end()}), address,
                always);
}

template <class Address>
SceneKey flag(const char* key, const char* meaning, Address address) {
  return key_at(described(key, Type::kFlag, "", {}, "false", meaning, {"false", "true"}), address, always);
}

template <class Address, class IsThere = decltype(&always)>
SceneKey text(const std::string& key, const char* meaning, Address address, IsThere is_there = always) {
  return key_at(described(key, Type::kText, "", {}, "", meaning), address, is_there);
}

SceneKey grid_axis(Axis axis, const char* fallback, const char* meaning) {
  const AxisDescription& axis_description = describe(axis);
  return key_at(
      described(std::string("grid.") + axis_description.column, Type::kAxis, axis_description.units,
                axis_description.range, fallback, meaning),
      [axis](auto& s) { return &s.grid[axis]; }, always);
}

template <class Element>
void append(std::vector<Element>& all, std::vector<Element> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

bool has_own_index(const SceneValues& s) {
  return s.names.material.empty() && s.names.material_file.empty() && s.labels[Axis::kMaterial].empty();
}

void set_sigma(SceneValues& s, const KeyValue& v) {
  s.surface.sigma = v.number;
  s.surface.wind_m_s.reset();
}

/// Computes the slope widths of the winds, which the keys of the winds and of their model give in any order.
void take_winds(SceneValues& s) {
  const auto width = [&](double wind_m_s) { return sigma_in_wind(wind_m_s, s.surface.wind_model); };
  if (s.surface.wind_m_s) s.surface.sigma = width(*s.surface.wind_m_s);
  if (s.wind_m_s.empty()) return;
  s.grid[Axis::kSigma].clear();
  std::ranges::transform(s.wind_m_s, std::back_inserter(s.grid[Axis::kSigma]), width);
}

void set_wind(SceneValues& s, const KeyValue& v) {
  s.surface.wind_m_s = v.number;
  take_winds(s);
}

void set_wind_model(SceneValues& s, const KeyValue& v) {
  assign(s.surface.wind_model, v);
  take_winds(s);
}

/// Makes a key that gives E0. Its setter also sets the kind of the source.
SceneKey source_number(const char* key, const char* unit, const char* meaning, Source::Kind kind,
                       double Source::*number_member) {
  const auto is_kind = [kind](const SceneValues& s) { return s.source && s.source->kind == kind; };
  const auto set = [=](SceneValues& s, const KeyValue& v) {
    s.source->kind = kind;
    (*s.source).*number_member = v.number;
  };
  return with_set(
      number(
          key, unit, kNonNegativeRange, "", meaning, [=](auto& s) { return &((*s.source).*number_member); }, is_kind),
      set);
}

/// Makes a key for a number of SkyAir. In a scene that has already been read, the key's setter computes the sky again.
SceneKey air_number(const char* key, const char* unit, const NumberRange& range, const char* meaning,
                    std::optional<double> SkyAir::*number_member) {
  const auto set = [=](SceneValues& s, const KeyValue& v) {
    s.surroundings->air.*number_member = v.number;
    if (s.document)
      s.surroundings->set_sky(built_in_sky(s.names.profile, s.surroundings->air, key + std::string(": ")).value());
  };
  return with_set(number(key, unit, range, "", meaning,
                         [=](auto& s) { return s.surroundings ? &(s.surroundings->air.*number_member) : nullptr; }),
                  set);
}

/// Makes a key for an end of a sky whose temperature is a straight line in the zenith.
SceneKey sky_end(const char* key, const char* meaning, std::optional<double> Surroundings::*end_K) {
  const auto set = [=](SceneValues& s, const KeyValue& v) {
    Surroundings& sky = *s.surroundings;
    sky.*end_K = v.number;
    if (sky.zenith_K && sky.horizon_K)
      sky.set_sky({.zenith_deg = {0.0, 90.0}, .values = {*sky.zenith_K, *sky.horizon_K}});
  };
  return with_set(number(key, "K", kBackgroundTemperatureRange, "", meaning,
                         [=](auto& s) { return s.surroundings ? &((*s.surroundings).*end_K) : nullptr; }),
                  set);
}

SceneKey wind_axis() {
  const auto set = [](SceneValues& s, const KeyValue& v) {
    s.wind_m_s = v.numbers;
    take_winds(s);
  };
  return with_set(key_at(
                      described("grid.wind_m_s", Type::kAxis, kWind.units, kWind.range, "",
                                "winds of the table, instead of grid.sigma"),
                      [](auto& s) { return &s.wind_m_s; }, always),
                  set);
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
  const auto name_address = [=](auto SceneNames::OfLayer::*name) {
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
           name_address(&SceneNames::OfLayer::material), has_layer),
      text(begin + "material_file", "file with your own values of the film's n and k, instead of n and k",
           name_address(&SceneNames::OfLayer::material_file), has_layer),
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
      with_set(number("surface.sigma", "1", kSigmaRange, "required",
                      "slope width sigma, with m^2 = 2 sigma^2; if absent, the first value of grid.sigma",
                      [](auto& s) { return &s.surface.sigma; }),
               set_sigma),
      with_set(
          number("surface.wind_m_s", "m s-1", kWindRange, "",
                 "wind over a sea; sets sigma by 2 sigma^2 = 0.003 + 0.00512 wind; only with distribution gaussian",
                 [](auto& s) { return &s.surface.wind_m_s; }),
          set_wind),
      with_set(choice("surface.wind_model", Surface().wind_model,
                      "isotropic: the wind gives one slope width; directional: sigma^2 = 0.00316 wind along it, and "
                      "0.003 + 0.00192 wind across (masking none or v-cavity; smith only with emission.model = direct)",
                      [](auto& s) { return &s.surface.wind_model; }),
               set_wind_model),
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
      source_number("source.irradiance", "W m-2 um-1",
                    "irradiance E0 of the source at normal incidence, constant over a band", Source::Kind::kFlat,
                    &Source::irradiance),
      source_number("source.relative_irradiance", "1",
                    "E0/(pi B(T)) at each wavelength, with T = emission.temperature_K; instead of irradiance",
                    Source::Kind::kRelative, &Source::relative_irradiance),
      key_at(
          described("source.preset", Type::kWord, "", {}, "",
                    "E0 of the sun at the top of the atmosphere, instead of source.irradiance", {"sun"}),
          [](auto& s) { return &s.names.source_preset; }, always),
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
      sky_end("surroundings.zenith_temperature_K",
              "brightness temperature of the sky in the zenith; between zenith and horizon it is a straight line in "
              "the zenith angle",
              &Surroundings::zenith_K),
      sky_end("surroundings.horizon_temperature_K", "brightness temperature of the sky at the horizon",
              &Surroundings::horizon_K),
      text("surroundings.profile",
           "sky that changes with the zenith, instead of temperature_K: clear-sky, overcast, or your own CSV file "
           "(columns zenith_deg, temperature_K or radiance; wavelength_um if the sky depends on the wavelength)",
           [](auto& s) { return &s.names.profile; }),
      air_number("surroundings.vapour_cm", "cm", kVapourRange,
                 "precipitable water of the air of clear-sky or overcast; if absent, 1.27 cm, or all that the air "
                 "holds if this is less",
                 &SkyAir::vapour_cm),
      air_number("surroundings.air_temperature_K", "K", kAirTemperatureRange,
                 "temperature of the air at the ground under clear-sky or overcast; if absent, 288.15 K",
                 &SkyAir::temperature_K),
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
       [](SceneValues& s, const KeyValue& v) {
         s.spectrum = {v.number, v.number};
       },
       [](const SceneValues& s) { return s.spectrum.is_band() ? std::nullopt : value_at(&s.spectrum.min_um); }},
      {{"spectrum.band_um", Type::kPair, "um", kWavelengthUmRange, {}, "", "band [lambda1, lambda2] to integrate over"},
       [](SceneValues& s, const KeyValue& v) {
         s.spectrum = {v.numbers[0], v.numbers[1]};
       },
       [](const SceneValues& s) -> std::optional<KeyValue> {
         if (!s.spectrum.is_band()) return std::nullopt;
         return KeyValue{.numbers = {s.spectrum.min_um, s.spectrum.max_um}};
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
      wind_axis(),
      key_at(
          described("grid.material", Type::kNames, "", {}, "",
                    "names of built-in materials for the table, or \"all\"; instead of n and k"),
          [](auto& s) { return &s.labels[Axis::kMaterial]; }, always),
      {{"grid.band_um", Type::kPairs, "um", kWavelengthUmRange, {}, "", "bands of the table, instead of [spectrum]"},
       [](SceneValues& s, const KeyValue& v) {
         for (std::size_t i = 0; i < v.numbers.size(); i += 2) s.bands.push_back({v.numbers[i], v.numbers[i + 1]});
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
      {described(
           "accuracy.interpolation", Type::kWord, "", {}, "auto",
           "auto: within the tolerance the program may interpolate over a dense grid of sigma and q, or over many "
           "points, and compute many indices in one pass; off: it integrates every entry",
           {"auto", "off"}),
       [](SceneValues& s, const KeyValue& v) { s.accuracy.may_interpolate = v.word == 0; },
       [](const SceneValues& s) -> std::optional<KeyValue> {
         const bool is_auto = s.accuracy.may_interpolate;
         return KeyValue{.word = is_auto ? std::size_t{0} : 1, .text = is_auto ? "auto" : "off"};
       }},
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
      all.push_back({table, {{{key("n")}, {key("k")}}, {{key("material")}}, {{key("material_file")}}}, true, true});
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
