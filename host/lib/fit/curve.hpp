#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fit/search.hpp"

namespace dolp::fit {

/// The objective of a fit with one parameter, over the whole range of the parameter. The curve consists of computed
/// points. Between two neighbours, the residuals are interpolated linearly. Both functions add points until the
/// interpolated objective is accurate enough for their results. Errors: errors of the evaluator; Cancelled.
class Curve {
 public:
  /// Computes points at equal distances, and at the parameter's start (if given). `coarse` has a wider tolerance. Only
  /// points near the ends of intervals need `fine`. Both must outlive the object.
  Curve(Residuals& coarse, Residuals& fine, const FitOptions& options);

  /// The points that are lower than their neighbours and at most kFarAbove * scale above the lowest. Each minimum has
  /// such a point, unless the objective rises by less than the scale on the way to a lower minimum.
  std::vector<Eigen::VectorXd> low_points();
  /// The intervals, as in compute_profiles(). With one parameter, the profile likelihood is the curve itself.
  Profiles profiles(const std::vector<Minimum>& minima, const ProfileOptions& options);

 private:
  double at(std::size_t i) const { return points_[i].at[0]; }
  double between(std::size_t i, double share) const;
  double lowest_share(std::size_t i) const;
  double error(std::size_t i) const;
  double bend(std::size_t i) const;
  double numerical_error(std::size_t i) const;
  void add(Residuals& residuals, const std::vector<Eigen::VectorXd>& places);
  void refine(Residuals& residuals, const std::function<bool(std::size_t)>& is_inaccurate);
  std::vector<CoordinateInterval> pieces_below(double level) const;

  Residuals& coarse_;
  Residuals& fine_;
  std::vector<Linearisation> points_;  ///< in ascending order of the coordinate. Piece i goes from point i to i + 1.
};

}  // namespace dolp::fit
