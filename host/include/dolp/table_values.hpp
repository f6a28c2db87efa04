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

struct Attribute {
  std::string name;
  std::variant<std::string, double> value;
  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// n, k or the irradiance E0 of a scene as a function of the wavelength. A constant has one wavelength and one value.
struct Curve {
  std::vector<double> wavelength_um;
  std::vector<double> values;
  /// n, k or E0 at the wavelengths of the table, or one value if the table has no axis of wavelengths. Empty if n, k or
  /// E0 varies over the band of the table.
  std::vector<double> used;
  friend bool operator==(const Curve&, const Curve&) = default;
};

/// Everything in a table except its results.
struct TableHead {
  Axes axes;                     ///< ascending or descending values; empty for an axis that the table lacks
  AxisLabels labels;             ///< names of all materials and bands of the scene, even in a part of a table
  std::vector<double> wind_m_s;  ///< wind speeds from which sigma follows; empty if the scene gives sigma
  std::vector<double> beta_deg;  ///< local angles of incidence of a response table, ascending
  Curve index_n;                 ///< refractive index n if all entries share this curve; else empty
  Curve index_k;
  Curve irradiance;                         ///< irradiance E0 of the source before multiplication by source.scale
  std::string stokes_units = "W m-2 um-1";  ///< in UDUNITS syntax; "W m-2" over a band, with " sr-1" if bistatic
  /// Attributes in the order of the file. A file has a few more, which Table::file_attributes() adds to these.
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
  const std::string& label(Axis axis, double value) const { return labels[axis].at(static_cast<std::size_t>(value)); }
  std::size_t values_per_entry(ResponseVariable variable) const {
    return describe(variable).has_beta ? beta_deg.size() : 1;
  }
  /// Position, in each column, of the entry with these indices on theta, sigma and q, and index 0 on all other axes.
  std::size_t position(std::size_t theta, std::size_t sigma_index, std::size_t q_index) const {
    return (theta * axes[Axis::kSigma].size() + sigma_index) * axes[Axis::kQ].size() + q_index;
  }
};

/// A lookup table in memory, or a part of one. Shape: each column is an array over all axes, flattened in C order (the
/// last axis varies fastest).
struct TableValues : TableHead, ResultColumns {
  /// Variables of a response table; empty in other tables. Each entry has values_per_entry() consecutive values of a
  /// variable.
  ResponseArray<std::vector<double>> responses;
};

/// How files name and describe a curve, and the member of TableHead that contains the curve.
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
