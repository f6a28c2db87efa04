#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <dolp/quantity.hpp>

namespace dolp {

/// Results of one entry of a grid, or of one point.
struct PointResult {
  QuantityArray<double> values;  ///< one value per quantity; NaN if the quantity has no value
  std::uint32_t status = 0;      ///< bits of the enumeration Status
  /// Estimated error of I, as a fraction of I, due to light that the model loses or creates. If it is above
  /// kLargestModelChange, the status has kModelInaccurate. Files do not contain this number.
  double model_change = 0.0;
  /// Estimated error of DOLP (from 0 to 1) due to the same light. The status has kModelInaccurate if it is above
  /// kLargestModelChange times DOLP and above kLeastModelChangeDolp. Estimates below 1e-4 may count as 0.
  double model_change_dolp = 0.0;

  PointResult() { values.fill(std::numeric_limits<double>::quiet_NaN()); }
  double& operator[](Quantity quantity) { return values[quantity]; }
  double operator[](Quantity quantity) const { return values[quantity]; }
};

/// Derivatives of dolp or of q_over_i by a key, per unit of the key, or the bound of their errors, for many entries.
/// The name is, for the key surface.n, d_dolp__surface_n, d_q_over_i__surface_n or derivative_error__surface_n. The
/// values are NaN where a step leaves the domain of the key.
struct DerivativeColumn {
  std::string name, long_name, units;
  std::vector<double> values = {};
};

/// Results of many entries: one column per quantity, and the status.
struct ResultColumns {
  QuantityArray<std::vector<double>> columns;  ///< one column per quantity; empty if the quantity was not computed
  std::vector<std::uint32_t> status;           ///< empty if the status was not computed
  std::vector<DerivativeColumn> derivatives;   ///< empty if no derivatives were computed

  std::vector<double>& operator[](Quantity quantity) { return columns[quantity]; }
  const std::vector<double>& operator[](Quantity quantity) const { return columns[quantity]; }
  bool has(Quantity quantity) const { return !columns[quantity].empty(); }

  Quantities quantities() const {
    Quantities own;
    for (const Quantity quantity : kAllQuantities) {
      if (has(quantity)) own.push_back(quantity);
    }
    return own;
  }
  PointResult at(std::size_t position) const {
    PointResult result;
    for (const Quantity quantity : kAllQuantities) {
      if (has(quantity)) result[quantity] = columns[quantity][position];
    }
    if (!status.empty()) result.status = status[position];
    return result;
  }
};

}  // namespace dolp
