#include "fit/curve.hpp"
#include "base/numbers.hpp"
#include "fit/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dolp::fit {

Curve::Curve(Residuals& coarse, Residuals& fine, const FitOptions& options) : coarse_(coarse), fine_(fine) {
  const auto steps = static_cast<double>(kStepsOfAStart * options.starts);
  std::vector<Eigen::VectorXd> places;
  for (double i = 0.0; i <= steps; ++i) places.push_back(Eigen::VectorXd::Constant(1, i / steps));
  const FitRange& range = fine.model().parameters().front();
  if (range.start) places.push_back(Eigen::VectorXd::Constant(1, range.coordinate(*range.start)));
  add(coarse, places);
}

/// Computes points. Replaces points at the same places. Takes the numerical error with the tolerance of fine_ as 0.
void Curve::add(Residuals& residuals, const std::vector<Eigen::VectorXd>& places) {
  const auto coordinate = [](const Linearisation& point) { return point.at[0]; };
  std::vector<Linearisation> added = residuals.at(places);
  for (Linearisation& point : added) point.error = &residuals == &fine_ ? 0.0 : point.error;
  points_.insert(points_.begin(), added.begin(), added.end());
  std::ranges::stable_sort(points_, {}, coordinate);
  const auto repeated = std::ranges::unique(points_, {}, coordinate);
  points_.erase(repeated.begin(), repeated.end());
}

/// The interpolated objective on a piece. `share` is 0 at the start of the piece and 1 at its end.
double Curve::between(std::size_t i, double share) const {
  return fine_.objective((1.0 - share) * points_[i].residuals + share * points_[i + 1].residuals);
}

/// The share of a piece at which the interpolated objective is lowest.
double Curve::lowest_share(std::size_t i) const {
  const Eigen::VectorXd& weights = points_[points_[i].objective <= points_[i + 1].objective ? i : i + 1].weights;
  const Eigen::VectorXd change = weights.cwiseProduct(points_[i + 1].residuals - points_[i].residuals);
  const double share = -weights.cwiseProduct(points_[i].residuals).dot(change) / change.squaredNorm();
  return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

/// Estimates the largest error of the interpolated objective on a piece, as if the residuals were parabolas.
double Curve::error(std::size_t i) const {
  const double high = std::max(points_[i].objective, points_[i + 1].objective);
  if (std::isinf(high)) return std::isinf(std::min(points_[i].objective, points_[i + 1].objective)) ? 0.0 : kInfinity;
  const double width = at(i + 1) - at(i);
  const double length = 0.25 * std::max(bend(i), bend(i + 1)) * width * width;
  return length * (2.0 * std::sqrt(high) + length);
}

/// The length of the error of the residuals at a point if they are interpolated between both neighbours, divided by the
/// product of the distances to the neighbours. It is 0 if the error is unknown.
double Curve::bend(std::size_t i) const {
  if (i == 0 || i + 1 == points_.size()) return 0.0;
  const double before = at(i) - at(i - 1), after = at(i + 1) - at(i);
  const Eigen::VectorXd& here = points_[i].residuals;
  const double length = ((points_[i - 1].residuals - here) / before + (points_[i + 1].residuals - here) / after).norm();
  return std::isfinite(length) ? length / (before + after) : 0.0;
}

/// Bound of the numerical error of the objective at the ends of a piece.
double Curve::numerical_error(std::size_t i) const {
  const auto bound = [](const Linearisation& end) {
    return std::isfinite(end.objective) ? end.error * (2.0 * std::sqrt(end.objective) + end.error) : 0.0;
  };
  return std::max(bound(points_[i]), bound(points_[i + 1]));
}

/// Adds points until no piece is both inaccurate and longer than kLeastStep. Halves a piece, or first computes its ends
/// with the tolerance of fine_ if `residuals` is fine_.
void Curve::refine(Residuals& residuals, const std::function<bool(std::size_t)>& is_inaccurate) {
  for (;;) {
    std::vector<Eigen::VectorXd> places;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      if (at(i + 1) - at(i) <= kLeastStep || !is_inaccurate(i)) continue;
      const bool is_half = &residuals == &coarse_ || numerical_error(i) == 0.0;
      if (is_half) places.push_back(0.5 * (points_[i].at + points_[i + 1].at));
      if (!is_half && points_[i].error > 0.0) places.push_back(points_[i].at);
      if (!is_half && points_[i + 1].error > 0.0) places.push_back(points_[i + 1].at);
    }
    if (places.empty()) return;
    add(residuals, places);
  }
}

