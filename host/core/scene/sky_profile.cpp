#include "scene/sky_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>
#include <iterator>
#include <span>
#include <utility>

#include "base/text.hpp"
#include "model/angles.hpp"
#include "scene/scene.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostZeniths = 1000;

// Zeniths at which intervals of zenith end. A table has kDivisions_deg in addition to its own zeniths. kLayers has
// kLayerDivisions_deg. Intervals are short near the horizon, where the radiance may change like exp(-1 / cos(zenith)).
constexpr std::array<double, 2> kDivisions_deg = {60.0, 85.0};
constexpr std::array<double, 11> kLayerDivisions_deg = {0.0,  30.0, 60.0,  75.0,  82.0, 86.0,
                                                        88.0, 89.0, 89.75, 89.94, 90.0};

// An interval of zeniths is cut until the temperatures in each part differ at most by the factor kDivisionRatio. Then
// Planck's function is smooth. Temperatures below kColdestShare of the warmest one radiate too little to need cuts.
constexpr double kDivisionRatio = 2.0;
constexpr double kColdestShare = 1.0 / 256.0;

// Air of the US Standard Atmosphere 1976 at sea level: 15 degrees C, and 5.9 g m-3 of water vapour, which is 7.85 hPa.
constexpr double kAir_K = 288.15;
constexpr double kVapour_hPa = 7.85;
// Precipitable water in cm = kWater_cmK_hPa times vapour pressure in hPa / temperature in K. Source: Prata, Q. J. R.
// Meteorol. Soc. 122, 1127 (1996).
constexpr double kWater_cmK_hPa = 46.5;
constexpr double kWindowFrom_um = 10.5;
constexpr double kWindowTo_um = 12.5;

// Vertical emissivity of clear air at 8-14 and 10.5-12.5 um. Source: Idso, Water Resources Research 17, 295 (1981).
double clear_emissivity(double vapour_hPa, double air_K) {
  return std::min(0.24 + 2.98e-8 * vapour_hPa * vapour_hPa * std::exp(3000.0 / air_K), 1.0);
}
double window_emissivity(double vapour_hPa, double air_K) {
  return std::min(0.10 + 3.53e-8 * vapour_hPa * vapour_hPa * std::exp(3000.0 / air_K), 1.0);
}

// Vapour pressure of saturated air. Source: Alduchov and Eskridge, J. Appl. Meteorol. 35, 601 (1996).
double saturated_hPa(double air_K) { return 6.1094 * std::exp(17.625 * (air_K - 273.15) / (air_K - 30.11)); }

double vapour_pressure(const SkyAir& air, double air_K, const std::string& prefix) {
  if (!air.vapour_cm) return std::min(kVapour_hPa, saturated_hPa(air_K));
  const double vapour_hPa = *air.vapour_cm * air_K / kWater_cmK_hPa;
  const double most_cm = saturated_hPa(air_K) * kWater_cmK_hPa / air_K;
  if (*air.vapour_cm <= most_cm) return vapour_hPa;
  throw InputError(fmt::format("{}air at {} K holds at most {:.3g} cm of water vapour", prefix, air_K, most_cm));
}
// Band of carbon dioxide in which a few metres of air are opaque.
constexpr double kOpaqueFrom_um = 4.17;
constexpr double kOpaqueTo_um = 4.45;
// Overcast: a black cloud with its base at a height of 1 km. It is as warm as the air at this height. Source: Martin
// and Berdahl, Solar Energy 33, 321 (1984). The air cools by 6.5 K per km of height. Its vapour falls to 1 / e in 2 km.
constexpr double kCloudBase_km = 1.0;
constexpr double kLapse_K_km = 6.5;
constexpr double kVapourHeight_km = 2.0;

const char* value_column(bool is_radiance) { return is_radiance ? "radiance" : "temperature_K"; }

