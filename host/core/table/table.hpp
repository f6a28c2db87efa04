// A lookup table in memory: plain data, no physics.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <dolp/results.hpp>
#include "model/axes.hpp"

namespace dolp {

/// A global attribute of a table: text or a number.
struct Attribute {
  std::string name;
  std::variant<std::string, double> value;
  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// A quantity over wavelength; one row is a constant.
struct Curve {
  std::vector<double> wavelength_um;
  std::vector<double> values;
  friend bool operator==(const Curve&, const Curve&) = default;
};

/// The most entries that a table has.
inline constexpr std::size_t kMostTableEntries = std::size_t{1} << 36U;

/// All data of a table except its values.
struct TableHead {
  Axes axes;      ///< in the user's order; wavelength, n and k only where the table has them
  Curve index_n;  ///< n, k and E0 that the table was computed with; empty where there is none
  Curve index_k;
  Curve irradiance;                         ///< before source.scale
  std::string stokes_units = "W m-2 um-1";  ///< "W m-2" over a band
  std::vector<Attribute> attributes;  ///< in the order they are written; without Conventions, which is the writer's

  /// Number of values of each axis, 1 for an axis that the table lacks.
  PerAxis counts() const { return counts_of(axes); }
  std::size_t size() const { return size_of(counts()); }
  /// At the first wavelength, n and k.
  std::size_t position(std::size_t theta, std::size_t sigma_index, std::size_t q_index) const {
    return (theta * axes[Axis::kSigma].size() + sigma_index) * axes[Axis::kQ].size() + q_index;
  }
};

/// A lookup table in memory, or a part of one.
///
/// Shape: columns in C order of the axes.
struct TableValues : TableHead, ResultColumns {};

/// Layout of a table, known before its values.
struct TableLayout {
  TableHead head;
  Quantities quantities;
  bool has_status = true;
};

/// Shape: a column for each of `quantities`, and the status.
ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities);

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
