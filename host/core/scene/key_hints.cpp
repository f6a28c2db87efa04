#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/text.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

/// Names that users give to a key. The texts `tables` and `names` are lists with blanks between the items.
struct Synonyms {
  const char* tables;  ///< tables in which the names have this meaning; empty for all tables
  const char* names;   ///< without their units
  const char* key;
  const char* why = "";
};

constexpr const char* kZenith = "in bistatic mode theta is the zenith of the source, in hemispherical mode of the view";
constexpr const char* kSlope = "a slope, not a height; the roughness alpha of GGX is sqrt(2) sigma";
constexpr const char* kIndexFirst = "the emissivity follows from the index n + ik";

// The first row that fits counts.
constexpr Synonyms kSynonyms[] = {
    {"source sun light", "zenith theta theta_i angle incidence elevation direction", "grid.theta_deg", kZenith},
    {"source sun light", "azimuth phi", "geometry.relative_azimuth_deg"},
    {"source sun light", "e0 power flux radiance intensity temperature", "source.irradiance"},
    {"source sun light", "polarisation polarization stokes", "source.irradiance", "a source is unpolarised"},
    {"surroundings sky background environment atmosphere", "temperature temp t tsky", "surroundings.temperature_K"},
    {"surroundings sky background environment atmosphere", "model type preset file", "surroundings.profile"},
    {"path atmosphere", "temperature temp t", "path.temperature_K"},
    {"grid", "wavelength lambda wavelengths wl", "grid.wavelength_um"},
    {"grid", "temperature temp t", "grid.temperature_K"},
    {"grid", "roughness slope rms rms_slope alpha width", "grid.sigma", kSlope},
    {"grid", "index ior eta refractive_index", "grid.n"},
    {"geometry view camera sensor detector", "zenith theta theta_v theta_r view_angle angle elevation",
     "geometry.view_zenith_deg", "bistatic mode; in hemispherical mode the view has the zenith grid.theta_deg"},
    {"geometry view camera sensor detector", "azimuth phi delta_phi", "geometry.relative_azimuth_deg"},
    {"", "view_angle view_zenith camera_zenith sensor_zenith theta_v theta_r", "geometry.view_zenith_deg",
     "bistatic mode; in hemispherical mode the view has the zenith grid.theta_deg"},
    {"",
     "theta thetas theta_i zenith angle angles incidence incidence_angle angle_of_incidence aoi sun_zenith "
     "source_zenith solar_zenith",
     "grid.theta_deg", kZenith},
    {"", "azimuth phi delta_phi dphi", "geometry.relative_azimuth_deg"},
    {"", "sigma roughness rms rms_slope rms_roughness slope slopes alpha alpha_g m width", "surface.sigma", kSlope},
    {"", "refractive_index index ior eta nr n_real real n_r", "surface.n"},
    {"", "kappa extinction extinction_coefficient absorption absorption_index ni n_imag imag n_i", "surface.k"},
    {"", "epsilon eps permittivity dielectric_constant", "surface.n", "n + ik is the root of the permittivity"},
    {"", "emissivity emissivities emittance", "surface.n", kIndexFirst},
    {"", "tail tail_exponent exponent gamma shape nu", "surface.q"},
    {"", "ndf slope_distribution microfacet microfacets brdf", "surface.distribution"},
    {"", "shadowing attenuation geometric_attenuation g visibility", "surface.masking"},
    {"", "bounces multiple_scattering multiple", "surface.scattering"},
    {"", "k_s ks specular_weight gloss", "surface.specular"},
    {"", "k_d kd lambertian lambert albedo diffuse_weight diffuse_albedo", "surface.diffuse"},
    {"", "polarisation polarization", "surface.diffuse_polarisation", "the specular part is always polarised"},
    {"", "reflectance reflectivity reflectances", "surface.reflectance_file"},
    {"", "spectral_response srf rsr quantum_efficiency qe detectivity filter", "spectrum.response_file"},
    {"", "wind wind_speed u10", "surface.wind_m_s"},
    {"", "sigma_c sigma_y sigma_across anisotropy", "surface.sigma_cross"},
    {"", "wind_direction wind_azimuth brush_azimuth", "geometry.surface_azimuth_deg"},
    {"", "film films layer layers coatings thin_film", "surface.coating"},
    {"", "temperature temp t surface_temperature", "emission.temperature_K"},
    {"", "tsky t_sky sky_temperature ambient background_temperature t_surr t_bg", "surroundings.temperature_K"},
    {"", "humidity vapour vapor water_vapour water_vapor pwv vapor_cm", "surroundings.vapour_cm"},
    {"", "tau transmission transmissivity atmospheric_transmittance", "path.transmittance"},
    {"", "wavelength wavelengths lambda wl", "spectrum.wavelength_um"},
    {"", "band bands waveband bandpass", "spectrum.band_um"},
    {"", "e0 irradiance solar_irradiance", "source.irradiance"},
    {"", "tol rtol accuracy_goal", "accuracy.tolerance"},
    {"", "sky background environment", "surroundings"},
    {"", "sun light lamp laser", "source"},
    {"", "camera sensor view detector", "geometry"},
    {"", "atmosphere", "path"},
};

