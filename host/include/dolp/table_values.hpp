// The contents of a lookup table: plain data.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <dolp/axis.hpp>
#include <dolp/response.hpp>
#include <dolp/results.hpp>

namespace dolp {

/// A global attribute of a table: text or a number.
struct Attribute {
  std::string name;
  std::variant<std::string, double> value;
  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// Longer texts are stored as variables of characters, because the netCDF library limits attributes to less than 64
/// KiB.
inline constexpr std::size_t kMostAttributeBytes = 64'000;

/// A quantity over wavelength in the scene; a constant has one row.
struct Curve {
  std::vector<double> wavelength_um;
  std::vector<double> values;
  std::vector<double> used;  ///< at each value of the wavelength axis; one value without the axis; empty over a band
  friend bool operator==(const Curve&, const Curve&) = default;
};

/// All data of a table except its values.
struct TableHead {
  Axes axes;                     ///< in the user's order; required axes, and other axes that the table has
  AxisLabels labels;             ///< all labels of the scene's axes, also in a part of a table
  std::vector<double> wind_m_s;  ///< wind speeds that give the values of sigma; empty if the scene gives sigma
  std::vector<double> beta_deg;  ///< local angles of incidence of a response table, ascending
  Curve index_n;                 ///< n, k and E0 of the computation; empty if there is none
  Curve index_k;
  Curve irradiance;                         ///< before multiplication by source.scale
  std::string stokes_units = "W m-2 um-1";  ///< UDUNITS; "W m-2" over a band
  /// in the order of the file, without the additional ones of Table::file_attributes
  std::vector<Attribute> attributes;

  /// Number of values of each axis, 1 for an axis that the table lacks.
  PerAxis counts() const {
    PerAxis counts{};
    for (const Axis axis : kAllAxes) counts[axis] = axes[axis].empty() ? 1 : axes[axis].size();
    return counts;
  }
  std::size_t size() const {
    std::size_t size = 1;
    for (const std::size_t count : counts()) size *= count;
    return size;
  }
  /// The label of a value of an axis that has labels.
  const std::string& label(Axis axis, double value) const { return labels[axis].at(static_cast<std::size_t>(value)); }
  /// Number of values per entry of a response variable.
  std::size_t width_of(ResponseVariable variable) const {
    return description_of(variable).has_beta ? beta_deg.size() : 1;
  }
  /// Position of an entry at the first wavelength, n and k.
  std::size_t position(std::size_t theta, std::size_t sigma_index, std::size_t q_index) const {
    return (theta * axes[Axis::kSigma].size() + sigma_index) * axes[Axis::kQ].size() + q_index;
  }
};

/// A lookup table in memory, or a part of one.
///
/// Shape: columns in C order of the axes.
struct TableValues : TableHead, ResultColumns {
  /// Only in response tables: width_of values per entry.
  ResponseArray<std::vector<double>> responses;
};

/// One curve of a table.
struct TableCurve {
  const char* name;
  const char* long_name;
  const char* units;
  Curve TableHead::*curve;
};
inline constexpr std::array<TableCurve, 3> kTableCurves = {{
    {"index_n", "refractive index n of the surface", "1", &TableHead::index_n},
    {"index_k", "refractive index k of the surface", "1", &TableHead::index_k},
    {"irradiance", "irradiance E0 of the source at normal incidence, before source.scale", "W m-2 um-1",
     &TableHead::irradiance},
}};

}  // namespace dolp
