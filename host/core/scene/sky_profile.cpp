#include "scene/sky_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "base/hash.hpp"
#include "base/text.hpp"
#include "model/angles.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostZeniths = 1000;
constexpr std::size_t kMostProfileRows = 100'000;

// Zeniths that divide smooth stretches: Chebyshev points do not reach far beside a horizon where exp(-1/cos) is flat.
constexpr std::array<double, 2> kDivisions_deg = {60.0, 85.0};
constexpr std::array<double, 11> kLayerDivisions_deg = {0.0,  30.0, 60.0,  75.0,  82.0, 86.0,
                                                        88.0, 89.0, 89.75, 89.94, 90.0};

// Air at sea level of the US Standard Atmosphere, 1976: 15 degrees C, and 5.9 g m-3 of water vapour, 7.85 hPa.
constexpr double kAir_K = 288.15;
constexpr double kVapour_hPa = 7.85;
// Idso, Water Resources Research 17, 295 (1981): emittance of a cloudless sky at 8-14 um.
double clear_emissivity() { return 0.24 + 2.98e-8 * kVapour_hPa * kVapour_hPa * std::exp(3000.0 / kAir_K); }
// The band of carbon dioxide at 4.3 um, in which a few metres of air are opaque: an idealisation with sharp edges.
constexpr double kOpaqueFrom_um = 4.17;
constexpr double kOpaqueTo_um = 4.45;
// A black cloud whose base is 1 km high, below 1 km of the standard atmosphere's 2 km of vapour (scale height) and
// 6.5 K/km. Martin and Berdahl, Solar Energy 33, 321 (1984): low clouds are black at the temperature of their base.
constexpr double kCloudBase_km = 1.0;
constexpr double kLapse_K_km = 6.5;
constexpr double kVapourHeight_km = 2.0;

/// Columns of a file.
struct ProfileColumns {
  std::size_t count = 0;
  std::size_t zenith = 0;
  std::size_t value = 0;
  std::optional<std::size_t> wavelength;
  bool is_radiance = false;
};

const NumberRange& value_range(bool is_radiance) {
  return is_radiance ? kNonNegativeRange : kBackgroundTemperatureRange;
}

const char* value_column(bool is_radiance) { return is_radiance ? "radiance" : "temperature_K"; }

ProfileColumns columns_of(const CsvReader& header) {
  ProfileColumns columns;
  std::optional<std::size_t> zenith, temperature, radiance;
  columns.count = header.cells().size();
  for (std::size_t i = 0; i < columns.count; ++i) {
    const std::string_view name = header.cells()[i];
    std::optional<std::size_t>* place = name == "zenith_deg"      ? &zenith
                                        : name == "temperature_K" ? &temperature
                                        : name == "radiance"      ? &radiance
                                        : name == "wavelength_um" ? &columns.wavelength
                                                                  : nullptr;
    if (!place)
      header.fail(fmt::format("column \"{}\": unknown; must be zenith_deg, temperature_K or radiance, wavelength_um",
                              one_line(name)));
    if (*place) header.fail(fmt::format("column \"{}\" appears twice", name));
    *place = i;
  }
  if (!zenith) header.fail("column \"zenith_deg\" is missing, a number in " + kZenithDegRange.text());
  if (temperature.has_value() == radiance.has_value()) {
    header.fail(fmt::format("needs one of the columns temperature_K, a number in {}, and radiance, W m-2 sr-1 um-1{}",
                            kBackgroundTemperatureRange.text(), radiance ? "; both are there" : ""));
  }
  columns.zenith = *zenith;
  columns.is_radiance = radiance.has_value();
  columns.value = columns.is_radiance ? *radiance : *temperature;
  return columns;
}

/// Puts rows into a profile, one by one.
class RowReader {
 public:
  RowReader(SkyProfile& profile, const ProfileColumns& columns) : profile_(profile), columns_(columns) {}

