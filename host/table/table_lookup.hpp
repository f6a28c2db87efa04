// Interpolation in a lookup table, with its error.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/point_result.hpp"
#include "table/axis_stencil.hpp"
#include "table/result_csv.hpp"
#include "table/table.hpp"

namespace dolp {

/// Reads a table between its entries.
///
/// Method: tensor product of polynomials of degree five through the six values around the point, in theta, ln sigma and
/// ln(q - 1); fewer where an axis has fewer. DOLP follows from the interpolated Stokes parameters, which stay smooth
/// where it has a kink.
/// Errors stated: the bounds of the entries read, each with the size of its weight, and along each axis ten times the
/// change that leaving out a value makes, summed as if more values went on changing the result as the last ones do.
/// That part is an estimate: what is narrower than the grid stays unseen. Between the values of an axis that has fewer
/// than four it is infinite.
class TableLookup {
 public:
  /// `table` must outlive the object; `tolerance` is its own, for status 2. Errors: InputError, which begins with
  /// `name`, for an axis that has a value twice, and for a table without dolp, its error, Stokes parameters or status,
  /// or with an error of rho but no rho.
  TableLookup(const Table& table, double tolerance, const std::string& name);

  const LookupAxis& theta_deg() const { return theta_; }
  const LookupAxis& sigma() const { return sigma_; }
  const LookupAxis& q() const { return q_; }
  /// Those that the table has.
  ExtraColumns extra_columns() const {
    return {.emissivity = !table_.emissivity_s.empty(), .bracket = !table_.dolp_low.empty()};
  }

  /// What the table says at a point within its axes, at an entry just that; quantities that it does not have are NaN.
  /// Domain: next to entries outside the model's domain the window moves away from them; between such entries the
  /// result is NaN with status 4.
  PointResult at(double theta_deg, double sigma, double q) const;

 private:
  struct Window;
  struct Spread;
  struct Gather;
  struct Column {
    const std::vector<double>* values = nullptr;
    double PointResult::*member = nullptr;
  };

  bool is_known(const Window& window) const;
  PointResult entry(const Window& window) const;
  void read(const Column& column, const Window& window, const std::array<Spread, 3>& spreads, const Gather& gather,
            PointResult& result, PointResult& change) const;
  void add_status(const Window& cell, PointResult& result) const;

  const Table& table_;
  double tolerance_;
  LookupAxis theta_;
  LookupAxis sigma_;
  LookupAxis q_;
  std::vector<Column> columns_;  ///< what is interpolated: what is smooth, and not 0 everywhere
  bool all_known_ = true;        ///< every entry is finite
};

}  // namespace dolp
