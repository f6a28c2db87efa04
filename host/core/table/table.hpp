// A lookup table in memory: plain data, no physics.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "model/point_result.hpp"
#include "model/scene_entry.hpp"

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

/// Whatever a table has but its values: axes in the user's order, those of wavelength, n and k only where the table has
/// them.
struct TableHead {
  std::vector<double> wavelength_um;
  std::vector<double> n;
  std::vector<double> k;
  std::vector<double> theta_deg;
  std::vector<double> sigma;
  std::vector<double> q;
  Curve index_n;  ///< n, k and E0 that the table was computed with; empty where there is none
  Curve index_k;
  Curve irradiance;                         ///< before source.scale
  std::string stokes_units = "W m-2 um-1";  ///< "W m-2" over a band
  std::vector<Attribute> attributes;  ///< in the order they are written; without Conventions, which is the writer's

  /// Values of each axis, of one that it lacks 1.
  PerAxis counts() const;
  std::size_t size() const { return size_of(counts()); }
  /// At the first wavelength, n and k.
  std::size_t position(std::size_t theta, std::size_t sigma_index, std::size_t q_index) const {
    return (theta * sigma.size() + sigma_index) * q.size() + q_index;
  }
};

/// The axes of a table in its order, the last one fastest.
inline constexpr std::array<std::vector<double> TableHead::*, kGridAxes.size()> kTableAxes = {
    &TableHead::wavelength_um, &TableHead::n, &TableHead::k, &TableHead::theta_deg, &TableHead::sigma, &TableHead::q};

/// A lookup table in memory, or a part of one.
///
/// Shape: variables in C order of the axes. A variable that was not computed is empty.
struct Table : TableHead {
  std::vector<double> dolp;
  std::vector<double> stokes_i;
  std::vector<double> stokes_q;
  std::vector<double> stokes_u;
  std::vector<double> stokes_v;
  std::vector<double> rho_i;
  std::vector<double> rho_q;
  std::vector<double> albedo;
  std::vector<double> emissivity_s;
  std::vector<double> emissivity_p;
  std::vector<double> dolp_low;
  std::vector<double> dolp_high;
  std::vector<double> error_estimate;
  std::vector<double> rho_error_estimate;
  std::vector<std::uint32_t> status;
};

/// One real-valued variable of a table, in the order in which files list them; status comes after the last.
struct TableVariable {
  const char* name;
  const char* long_name;
  bool has_stokes_units;  ///< otherwise the unit is 1
  const char* ancillary;  ///< names of the variables that qualify this one, or ""
  std::vector<double> Table::*values;
  double PointResult::*member;
};
std::span<const TableVariable> table_variables();

/// Some of them, in their order.
using TableVariables = std::vector<const TableVariable*>;
/// Those that a table has.
TableVariables present_variables(const Table& table);

/// What a table has before any value is there.
struct TableLayout {
  TableHead head;
  TableVariables variables;
  bool has_status = true;
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