  void add(const CsvReader& row) {
    if (row.cells().size() != columns_.count)
      row.fail(fmt::format("{} cells; {} are expected", row.cells().size(), columns_.count));
    if (profile_.values.size() == kMostProfileRows)
      row.fail(fmt::format("too many rows; at most {}", kMostProfileRows));
    const double zenith_deg = row.number(columns_.zenith, "zenith_deg", &kZenithDegRange);
    const double value =
        row.number(columns_.value, value_column(columns_.is_radiance), &value_range(columns_.is_radiance));
    if (columns_.wavelength)
      begin_wavelength(row, row.number(*columns_.wavelength, "wavelength_um", &kWavelengthUmRange));
    if (is_first_wavelength()) {
      add_zenith(row, zenith_deg);
    } else {
      check_zenith(row, zenith_deg);
    }
    ++of_wavelength_;
    profile_.values.push_back(value);
  }

  void finish(const CsvReader& end) const {
    if (profile_.values.empty()) end.fail("no rows; zenith_deg from 0 to 90 is expected");
    check_last(end, "after");
  }

 private:
  bool is_first_wavelength() const { return profile_.wavelength_um.size() < 2; }

  void begin_wavelength(const CsvReader& row, double wavelength_um) {
    std::vector<double>& known = profile_.wavelength_um;
    if (!known.empty() && wavelength_um == known.back()) return;
    if (!known.empty()) {
      if (wavelength_um < known.back())
        row.fail(
            fmt::format("wavelength_um = {}: must not be below {}, the one before; rows go by wavelength, then by "
                        "zenith",
                        wavelength_um, known.back()));
      check_last(row, "before");
    }
    known.push_back(wavelength_um);
    of_wavelength_ = 0;
  }

  void add_zenith(const CsvReader& row, double zenith_deg) {
    std::vector<double>& known = profile_.zenith_deg;
    if (known.empty() && zenith_deg != 0.0)
      row.fail(fmt::format("zenith_deg = {}: must be 0 in the first row; the last has 90", zenith_deg));
    if (!known.empty() && zenith_deg <= known.back())
      row.fail(
          fmt::format("zenith_deg = {}: must be greater than {}, the one before, up to 90", zenith_deg, known.back()));
    if (known.size() == kMostZeniths) row.fail(fmt::format("too many zeniths; at most {}", kMostZeniths));
    known.push_back(zenith_deg);
  }

  void check_zenith(const CsvReader& row, double zenith_deg) const {
    const std::vector<double>& known = profile_.zenith_deg;
    const double wanted = of_wavelength_ < known.size() ? known[of_wavelength_] : kNan;
    if (zenith_deg == wanted) return;
    row.fail(of_wavelength_ < known.size()
                 ? fmt::format("zenith_deg = {}: must be {}, as at the first wavelength", zenith_deg, wanted)
                 : fmt::format("zenith_deg = {}: a row too many; each wavelength has the same zeniths", zenith_deg));
  }

  void check_last(const CsvReader& row, const char* place) const {
    const std::vector<double>& known = profile_.zenith_deg;
    if (of_wavelength_ < known.size())
      row.fail(fmt::format("a row with zenith_deg = {} is missing {} this one", known[of_wavelength_], place));
    if (known.back() != 90.0) row.fail(fmt::format("zenith_deg ends at {}; must be 90 in the last row", known.back()));
  }

  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  SkyProfile& profile_;
  const ProfileColumns& columns_;
  std::size_t of_wavelength_ = 0;  ///< rows of the last wavelength
};

/// Position of the interval of an ascending list that holds a value, and the value's share of the way through it.
struct Between {
  std::size_t first = 0;
  double share = 0.0;
};
Between between(const std::vector<double>& list, double value) {
  if (list.size() < 2) return {};
  const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, value);
  const auto first = static_cast<std::size_t>(above - list.begin()) - 1;
  return {first, std::clamp((value - list[first]) / (list[first + 1] - list[first]), 0.0, 1.0)};
}

}  // namespace