std::vector<Eigen::VectorXd> Curve::low_points() {
  const auto highest = [&] {
    const double lowest = std::ranges::min_element(points_, {}, &Linearisation::objective)->objective;
    return lowest + kFarAbove * noise_scale(fine_, lowest);
  };
  // Halves a piece if it may hide a minimum that is lower than both of its ends.
  refine(coarse_, [&](std::size_t i) {
    const double low = between(i, lowest_share(i)) - error(i);
    const double ends = std::min(points_[i].objective, points_[i + 1].objective);
    return low < highest() && ends - low > noise_scale(fine_, std::max(0.0, low)) + numerical_error(i);
  });
  std::vector<Eigen::VectorXd> low;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool is_low_before = i == 0 || points_[i].objective <= points_[i - 1].objective;
    const bool is_low_after = i + 1 == points_.size() || points_[i].objective <= points_[i + 1].objective;
    if (is_low_before && is_low_after && points_[i].objective <= highest()) low.push_back(points_[i].at);
  }
  return low;
}

Profiles Curve::profiles(const std::vector<Minimum>& minima, const ProfileOptions& options) {
  std::vector<Eigen::VectorXd> places;
  for (const Minimum& minimum : minima) places.push_back(minimum.where.at);
  add(fine_, places);
  const double best = std::ranges::min_element(points_, {}, &Linearisation::objective)->at[0];
  // A piece is inaccurate if the objective may reach the end of an interval there, and the error is too large.
  refine(fine_, [&](std::size_t i) {
    const double numerical = numerical_error(i), most_error = error(i) + numerical;
    const double reach = std::max(best - at(i), at(i + 1) - best);
    if (numerical == 0.0 && at(i + 1) - at(i) < kLeastGap * reach) return false;
    const double high = std::max(points_[i].objective, points_[i + 1].objective) + most_error;
    const double low = between(i, lowest_share(i)) - most_error;
    return std::ranges::any_of(options.rises, [&](double rise) {
      const double level = options.from + rise * options.scale;
      return low <= level && level <= high && most_error > 2.0 * kRootTolerance * rise * options.scale;
    });
  });
  Profiles result{{{pieces_below(options.from + options.rises[0] * options.scale),
                    pieces_below(options.from + options.rises[1] * options.scale)}}};
  const Linearisation& lowest = *std::ranges::min_element(points_, {}, &Linearisation::objective);
  if (lowest.objective < options.from - kLowerMinimum * options.scale) result.lower = {.where = lowest};
  return result;
}

/// The parts of the range in which the interpolated objective is at most `level`.
std::vector<CoordinateInterval> Curve::pieces_below(double level) const {
  std::vector<CoordinateInterval> pieces;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const double lowest = lowest_share(i);
    if (between(i, lowest) > level) continue;
    std::array<double, 2> ends{};
    for (std::size_t end = 0; end < 2; ++end) {
      double inside = lowest, outside = static_cast<double>(end);
      if (points_[i + end].objective <= level) inside = outside;
      while (std::abs(outside - inside) > kRootTolerance) {
        const double middle = 0.5 * (inside + outside);
        (between(i, middle) <= level ? inside : outside) = middle;
      }
      ends[end] = std::lerp(at(i), at(i + 1), inside);
    }
    merge(pieces, {ends[0], ends[1]});
  }
  return pieces;
}

}  // namespace dolp::fit