CsvColumns read_header(CsvReader& reader) {
  CsvColumns columns = CsvColumns::read_names(reader, {{"zenith_deg", kZenithDegRange, true},
                                                       {"temperature_K", kBackgroundTemperatureRange},
                                                       {"radiance", kNonNegativeRange, false, {}, "W m-2 sr-1 um-1"},
                                                       {"wavelength_um", kWavelengthUmRange}});
  const bool has_radiance = columns.has("radiance");
  if (columns.has("temperature_K") == has_radiance) {
    reader.fail(fmt::format("needs one of the columns temperature_K, a number in {}, and radiance, W m-2 sr-1 um-1{}",
                            kBackgroundTemperatureRange.text(), has_radiance ? "; both are there" : ""));
  }
  return columns;
}

}  // namespace

double SkyProfile::vertical_emissivity(double at_um) const {
  if (at_um >= kOpaqueFrom_um && at_um <= kOpaqueTo_um) return 1.0;
  if (at_um >= kWindowFrom_um && at_um <= kWindowTo_um) return window;
  if (at_um >= kSkyBandFrom_um && at_um <= kSkyBandTo_um) return beside_window;
  return emissivity;
}

double SkyProfile::emitted_share(double vertical_emissivity, double at_deg) {
  const double cosine = cos_sin_deg(at_deg).cos;
  return cosine <= 0.0 ? 1.0 : 1.0 - std::pow(1.0 - vertical_emissivity, 1.0 / cosine);
}

SkyProfile::Emission SkyProfile::at(double at_um, double at_deg) const {
  if (kind == Kind::kLayers) return {emitted_share(vertical_emissivity(at_um), at_deg), air_K, beyond_K, 0.0};
  const Between zenith = between(zenith_deg, at_deg);
  const Between wavelength = between(wavelength_um, at_um);
  const auto on_line = [&](std::size_t line) {
    const double* row = &values[line * zenith_deg.size() + zenith.first];
    return std::lerp(row[0], row[1], zenith.share);
  };
  double value = on_line(wavelength.first);
  if (wavelength.share > 0.0) value = std::lerp(value, on_line(wavelength.first + 1), wavelength.share);
  if (kind == Kind::kRadiance) return {.share = 0.0, .radiance = value};
  return {.share = 1.0, .first_K = value};
}

std::vector<double> SkyProfile::temperature_divisions_deg(std::size_t interval) const {
  double cold = 1.0;
  double warm = 0.0;
  bool rises = true;
  for (std::size_t i = interval; i + 1 < values.size(); i += zenith_deg.size()) {
    const auto [least, most] = std::minmax(values[i], values[i + 1]);
    if (least * warm > cold * most || most == 0.0) continue;
    cold = least;
    warm = most;
    rises = values[i + 1] > values[i];
  }
  std::vector<double> divisions;
  for (double at_K = warm / kDivisionRatio; at_K > std::max(cold, kColdestShare * warm); at_K /= kDivisionRatio) {
    const double share = (at_K - cold) / (warm - cold);
    divisions.push_back(std::lerp(zenith_deg[interval], zenith_deg[interval + 1], rises ? share : 1.0 - share));
  }
  return divisions;
}

std::vector<double> SkyProfile::ends_deg() const {
  if (kind == Kind::kLayers) return {kLayerDivisions_deg.begin(), kLayerDivisions_deg.end()};
  std::vector<double> ends = zenith_deg;
  for (std::size_t i = 0; kind == Kind::kTemperature && i + 1 < zenith_deg.size(); ++i)
    std::ranges::copy(temperature_divisions_deg(i), std::back_inserter(ends));
  ends.insert(ends.end(), kDivisions_deg.begin(), kDivisions_deg.end());
  std::ranges::sort(ends);
  const auto twice = std::ranges::unique(ends);
  ends.erase(twice.begin(), twice.end());
  return ends;
}

std::vector<double> SkyProfile::breaks_um() const {
  if (kind == Kind::kLayers)
    return {kOpaqueFrom_um, kOpaqueTo_um, kSkyBandFrom_um, kWindowFrom_um, kWindowTo_um, kSkyBandTo_um};
  return wavelength_um;
}

