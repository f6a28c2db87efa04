#pragma once

#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"
#include "table/axis_stencil.hpp"
#include "table/table.hpp"

namespace dolp {

/// Zeniths of the source, in degrees, at which the masking has a kink in bistatic mode. They do not depend on sigma and
/// q. Kinks that come from total reflection, or from light that is reflected several times, are not included.
std::vector<double> masking_kinks(const SceneModel& scene);

/// Interpolates the results of a table at points between its entries.
/// Method: a product of polynomials, one for each axis. The degree is five in theta, ln sigma and ln(q - 1), three in
/// the logarithms of wavelength, temperature, n and k, and less on axes with few values. On an axis with labels
/// (materials, bands) a point must be at a value. DOLP follows from the interpolated Stokes parameters.
/// Stated errors: the errors of the read entries, plus an interpolation error for each axis. The estimate of this error
/// comes from the change of the result if one more value of the axis is used, so it misses structure narrower than the
/// grid. Between the values of an axis with fewer than four values the estimate is infinite.
class TableLookup {
 public:
  /// `table` must outlive the object. Errors: InputError that begins with `name` if an axis contains a value twice;
  /// if dolp, its error, a Stokes parameter or the status is missing; or if the table has the error of rho but not rho.
  TableLookup(const TableValues& table, const SceneModel& scene, const std::string& name);

  const AxisLabels& labels() const { return table_.labels; }
  /// Null if the table lacks the axis.
  const LookupAxis* axis(Axis axis) const;
  /// The quantities of a result: those that every result has, and the optional quantities that the table has.
  Quantities quantities() const;

  /// A value on each axis; values on axes that the table lacks are ignored.
  using Point = AxisArray<double>;
  /// The result at a point inside the axes. Quantities that the table lacks are NaN. The interpolation reads only
  /// entries inside the model's domain. If these are too few, the result is NaN with status 4 (outside the domain).
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
  /// Moves the window of read values away from unknown (NaN) entries or shortens it. Returns false if neither helps.
  bool make_known(Window& window, double theta_deg) const;
  std::uint32_t cell_status(const Window& window) const;
  void finish(PointResult& result, const PointResult& change, double error, double rho_error) const;
  void add_status(PointResult& result) const;

  const TableValues& table_;
  double tolerance_;               ///< tolerance of DOLP and rho; a larger stated error sets a status bit
  std::vector<double> kinks_deg_;  ///< zeniths of the source at which the masking has a kink
  std::vector<LookupAxis> axes_;   ///< axes in the table's order; an absent axis has one value
  PerAxis strides_ = {};           ///< step in the table from one value of an axis to the next
  Quantities interpolated_;        ///< the smooth quantities that are not 0 in the whole table
  std::vector<char> is_known_;     ///< for each theta, ascending: true if I is finite in all entries with this theta
};

}  // namespace dolp
