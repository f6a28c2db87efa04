#pragma once

#include <cstdint>
#include <dolp/number_range.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// A sky of the kind kTemperature or kRadiance is a table, interpolated linearly. A sky of the kind kLayers is air in
/// front of dark space or a black cloud. The air transmits the share p = (1 - emissivity)^(1 / cos(zenith)) of the
/// radiance behind it. Equation: radiance = (1 - p) B(air_K) + p B(beyond_K), where B is Planck's function.
/// Source for plane-parallel air of one temperature: Granqvist and Hjortsberg, J. Appl. Phys. 52, 4205 (1981). Source
/// for the vertical emissivity of clear air: Idso, Water Resources Research 17, 295 (1981). Idso gives a mean for
/// 8-14 um, also used outside 8-14 um, and a value for 10.5-12.5 um. `beside_window` follows from both numbers.
struct SkyProfile {
  enum class Kind { kTemperature, kRadiance, kLayers };
  Kind kind = Kind::kTemperature;
  std::vector<double> zenith_deg;     ///< ascending from 0 to 90
  std::vector<double> wavelength_um;  ///< ascending; empty if the values are the same at every wavelength
  std::vector<double> values;  ///< temperatures in K or radiances in W m-2 sr-1 um-1. Shape: wavelengths x zeniths
  double air_K = 0.0;
  double beyond_K = 0.0;
  double emissivity = 0.0;  ///< vertical emissivity of the air outside 8-14 um, except where carbon dioxide is opaque
  double window = 0.0;      ///< vertical emissivity at 10.5-12.5 um
  double beside_window = 0.0;  ///< vertical emissivity in the rest of 8-14 um

  /// The radiance of the sky is share * B(first_K) + (1 - share) * B(second_K) + radiance. B is Planck's function.
  struct Emission {
    double share = 1.0;
    double first_K = 0.0;
    double second_K = 0.0;
    double radiance = 0.0;  ///< W m-2 sr-1 um-1
  };
  Emission at(double wavelength_um, double zenith_deg) const;

  /// For kLayers: the vertical emissivity of the air at a wavelength, and the share that the air emits at a zenith.
  double vertical_emissivity(double wavelength_um) const;
  static double emitted_share(double vertical_emissivity, double zenith_deg);

  /// Zeniths that cut the interval between zenith_deg[interval] and the next zenith into parts of similar temperature.
  std::vector<double> temperature_divisions_deg(std::size_t interval) const;
  /// Zeniths from 0 to 90 between which the profile is a smooth function of zenith.
  std::vector<double> ends_deg() const;
  /// Wavelengths between which the profile is a smooth function of wavelength.
  std::vector<double> breaks_um() const;
  /// The temperature, if it is the same at every zenith and wavelength; else nullopt.
  std::optional<double> only_temperature() const;
  /// The profile as a CSV file that parse_sky_profile reads; empty for kLayers.
  std::string text() const;
};

struct BuiltInSky {
  const char* name;
  const char* source;
};
const std::vector<BuiltInSky>& built_in_skies();

/// The wavelengths at which the emissivity of a built-in sky was measured. Elsewhere it has the same mean.
inline constexpr double kSkyBandFrom_um = 8.0;
inline constexpr double kSkyBandTo_um = 14.0;

/// Air of a built-in sky. Absent values are those of the US Standard Atmosphere 1976.
struct SkyAir {
  std::optional<double> vapour_cm = {};  ///< precipitable water in cm
  std::optional<double> temperature_K = {};
};

/// The built-in sky `name`, or nullopt. Errors: InputError that begins with `prefix` if the air cannot hold the vapour.
std::optional<SkyProfile> built_in_sky(std::string_view name, const SkyAir& air = {}, const std::string& prefix = {});

/// Reads a CSV with zenith_deg (from 0 to 90) and temperature_K or radiance. A CSV that also has wavelength_um needs
/// the same zeniths at each wavelength. Errors: InputError with file, line and column.
SkyProfile parse_sky_profile(std::string_view text, const std::string& name);

}  // namespace dolp
