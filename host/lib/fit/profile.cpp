#include "fit/profile.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace dolp::fit {
namespace {

constexpr double kRootTolerance = 5e-3;  // of sqrt(rise)
constexpr double kLeastGain = 1e-3;      // of the scale
constexpr double kLower = 0.01;          // of the scale: below the minimum by more is another minimum
constexpr int kMostPoints = 25;          // of a side and rise
constexpr double kMostGrowth = 3.0;      // of the distance from the minimum, from one point to the next

/// A point of the profile.
struct Point {
  double distance = 0.0;  ///< from the minimum, in coordinates of the parameter
  double root = 0.0;      ///< of how much the objective has grown
  Linearisation where;
};

class Side {
 public:
  Side(Residuals& residuals, const Minimum& minimum, std::size_t parameter, int direction, double scale, Loss loss)
      : residuals_(residuals),
        minimum_(minimum),
        parameter_(static_cast<Eigen::Index>(parameter)),
        direction_(direction),
        most_(direction > 0 ? 1.0 - minimum.where.at[parameter_] : minimum.where.at[parameter_]) {
    points_.push_back({0.0, 0.0, minimum.where});
    options_.loss = loss;
    options_.scale = scale;
    options_.held = {parameter};
    options_.least_gain = kLeastGain;
  }

  /// The distance at which the root of the growth is `root`.
  IntervalEnd find(double root, double guess) {
    double distance = guess;
    for (int i = 0; i < kMostPoints; ++i) {
      const auto above = std::ranges::find_if(points_, [&](const Point& point) { return point.root >= root; });
      if (above == points_.end() && points_.back().distance >= most_) return std::nullopt;
      if (i > 0 || points_.size() > 1) distance = next(above, root);
      const Point& point = add(std::min(distance, most_));
      if (lower_) return std::nullopt;
      if (std::abs(point.root - root) <= kRootTolerance * root) return point.distance;
    }
    return distance;
  }

  std::optional<Minimum> take_lower() { return std::move(lower_); }

 private:
  using Place = std::vector<Point>::const_iterator;

  /// The intersection of `root` with a straight line through the two points beside it; beyond the last point, through
  /// the last two.
  double next(Place above, double root) const {
    if (above != points_.end()) {
      const Point& below = *(above - 1);
      const double share = std::clamp((root - below.root) / (above->root - below.root), 0.02, 0.98);
      return below.distance + share * (above->distance - below.distance);
    }
    const Point& last = points_.back();
    if (last.root <= 0.0) return kMostGrowth * last.distance;
    return last.distance * std::min(kMostGrowth, std::max(1.01, root / last.root));
  }

  /// Computes the profile at a distance; the points stay sorted.
  const Point& add(double distance) {
    const auto after = std::ranges::find_if(points_, [&](const Point& point) { return point.distance > distance; });
    const bool is_nearer_after =
        after != points_.end() && after->distance - distance < distance - (after - 1)->distance;
    const Linearisation& near = is_nearer_after ? after->where : (after - 1)->where;
    const Minimum found = descend(residuals_, start(near, distance), options_);
    const double growth = (found.objective - minimum_.objective) / options_.scale;
    if (growth < -kLower) lower_ = found;
    const double root = std::isfinite(growth) ? std::sqrt(std::max(0.0, growth)) : 1e6;
    return *points_.insert(after, Point{distance, root, found.where});
  }

  /// The other parameters follow the bottom of the valley as the derivatives predict; those at a bound stay.
  Linearisation start(const Linearisation& near, double distance) const {
    Eigen::VectorXd at = near.at;
    at[parameter_] = std::clamp(minimum_.where.at[parameter_] + direction_ * distance, 0.0, 1.0);
    Eigen::MatrixXd others = near.jacobian;
    others.col(parameter_).setZero();
    for (Eigen::Index j = 0; j < others.cols(); ++j) {
      if (near.at[j] <= 0.0 || near.at[j] >= 1.0) others.col(j).setZero();
    }
    const Eigen::VectorXd along = near.jacobian.col(parameter_) * (at[parameter_] - near.at[parameter_]);
    at -= others.completeOrthogonalDecomposition().solve(along);
    at = at.cwiseMax(0.0).cwiseMin(1.0);
    return moved(near, at, residuals_.at({at}).front());
  }

  Residuals& residuals_;
  const Minimum& minimum_;
  Eigen::Index parameter_;
  int direction_;
  double most_;
  DescentOptions options_;
  std::vector<Point> points_;
  std::optional<Minimum> lower_;
};

}  // namespace

ProfileSide profile_side(Residuals& residuals, const Minimum& minimum, std::size_t parameter, int direction,
                         double deviation, const std::array<double, 2>& rises, double scale, Loss loss) {
  ProfileSide result;
  Side side(residuals, minimum, parameter, direction, scale, loss);
  for (std::size_t i = 0; i < rises.size(); ++i) {
    if (rises[i] <= 0.0) continue;
    const double root = std::sqrt(rises[i]);
    const IntervalEnd distance = side.find(root, root * deviation);
    result.lower = side.take_lower();
    if (result.lower || !distance) break;
    result.ends[i] = minimum.where.at[static_cast<Eigen::Index>(parameter)] + direction * *distance;
  }
  return result;
}

}  // namespace dolp::fit