std::optional<double> SkyProfile::only_temperature() const {
  if (kind != Kind::kTemperature) return std::nullopt;
  const bool is_one = std::ranges::all_of(values, [&](double value) { return value == values.front(); });
  return is_one ? std::optional(values.front()) : std::nullopt;
}

void Surroundings::set_sky(SkyProfile sky) {
  const std::optional<double> everywhere = sky.only_temperature();
  if (everywhere) temperature_K = *everywhere;
  profile = everywhere ? nullptr : std::make_shared<const SkyProfile>(std::move(sky));
}

std::string SkyProfile::text() const {
  if (kind == Kind::kLayers) return {};
  const bool is_spectral = !wavelength_um.empty();
  std::string text =
      fmt::format("{}zenith_deg,{}\n", is_spectral ? "wavelength_um," : "", value_column(kind == Kind::kRadiance));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_spectral) text += format_number(wavelength_um[i / zenith_deg.size()]) + ',';
    text += format_number(zenith_deg[i % zenith_deg.size()]) + ',' + format_number(values[i]) + '\n';
  }
  return text;
}

const std::vector<BuiltInSky>& built_in_skies() {
  static const std::vector<BuiltInSky> skies = {
      {"clear-sky",
       "air of the US Standard Atmosphere 1976 at sea level, or of vapour_cm and air_temperature_K, with the emittance "
       "of Idso (1981) in the vertical, opaque at 4.17-4.45 um, plane-parallel as in Granqvist and Hjortsberg (1981)"},
      {"overcast", "a black cloud with its base at 1 km (Martin and Berdahl 1984), behind the same air below it"}};
  return skies;
}

std::optional<SkyProfile> built_in_sky(std::string_view name, const SkyAir& air, const std::string& prefix) {
  const bool is_overcast = name == "overcast";
  if (name != "clear-sky" && !is_overcast) return std::nullopt;
  SkyProfile sky;
  sky.kind = SkyProfile::Kind::kLayers;
  sky.air_K = air.temperature_K.value_or(kAir_K);
  if (is_overcast) sky.beyond_K = sky.air_K - kLapse_K_km * kCloudBase_km;
  const double vapour_hPa = vapour_pressure(air, sky.air_K, prefix);
  // Share of the vapour that is below the cloud; 1 without a cloud.
  const double below = is_overcast ? -std::expm1(-kCloudBase_km / kVapourHeight_km) : 1.0;
  const auto visible = [&](double vertical) { return is_overcast ? 1.0 - std::pow(1.0 - vertical, below) : vertical; };
  const double mean = clear_emissivity(vapour_hPa, sky.air_K);
  sky.emissivity = visible(mean);
  const double window = std::min(window_emissivity(vapour_hPa, sky.air_K), mean);
  const double share = (kWindowTo_um - kWindowFrom_um) / (kSkyBandTo_um - kSkyBandFrom_um);
  sky.window = visible(window);
  sky.beside_window = visible(std::min((mean - share * window) / (1.0 - share), 1.0));
  return sky;
}

SkyProfile parse_sky_profile(std::string_view text, const std::string& name) {
  CsvReader reader(text, name, kDataFile);
  const CsvColumns columns = read_header(reader);
  const bool is_radiance = columns.has("radiance");
  SkyProfile profile;
  profile.kind = is_radiance ? SkyProfile::Kind::kRadiance : SkyProfile::Kind::kTemperature;
  const std::vector<AngleRow> rows = read_angle_rows(reader, columns, "zenith_deg", {value_column(is_radiance)}, name);
  for (const AngleRow& row : rows) {
    if (row.wavelength_um == rows.front().wavelength_um) profile.zenith_deg.push_back(row.angle_deg);
    if (row.angle_deg == 0.0 && row.wavelength_um > 0.0) profile.wavelength_um.push_back(row.wavelength_um);
    profile.values.push_back(row.values.front());
  }
  if (profile.zenith_deg.size() > kMostZeniths)
    reader.fail(fmt::format("{} zeniths are too many; at most {}", profile.zenith_deg.size(), kMostZeniths));
  return profile;
}

}  // namespace dolp