struct WordSynonyms {
  const char* key;
  const char* names;
  const char* hint;
};

constexpr WordSynonyms kWordSynonyms[] = {
    {"surface.distribution", "ggx trowbridge-reitz trowbridge tr gtr student student-t lorentz lorentzian",
     "GGX is \"cauchy\" with surface.q = 2, and its roughness alpha is sqrt(2) surface.sigma"},
    {"surface.distribution", "beckmann normal gauss cook-torrance cox-munk phong blinn",
     "Beckmann is \"gaussian\", and its roughness alpha is sqrt(2) surface.sigma"},
    {"surface.masking", "smith-ggx ggx uncorrelated correlated height-correlated bourlier", "did you mean \"smith\"?"},
    {"surface.masking", "vcavity v-cavities v-groove v-grooves cook-torrance torrance-sparrow blinn",
     "did you mean \"v-cavity\"?"},
    {"surface.masking", "off no false wang paper", "\"none\" has no masking; \"integral\" is the paper's"},
    {"surface.scattering", "single-bounce one first", "did you mean \"single\"?"},
    {"surface.scattering", "multi all many double second", "did you mean \"multiple\"?"},
    {"emission.model", "kirchhoff rough reflectance 1-rho", "did you mean \"moments\"?"},
    {"emission.model", "smooth mirror specular flat", "did you mean \"fresnel\"?"},
    {"geometry.mode", "directional monostatic brdf bidirectional bi-static beam", "did you mean \"bistatic\"?"},
    {"geometry.mode", "emission passive hemisphere diffuse", "did you mean \"hemispherical\"?"},
    {"source.preset", "solar sunlight am0", "did you mean \"sun\"?"},
    {"accuracy.precision", "single float32 fp32", "did you mean \"float\"?"},
    {"accuracy.precision", "float64 fp64", "did you mean \"double\"?"},
};

bool is_in(std::string_view list, std::string_view item) {
  const std::vector<std::string_view> items = split(list, ' ');
  return std::ranges::find(items, item) != items.end();
}

/// `name` without a unit at its end: "zenith" for "zenith_deg".
std::string_view without_unit(std::string_view name) {
  const std::size_t end = name.find_last_of('_');
  const bool has_unit = end != std::string_view::npos && is_in("deg degree rad k c um nm m", name.substr(end + 1));
  return has_unit ? name.substr(0, end) : name;
}

/// The key whose name is most similar to `key`.
std::string similar_key(const std::string& key) {
  std::vector<std::string> known = scene_tables();
  for (const Key& description : keys()) known.push_back(description.key);
  const auto distance = [&](const std::string& name) {
    return std::min({edit_distance(key, name), edit_distance(last_part(key), last_part(name)) + 1,
                     edit_distance(key, name.substr(0, key.size() + 1)) + 1});
  };
  return *std::ranges::min_element(known, {}, distance);
}

}  // namespace

std::string KeyHint::text() const { return why.empty() ? key : fmt::format("{} ({})", key, why); }

std::optional<KeyHint> key_by_meaning(std::string_view unknown) {
  const std::string key = lower_case(unknown);
  const std::size_t dot = key.find('.');
  const std::string table = dot == std::string::npos ? "" : key.substr(0, dot);
  const std::string name = last_part(key);
  const auto fits = [&](const Synonyms& row) {
    if (*row.tables != '\0' && !is_in(row.tables, table)) return false;
    return is_in(row.names, name) || is_in(row.names, without_unit(name));
  };
  const auto* const found = std::ranges::find_if(kSynonyms, fits);
  if (found == std::end(kSynonyms)) return std::nullopt;
  return KeyHint{found->key, found->why};
}

std::string key_hint(std::string_view key) {
  const std::optional<KeyHint> meant = key_by_meaning(key);
  return meant ? meant->text() : similar_key(std::string(key));
}

std::string word_hint(std::string_view key, std::string_view word) {
  const std::string wanted = lower_case(word);
  const auto fits = [&](const WordSynonyms& row) { return row.key == key && is_in(row.names, wanted); };
  const auto* const found = std::ranges::find_if(kWordSynonyms, fits);
  return found == std::end(kWordSynonyms) ? "" : fmt::format("; {}", found->hint);
}

}  // namespace dolp
