#include "explore/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dolp::explore {
namespace {

using Number = std::optional<double>;
using Word = std::optional<std::size_t>;

const KeyDescription* described(const std::string& key) {
  const auto found = std::ranges::find(scene_keys(), key, &KeyDescription::key);
  if (found == scene_keys().end()) throw std::logic_error("no scene key " + key);
  return &*found;
}

bool has_own_index(const Scene& s) { return s.surface.material.name.empty() && s.surface.material.is_constant(); }

Number only_if(bool shown, double value) { return shown ? Number(value) : std::nullopt; }

bool is_bistatic(const Scene& s) { return s.geometry.mode == Mode::kBistatic; }

std::vector<Parameter> surface_parameters() {
  return {
      {described("surface.n"),
       "n",
       {1.0, 40.0},
       true,
       "N = n + ik",
       [](const Scene& s) { return only_if(has_own_index(s), s.surface.material.constant.n); }},
      {described("surface.k"),
       "k",
       {0.0, 100.0},
       false,
       "N = n + ik, k ≥ 0 absorbs",
       [](const Scene& s) { return only_if(has_own_index(s), s.surface.material.constant.k); }},
      {described("surface.sigma"),
       "σ",
       {0.01, 2.0},
       true,
       "m² = 2σ²; D(α) of eq. (8) or (1)",
       [](const Scene& s) { return Number(s.surface.sigma); }},
      {described("surface.q"),
       "q",
       {1.1, 20.0},
       true,
       "D = (q−1)/(π m² cos⁴α) · (1 + tan²α/m²)^(−q), eq. (8)",
       [](const Scene& s) { return only_if(s.surface.distribution == Distribution::kCauchy, s.surface.q); }},
      {described("surface.specular"),
       "k_s",
       {0.0, 1.0},
       false,
       "f_s = k_s D G M / (4 cos θi cos θr), eqs. (7), (15)",
       [](const Scene& s) { return Number(s.surface.specular); }},
      {described("surface.diffuse"),
       "k_d",
       {0.0, 1.0},
       false,
       "f_d = (k_d/π)(cos θi cos θr)^c, eq. (14)",
       [](const Scene& s) { return Number(s.surface.diffuse); }},
      {described("surface.diffuse_exponent"),
       "c",
       {-0.95, 0.0},
       false,
       "f_d = (k_d/π)(cos θi cos θr)^c, eq. (14)",
       [](const Scene& s) { return only_if(s.surface.diffuse > 0.0, s.surface.diffuse_exponent); }},
  };
}

std::vector<Parameter> radiation_parameters() {
  return {
      {described("emission.temperature_K"),
       "T",
       {200.0, 400.0},
       false,
       "emits (1 − ρ) B(λ, T), eq. (18)",
       [](const Scene& s) { return s.emission ? Number(s.emission->temperature_K) : std::nullopt; }},
      {described("source.irradiance"),
       "E0",
       {0.001, 1000.0},
       true,
       "reflects E0 cos θ ρ, eq. (18)",
       [](const Scene& s) {
         return s.source && s.source->kind == Source::Kind::kFlat ? Number(s.source->irradiance) : std::nullopt;
       }},
      {described("source.relative_irradiance"),
       "e",
       {0.001, 10.0},
       true,
       "e = E0/(π B(T)), eq. (18)",
       [](const Scene& s) {
         return s.source && s.source->kind == Source::Kind::kRelative ? Number(s.source->relative_irradiance)
                                                                      : std::nullopt;
       }},
      {described("source.scale"),
       "scale",
       {0.01, 100.0},
       true,
       "E0 → scale · E0",
       [](const Scene& s) { return s.source ? Number(s.source->scale) : std::nullopt; }},
      {described("surroundings.temperature_K"),
       "T_surr",
       {0.0, 400.0},
       false,
       "reflects B(λ, T_surr) ρ",
       [](const Scene& s) { return s.surroundings ? Number(s.surroundings->temperature_K) : std::nullopt; }},
      {described("path.transmittance"),
       "τ",
       {0.0, 1.0},
       false,
       "I → τ I + L_path",
       [](const Scene& s) { return s.path ? Number(s.path->transmittance) : std::nullopt; }},
      {described("path.temperature_K"),
       "T_path",
       {0.0, 400.0},
       false,
       "L_path = (1 − τ) B(λ, T_path)",
       [](const Scene& s) { return s.path ? s.path->temperature_K : std::nullopt; }},
      {described("path.radiance"),
       "L_path",
       {0.001, 100.0},
       true,
       "I → τ I + L_path",
       [](const Scene& s) { return s.path ? s.path->radiance : std::nullopt; }},
  };
}

std::vector<Parameter> geometry_parameters() {
  return {
      {described("spectrum.wavelength_um"),
       "λ",
       {1.0, 20.0},
       false,
       "B(λ, T), N(λ)",
       [](const Scene& s) { return only_if(!s.spectrum.is_band(), s.spectrum.min_um); }},
      {described("geometry.view_zenith_deg"), "θv", kZenithDegRange, false, "direction of the view, eq. (2)",
       [](const Scene& s) { return only_if(is_bistatic(s), s.geometry.view_zenith_deg); }},
      {described("geometry.relative_azimuth_deg"),
       "Δφ",
       {0.0, 360.0},
       false,
       "cos 2β = ωi · ωr, eq. (2)",
       [](const Scene& s) { return only_if(is_bistatic(s), s.geometry.relative_azimuth_deg); }},
      {described("accuracy.tolerance"),
       "tolerance",
       {1e-9, 1e-2},
       true,
       "|δDOLP|, |δρ|/ρ_I ≤ tolerance",
       [](const Scene& s) { return Number(s.accuracy.tolerance); }},
  };
}

template <class Value>
Word word_of(Value value) {
  return static_cast<std::size_t>(value);
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list = surface_parameters();
    for (const std::vector<Parameter>& more : {radiation_parameters(), geometry_parameters()}) {
      list.insert(list.end(), more.begin(), more.end());
    }
    return list;
  }();
  return all;
}

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all = {
      {described("surface.distribution"), "distribution", "D(α): eq. (8) cauchy, eq. (1) gaussian",
       [](const Scene& s) { return word_of(s.surface.distribution); }},
      {described("surface.masking"), "masking", "G: eqs. (9)–(13) for integral",
       [](const Scene& s) { return word_of(s.surface.masking); }},
      {described("surface.scattering"), "scattering", "the first facet alone, or all bounces in V-grooves",
       [](const Scene& s) { return word_of(s.surface.scattering); }},
      {described("emission.model"), "emissivity",
       "1 − ρ of the rough surface, 1 − R(θ) of the smooth one, or (1 − R) G of the facets in view",
       [](const Scene& s) { return s.emission ? word_of(s.emission->model) : std::nullopt; }},
      {described("emission.bracket"), "bracket", "ε_I between the direct emission and 1 − ρ_I",
       [](const Scene& s) { return s.emission ? word_of(s.emission->has_bracket) : std::nullopt; }},
      {described("geometry.mode"), "mode", "eq. (18) all around, or f of eq. (7) for one source and view",
       [](const Scene& s) { return word_of(s.geometry.mode); }},
      {described("accuracy.precision"), "precision", "arithmetic of the device",
       [](const Scene& s) { return word_of(s.accuracy.precision); }},
  };
  return all;
}

