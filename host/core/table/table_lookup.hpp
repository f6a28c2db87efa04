// Interpolation in a lookup table, with its error.
#pragma once

#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"
#include "table/axis_stencil.hpp"
#include "table/table.hpp"

namespace dolp {

/// Zenith angles of the source, in degrees, at which the masking of a bistatic beam has a kink, for all sigma and q.
///
/// Method: `integral` and V-cavities take the lower of the two directions, which changes where the source stands as
/// high as the view; V-cavities have another kink where G reaches 1 (shaders/physics/README.md, section 2).
/// Domain: kinks of further bounces and of total reflection are not among them.
std::vector<double> masking_kinks(const SceneModel& scene);

/// Reads a table between its entries.
///
/// Method: tensor product of polynomials of degree five through the six values around the point, in theta, ln sigma and
/// ln(q - 1), and of degree three through four values in the logarithm of wavelength, temperature, n and k, the axes
/// that a table may lack; on axes with labels a point is at one of them; fewer where an axis has fewer. DOLP follows
/// from the interpolated Stokes parameters, which stay smooth where it has a kink. Errors stated: the bounds of the
/// entries read, each with the size of its weight, and the error of the interpolation along each axis: kInside or
/// kAtEnds times the change that one value more makes on the lines through the corners of the point's cell, or that the
/// last one makes where all values are read; along theta also the error that each kink of the masking causes in the
/// window. That part is an estimate: structure narrower than the grid is missed. Between the values of an axis that has
/// fewer than four it is infinite. Accuracy: tests LookupEstimates.
class TableLookup {
 public:
  /// `table` must outlive the object; `scene` is its own. Errors: InputError, which begins with `name`, for an axis
  /// that has a value twice, and for a table without dolp, its error, Stokes parameters or status, or with an error of
  /// rho but no rho.
  TableLookup(const TableValues& table, const SceneModel& scene, const std::string& name);

  const AxisLabels& labels() const { return table_.labels; }
  /// Null for an axis that the table lacks.
  const LookupAxis* axis(Axis axis) const;
  /// The quantities of every scene, and the optional ones that the table has.
  Quantities quantities() const;

  /// A value on each axis; values on axes that the table lacks are ignored.
  using Point = AxisArray<double>;
  /// The interpolated result at a point within the axes; at an entry, the entry itself. Quantities that the table lacks
  /// are NaN.
  /// Domain: next to entries outside the model's domain the window moves away from them; between such entries the
  /// result is NaN with status 4.
  PointResult at(const Point& point) const;
  PointResult at(double theta_deg, double sigma, double q) const {
    Point point{};
    point[Axis::kTheta] = theta_deg;
    point[Axis::kSigma] = sigma;
    point[Axis::kQ] = q;
    return at(point);
  }

 private:
  struct Window;
  struct Rows;
  struct Lines;

  std::size_t position(std::size_t axis, std::size_t rank) const { return axes_[axis].position(rank) * strides_[axis]; }
  bool is_known(const Window& window) const;
  /// Moves a window away from entries that are not known; false where that is not possible.
  bool make_known(Window& window, double theta_deg) const;
  std::uint32_t cell_status(const Window& window) const;
  void finish(PointResult& result, const PointResult& change, double error, double rho_error) const;
  void add_status(PointResult& result) const;

  const TableValues& table_;
  double tolerance_;               ///< for status 2
  std::vector<double> kinks_deg_;  ///< zeniths of kinks along theta
  std::vector<LookupAxis> axes_;   ///< in the table's order; an absent axis has one value
  PerAxis strides_ = {};           ///< distance between the entries of an axis
  Quantities interpolated_;        ///< smooth quantities that are not 0 everywhere
  std::vector<char> is_known_;     ///< for each theta, ascending: all its entries are finite
};

}  // namespace dolp
