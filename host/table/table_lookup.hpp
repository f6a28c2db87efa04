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
/// ln(q - 1), and of degree three through four values in the logarithm of wavelength, n and k, the axes that a table
/// may lack; fewer where an axis has fewer. DOLP follows from the interpolated Stokes parameters, which stay smooth
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

  /// Nothing of an axis that the table lacks.
  const LookupAxis* axis(Axis axis) const;
  /// Those that the table has.
  ExtraColumns extra_columns() const {
    return {.emissivity = !table_.emissivity_s.empty(), .bracket = !table_.dolp_low.empty()};
  }

  /// A value on each axis; of those that the table lacks nothing is looked at.
  using Point = std::array<double, kGridAxes.size()>;
  /// What the table says at a point within its axes, at an entry just that; quantities that it does not have are NaN.
  /// Domain: next to entries outside the model's domain the window moves away from them; between such entries the
  /// result is NaN with status 4.
  PointResult at(const Point& point) const;
  PointResult at(double theta_deg, double sigma, double q) const { return at({0.0, 0.0, 0.0, theta_deg, sigma, q}); }

 private:
  struct Window;
  struct Spread;
  struct Gather;
  struct Blocks;
  struct Column {
    const std::vector<double>* values = nullptr;
    double PointResult::*member = nullptr;
  };

  std::size_t position(std::size_t block, std::size_t theta, std::size_t sigma, std::size_t q) const {
    return block + (theta_.position(theta) * sigma_.size() + sigma_.position(sigma)) * q_.size() + q_.position(q);
  }
  /// The same in a block of the table: one wavelength, n and k, whose entries begin at a position.
  PointResult in_block(std::size_t block, double theta_deg, double sigma, double q) const;
  bool is_known(const Window& window) const;
  PointResult entry(const Window& window) const;
  void read(const Column& column, const Window& window, const std::array<Spread, 3>& spreads, const Gather& gather,
            PointResult& result, PointResult& change) const;
  void finish(PointResult& result, const PointResult& change, double error, double rho_error) const;
  void add_status(PointResult& result) const;

  const Table& table_;
  double tolerance_;
  std::vector<LookupAxis> block_axes_;  ///< of wavelength, n and k, one value of those that the table lacks
  LookupAxis theta_;
  LookupAxis sigma_;
  LookupAxis q_;
  std::vector<Column> columns_;  ///< what is interpolated: what is smooth, and not 0 everywhere
  bool all_known_ = true;        ///< every entry is finite
};

}  // namespace dolp
