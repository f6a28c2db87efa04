// The axes of lookup tables. Only this file names and orders them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dolp/enum_array.hpp>
#include <dolp/number_range.hpp>

namespace dolp {

/// The axes, in the order in which tables have them. The last axis varies fastest.
enum class Axis : std::uint8_t {
  kMaterial,
  kBand,
  kWavelength,
  kTemperature,
  kN,
  kK,
  kViewZenith,
  kRelativeAzimuth,
  kTheta,
  kSigma,
  kQ,
  kSigmaCross,
  kSurfaceAzimuth
};
inline constexpr std::size_t kAxisCount = static_cast<std::size_t>(Axis::kSurfaceAzimuth) + 1;

template <class Value>
using AxisArray = EnumArray<Axis, Value, kAxisCount>;

inline constexpr std::array<Axis, kAxisCount> kAllAxes = enumerators<Axis, kAxisCount>();

struct AxisDescription {
  const char* name;    ///< name of the coordinate in table files and in xarray Datasets
  const char* column;  ///< name in CSV files of points, in .csv and .npy tables, in [grid] and in Python calls
  const char* key;     ///< scene key of one value for all entries; "" if there is none
  const char* units;
  const char* long_name;
  NumberRange range;
  bool is_required;         ///< true: every table has the axis; false: a table without it has one value for all entries
  bool has_labels = false;  ///< the values are positions (from 0) in a list of labels: names of materials or bands
};

inline constexpr std::array<AxisDescription, kAxisCount> kAxes = {{
    {"material", "material", "", "1", "material of the surface", kLabelRange, false, true},
    {"band", "band_um", "", "um", "band of wavelengths", kLabelRange, false, true},
    {"wavelength", "wavelength_um", "spectrum.wavelength_um", "um", "wavelength", kWavelengthUmRange, false},
    {"temperature", "temperature_K", "emission.temperature_K", "K", "temperature of the surface",
     kEmissionTemperatureRange, false},
    {"n", "n", "surface.n", "1", "refractive index n of the surface", kNRange, false},
    {"k", "k", "surface.k", "1", "refractive index k of the surface", kKRange, false},
    {"view_zenith_deg", "view_zenith_deg", "geometry.view_zenith_deg", "degree", "zenith angle of the view",
     kZenithDegRange, false},
    {"relative_azimuth_deg", "relative_azimuth_deg", "geometry.relative_azimuth_deg", "degree",
     "azimuth between source and view", kAzimuthDegRange, false},
    {"theta", "theta_deg", "", "degree", "zenith angle", kZenithDegRange, true},
    {"sigma", "sigma", "surface.sigma", "1", "roughness sigma of the slope distribution", kSigmaRange, true},
    {"q", "q", "surface.q", "1", "exponent q of the slope distribution", kQRange, true},
    {"sigma_cross", "sigma_cross", "surface.sigma_cross", "1", "roughness sigma across the surface's x axis",
     kSigmaCrossRange, false},
    {"surface_azimuth_deg", "surface_azimuth_deg", "geometry.surface_azimuth_deg", "degree",
     "azimuth of the surface's x axis from the view", kAzimuthDegRange, false},
}};

static_assert(kAxes.back().name != nullptr, "each axis has a row");

constexpr const AxisDescription& describe(Axis axis) { return kAxes[static_cast<std::size_t>(axis)]; }

/// Description of the wind speed, which determines sigma. It is not an axis: wind speeds replace values of sigma in
/// [grid] or in points. A table computed from wind speeds has them as a second coordinate along its axis sigma.
inline constexpr AxisDescription kWind = {
    "wind_m_s", "wind_m_s", "surface.wind_m_s", "m s-1", "wind speed that gives sigma (Cox and Munk 1954)",
    kWindRange, false};

/// Variables of a file along the axes with labels. The axes themselves have no variable, because coordinates of netCDF
/// are numbers. The label of a band is "LOW-HIGH".
inline constexpr AxisDescription kMaterialName = {"material_name",           "material",  "",    "1",
                                                  "material of the surface", kLabelRange, false, true};
inline constexpr AxisDescription kBandLow = {"band_low",         "band_um", "", "um", "lower limit of the band",
                                             kWavelengthUmRange, false};
inline constexpr AxisDescription kBandHigh = {"band_high",        "band_um", "", "um", "upper limit of the band",
                                              kWavelengthUmRange, false};

/// The order in which error messages list the columns of points.
inline constexpr std::array<Axis, kAxisCount> kColumnOrder = {Axis::kTheta,
                                                              Axis::kSigma,
                                                              Axis::kQ,
                                                              Axis::kN,
                                                              Axis::kK,
                                                              Axis::kWavelength,
                                                              Axis::kMaterial,
                                                              Axis::kTemperature,
                                                              Axis::kBand,
                                                              Axis::kViewZenith,
                                                              Axis::kRelativeAzimuth,
                                                              Axis::kSigmaCross,
                                                              Axis::kSurfaceAzimuth};

/// The values of each axis, in ascending or descending order, without repetition. A grid has at least one value of each
/// required axis.
using Axes = AxisArray<std::vector<double>>;
/// The names on the axis material, and the bands on the axis band, such as "8-14". Empty for all other axes.
using AxisLabels = AxisArray<std::vector<std::string>>;
/// One integer per axis, such as a position along the axis or its number of values.
using PerAxis = AxisArray<std::size_t>;

}  // namespace dolp
