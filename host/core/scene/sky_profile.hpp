// The radiance of the surroundings over the zenith, and over wavelength.
#pragma once

#include <cstdint>
#include <dolp/number_range.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// A sky: brightness temperatures or radiances at zeniths, straight lines between them, or layers of air in front of a
/// black background.
///
/// Equation: of layers L = t^(1 / cos(zenith)) B(beyond_K) + (1 - t^(1 / cos(zenith))) B(air_K), t = 1 - emissivity.
/// Source: Granqvist and Hjortsberg, J. Appl. Phys. 52, 4205 (1981): a plane-parallel atmosphere of one temperature.
/// The emissivities of clear air in the vertical, at 8-14 um and in the window at 10.5-12.5 um, are those of Idso,
/// Water Resources Research 17, 295 (1981); the rest of 8-14 um has what leaves the mean, other wavelengths have the
/// mean.
struct SkyProfile {
  enum class Kind { kTemperature, kRadiance, kLayers };
  Kind kind = Kind::kTemperature;
  std::vector<double> zenith_deg;     ///< ascending from 0 to 90
  std::vector<double> wavelength_um;  ///< ascending; empty where nothing depends on it
  std::vector<double> values;         ///< K or W m-2 sr-1 um-1: wavelength x zenith
  double air_K = 0.0;
  double beyond_K = 0.0;
  double emissivity = 0.0;                   ///< of the air in the vertical, where it is not opaque
  std::optional<double> window = {};         ///< the same at 10.5-12.5 um; none: as elsewhere
  std::optional<double> beside_window = {};  ///< the same in the rest of 8-14 um

  /// Two black bodies, of which the surroundings are a mixture; or a radiance.
  struct Emission {
    double share = 1.0;  ///< of the first
    double first_K = 0.0;
    double second_K = 0.0;
    double radiance = 0.0;  ///< W m-2 sr-1 um-1, in addition
  };
  Emission at(double wavelength_um, double zenith_deg) const;

  /// Zeniths that divide an interval of rows in which the temperature changes much.
  std::vector<double> temperature_divisions_deg(std::size_t interval) const;
  /// Zeniths between which the profile is smooth, from 0 to 90.
  std::vector<double> ends_deg() const;
  /// Wavelengths between which it is smooth.
  std::vector<double> breaks_um() const;
  /// The temperature of a profile that is the same everywhere.
  std::optional<double> only_temperature() const;
  /// As a file, which parse_sky_profile reads; empty for layers.
  std::string text() const;
  std::uint64_t hash() const;
};

/// The words for the built-in profiles, and their sources.
struct BuiltInSky {
  const char* name;
  const char* source;
};
const std::vector<BuiltInSky>& built_in_skies();

/// Air of a built-in sky. Without either value: the sky of the US Standard Atmosphere 1976, without the window.
struct SkyAir {
  std::optional<double> vapour_cm = {};  ///< precipitable water
  std::optional<double> temperature_K = {};
  bool is_standard() const { return !vapour_cm && !temperature_K; }
};

/// A built-in profile; none of that name: nullopt. Errors: InputError for more vapour than air of this temperature
/// holds; it begins with `prefix`.
std::optional<SkyProfile> built_in_sky(std::string_view name, const SkyAir& air = {}, const std::string& prefix = {});

/// Reads a CSV file: columns zenith_deg, temperature_K or radiance, and maybe wavelength_um; rows by wavelength, then
/// by zenith from 0 to 90. Errors: InputError with file, line, column, value and what is allowed.
SkyProfile parse_sky_profile(std::string_view text, const std::string& name);
SkyProfile read_sky_profile(const std::string& path, const std::string& prefix);

}  // namespace dolp