const Parameter& parameter(const std::string& key) {
  for (const Parameter& known : parameters()) {
    if (known.description->key == key) return known;
  }
  throw std::logic_error("no parameter " + key);
}

std::vector<std::string> words_of(const KeyDescription& description) {
  if (description.type == KeyDescription::Type::kFlag) return {"false", "true"};
  return description.words;
}

std::string table_of(const std::string& key) { return key.substr(0, key.find('.')); }

std::string unit_text(const KeyDescription& description) {
  if (description.unit == "1") return {};
  if (description.unit == "degree") return "°";
  if (description.unit == "um") return "µm";
  if (description.unit == "W m-2 um-1") return "W/m²/µm";
  if (description.unit == "W m-2 sr-1 um-1") return "W/m²/sr/µm";
  return description.unit;
}

double slider_position(const Parameter& parameter, double value) {
  const NumberRange& range = parameter.slider;
  const double inside = std::clamp(value, range.min, range.max);
  if (!parameter.is_log) return (inside - range.min) / (range.max - range.min);
  return std::log(inside / range.min) / std::log(range.max / range.min);
}

double slider_value(const Parameter& parameter, double position) {
  const NumberRange& range = parameter.slider;
  const double part = std::clamp(position, 0.0, 1.0);
  const double exact =
      parameter.is_log ? range.min * std::pow(range.max / range.min, part) : range.min + part * (range.max - range.min);
  // Four digits: what is typed into a file by hand, and reads back as the same number.
  if (exact == 0.0) return exact;
  const double digit = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(exact))));
  return std::clamp(std::round(exact * digit) / digit, range.min, range.max);
}

}  // namespace dolp::explore
