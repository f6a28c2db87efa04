// The error of interpolation between the entries of a table, for users who interpolate in their own programs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <dolp/axis.hpp>
#include <dolp/quantity.hpp>
#include "plan/effects.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"
#include "verify/table_check.hpp"

namespace dolp {

/// Absolute errors of interpolated values at some points.
struct ErrorSummary {
  std::size_t compared = 0;  ///< number of points at which the interpolated and the computed value are finite
  double median = 0.0;
  double p95 = 0.0;  ///< 95 % of the errors are at most this
  double largest = 0.0;
  std::size_t where = 0;  ///< number of the point with the largest error
};

/// Summary of the errors in `errors`, which may contain NaN for points without an error.
ErrorSummary summary(const std::vector<double>& errors);

struct InterpolationError {
  Quantity quantity = Quantity::kDolp;
  const char* method = "";  ///< "linear" or "cubic"
  ErrorSummary error;
  std::vector<AxisValue> at;  ///< the point with the largest error
};

/// Random points inside the cells of a table. A cell lies between neighbouring values of each axis of numbers. Labels,
/// and values of axes with one value, are taken as they are.
class PointsBetween {
 public:
  PointsBetween(const TableHead& table, std::size_t count, std::uint64_t seed);

  const Points& points() const { return points_; }
  /// Positions in the table, ascending, of all entries that the interpolations read.
  std::vector<std::size_t> positions() const;
  /// Interpolates in a table that has only the entries at positions(), and compares with `computed` values at points().
  /// Linear: along each axis between the two nearest values. Cubic: a polynomial through the four nearest values along
  /// each axis (fewer on a shorter axis). The coordinate is logarithmic on an axis with logarithmic spacing.
  std::vector<InterpolationError> errors(const TableValues& entries, std::span<const PointResult> computed,
                                         const Quantities& quantities) const;

 private:
  struct Weight {
    std::size_t position = 0;  ///< position of the entry in the table
    double value = 0.0;
  };
  struct Method {
    const char* name;
    std::size_t values;                        ///< values of an axis that the interpolation uses
    std::vector<std::vector<Weight>> weights;  ///< for each point
  };

  AxisLabels labels_;
  Points points_;
  std::array<Method, 2> methods_ = {{{"linear", 2, {}}, {"cubic", 4, {}}}};
};

/// The expected error of linear interpolation of DOLP along an axis of a grid.
struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;         ///< number of values of the axis in the grid
  ErrorSummary error;             ///< at midpoints between neighbouring values; compared = 0: not examined
  std::size_t needed_values = 0;  ///< number of values for which the largest error is about the tolerance; 0: unknown
};

struct InterpolationForecast {
  std::vector<AxisForecast> axes;
  double evaluations = 0.0;  ///< integrand evaluations that the forecast took
};

/// A forecast for each axis of the grid that has several numbers as values. The CPU computes DOLP at both ends and in
/// the middle of a few random cells of the axis, once with the grid's values and once with the expected needed number.
/// It misses features between these cells. It takes about `evaluations` integrand evaluations at most;
/// `per_entry` is the expected number for an entry.
InterpolationForecast forecast_interpolation(const SceneValues& scene, const EffectPlan& plan, double evaluations,
                                             double per_entry);

}  // namespace dolp