SkyProfile::Emission SkyProfile::at(double at_um, double at_deg) const {
  if (kind == Kind::kLayers) {
    const bool is_opaque = at_um >= kOpaqueFrom_um && at_um <= kOpaqueTo_um;
    const double cosine = cos_sin_deg(at_deg).cos;
    const double passed = is_opaque || cosine <= 0.0 ? 0.0 : std::pow(1.0 - emissivity, 1.0 / cosine);
    return {1.0 - passed, air_K, beyond_K, 0.0};
  }
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

std::vector<double> SkyProfile::ends_deg() const {
  if (kind == Kind::kLayers) return {kLayerDivisions_deg.begin(), kLayerDivisions_deg.end()};
  std::vector<double> ends = zenith_deg;
  ends.insert(ends.end(), kDivisions_deg.begin(), kDivisions_deg.end());
  std::ranges::sort(ends);
  const auto twice = std::ranges::unique(ends);
  ends.erase(twice.begin(), twice.end());
  return ends;
}

std::vector<double> SkyProfile::breaks_um() const {
  if (kind == Kind::kLayers) return {kOpaqueFrom_um, kOpaqueTo_um};
  return wavelength_um;
}

std::optional<double> SkyProfile::only_temperature() const {
  if (kind != Kind::kTemperature) return std::nullopt;
  const bool is_one = std::ranges::all_of(values, [&](double value) { return value == values.front(); });
  return is_one ? std::optional(values.front()) : std::nullopt;
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

std::uint64_t SkyProfile::hash() const {
  std::uint64_t hash = hashed(kHashStart, static_cast<std::uint64_t>(kind));
  for (const std::vector<double>* list : {&zenith_deg, &wavelength_um, &values}) hash = hashed(hash, std::span(*list));
  return hashed(hash, std::span<const double>(std::array{air_K, beyond_K, emissivity}));
}

const std::vector<BuiltInSky>& built_in_skies() {
  static const std::vector<BuiltInSky> skies = {
      {"clear-sky",
       "air of the US Standard Atmosphere 1976 at sea level with the emittance of Idso (1981) in the vertical, opaque "
       "at "
       "4.17-4.45 um, plane-parallel as in Granqvist and Hjortsberg (1981)"},
      {"overcast", "a black cloud with its base at 1 km (Martin and Berdahl 1984), behind the same air below it"}};
  return skies;
}

std::optional<SkyProfile> built_in_sky(std::string_view name) {
  SkyProfile sky;
  sky.kind = SkyProfile::Kind::kLayers;
  sky.air_K = kAir_K;
  if (name == "clear-sky") {
    sky.emissivity = clear_emissivity();
  } else if (name == "overcast") {
    const double below = -std::expm1(-kCloudBase_km / kVapourHeight_km);  // share of the vapour
    sky.beyond_K = kAir_K - kLapse_K_km * kCloudBase_km;
    sky.emissivity = 1.0 - std::pow(1.0 - clear_emissivity(), below);
  } else {
    return std::nullopt;
  }
  return sky;
}

SkyProfile parse_sky_profile(std::string_view text, const std::string& name) {
  CsvReader reader(text, name);
  if (!reader.next()) reader.fail("no rows; columns zenith_deg and temperature_K or radiance are expected");
  const ProfileColumns columns = columns_of(reader);
  SkyProfile profile;
  profile.kind = columns.is_radiance ? SkyProfile::Kind::kRadiance : SkyProfile::Kind::kTemperature;
  RowReader rows(profile, columns);
  while (reader.next()) rows.add(reader);
  rows.finish(reader);
  return profile;
}

SkyProfile read_sky_profile(const std::string& path, const std::string& prefix) {
  return parse_sky_profile(read_named_file(path, prefix), path);
}

}  // namespace dolp
