#include "fit/search.hpp"
#include "fit/constants.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <iterator>
#include <random>
#include <span>
#include <utility>

namespace dolp::fit {
namespace {

std::vector<Eigen::VectorXd> sobol_points(std::size_t count, Eigen::Index dimensions, std::uint64_t seed) {
  boost::random::sobol sequence(static_cast<std::size_t>(dimensions));
  std::mt19937_64 engine(seed);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(dimensions);
  if (seed != 1) {
    for (double& value : shift) value = std::generate_canonical<double, 53>(engine);
  }
  const double most = static_cast<double>(boost::random::sobol::max());
  std::vector<Eigen::VectorXd> points(count, Eigen::VectorXd(dimensions));
  for (Eigen::VectorXd& point : points) {
    for (Eigen::Index j = 0; j < dimensions; ++j) {
      const double at = static_cast<double>(sequence()) / most + shift[j];
      point[j] = at - std::floor(at);
    }
  }
  return points;
}

/// Where descents begin: at the start that the user gave (if any), then at the points of a Sobol sequence that have the
/// lowest objective. Leaves out a point that is close to another start.
std::vector<Minimum> choose_starts(Residuals& residuals, const FitOptions& options) {
  const std::vector<FitRange>& parameters = residuals.model().parameters();
  const auto dimensions = static_cast<Eigen::Index>(parameters.size());
  std::vector<Eigen::VectorXd> points = sobol_points(kPointsOfAStart * options.starts, dimensions, options.seed);
  const bool has_start =
      std::ranges::any_of(parameters, [](const FitRange& parameter) { return parameter.start.has_value(); });
  if (has_start) {
    Eigen::VectorXd given = Eigen::VectorXd::Constant(dimensions, 0.5);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      if (parameters[j].start) given[static_cast<Eigen::Index>(j)] = parameters[j].coordinate(*parameters[j].start);
    }
    points.insert(points.begin(), given);
  }
  std::vector<Linearisation> candidates = residuals.at(points);
  std::ranges::stable_sort(std::span(candidates).subspan(has_start ? 1 : 0), {}, &Linearisation::objective);
  const double apart = 0.5 * std::pow(static_cast<double>(options.starts), -1.0 / static_cast<double>(dimensions));
  std::vector<Minimum> starts;
  for (Linearisation& candidate : candidates) {
    const auto is_near = [&](const Minimum& start) {
      return (start.where.at - candidate.at).lpNorm<Eigen::Infinity>() < apart;
    };
    if (std::isfinite(candidate.objective) && std::ranges::none_of(starts, is_near))
      starts.push_back({.where = std::move(candidate)});
    if (starts.size() == options.starts) break;
  }
  return starts;
}

/// Moves a point perpendicular to `line` to the floor of the valley: to the least predicted sum of squared residuals.
Eigen::VectorXd on_floor(const Eigen::VectorXd& point, const Eigen::VectorXd& residuals,
                         const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& line) {
  const Eigen::VectorXd along = line.normalized();
  const Eigen::MatrixXd across = jacobian - jacobian * along * along.transpose();
  constexpr double kFlatShare = 1e-12;  // an axis is flat if its eigenvalue is below this share of the largest
  const PrincipalAxes axes = principal_axes(across.transpose() * across);
  const Eigen::VectorXd moved = point - axes.inverse(kFlatShare) * across.transpose() * residuals;
  return moved.cwiseMax(0.0).cwiseMin(1.0);
}

/// True if each point's objective is at most `scale` above the lowest value before it. The first value is `from`.
bool falls(double from, const std::vector<Linearisation>& points, double scale) {
  double least = from;
  return std::ranges::all_of(points, [&](const Linearisation& point) {
    const bool is_low = point.objective <= least + scale;
    least = std::min(least, point.objective);
    return is_low;
  });
}

/// True if the objective falls() on the straight line from one minimum to another, or on the valley floor beside it.
bool leads_down(Residuals& residuals, const Minimum& from, const Minimum& to) {
  const double scale = noise_scale(residuals, to.objective());
  const Eigen::VectorXd line = to.where.at - from.where.at;
  if (line.squaredNorm() == 0.0) return true;
  std::vector<Eigen::VectorXd> points;
  for (int i = 1; i < kPointsOfALine; ++i)
    points.push_back(from.where.at + line * (static_cast<double>(i) / kPointsOfALine));
  const std::vector<Linearisation> found = residuals.at(points);
  if (falls(from.objective(), found, scale)) return true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!found[i].residuals.allFinite()) continue;
    const double share = static_cast<double>(i + 1) / kPointsOfALine;
    const Eigen::MatrixXd jacobian = (1.0 - share) * from.where.jacobian + share * to.where.jacobian;
    points[i] = on_floor(points[i], found[i].residuals, jacobian, line);
  }
  return falls(from.objective(), residuals.at(points), scale);
}

/// The minima, the lowest first. Leaves out a minimum if a path leads down from it to a lower minimum.
std::vector<Minimum> distinct(std::vector<Minimum> all, Residuals& residuals) {
  std::erase_if(all, [](const Minimum& minimum) { return !std::isfinite(minimum.objective()); });
  std::ranges::stable_sort(all, {}, &Minimum::objective);
  std::vector<Minimum> kept;
  for (Minimum& candidate : all) {
    const auto is_above = [&](const Minimum& lower) { return leads_down(residuals, candidate, lower); };
    if (std::ranges::none_of(kept, is_above)) kept.push_back(std::move(candidate));
  }
  return kept;
}

/// Descends from several points, a few steps per round, and returns where the descents end. Drops a descent if its
/// derivatives and those at a lower point of another descent predict each other's residuals: both probably reach the
/// same minimum.
std::vector<Minimum> descend_apart(Residuals& residuals, std::vector<Minimum> starts, const DescentOptions& descent,
                                   Count& descents) {
  std::vector<Minimum> arrived, passed;
  const std::size_t all = starts.size();
  for (int round = 0; round < kMostRounds && !starts.empty(); ++round) {
    descend(residuals, starts, descent);
    std::vector<Minimum> ends = std::exchange(starts, {});
    std::ranges::stable_sort(ends, {}, &Minimum::objective);
    for (Minimum& end : ends) {
      const auto leads_to = [&](const Minimum& minimum) {
        const double scale = noise_scale(residuals, minimum.objective());
        return minimum.objective() <= end.objective() && minimum.where.at != end.where.at &&
               is_straight(end.where, minimum.where, scale) && is_straight(minimum.where, end.where, scale);
      };
      if (!std::isfinite(end.objective()) || std::ranges::any_of(passed, leads_to)) continue;
      passed.push_back(end);
      (end.has_converged ? arrived : starts).push_back(std::move(end));
    }
    descents = {all - starts.size(), all};
  }
  std::ranges::move(starts, std::back_inserter(arrived));
  return arrived;
}

}  // namespace

double noise_scale(const Residuals& residuals, double minimum) {
  const Model& model = residuals.model();
  if (model.has_uncertainties()) return 1.0;
  const auto freedom = static_cast<double>(model.observation_count() - model.parameters().size());
  return std::max(minimum / std::max(1.0, freedom), residuals.tolerance() * residuals.tolerance());
}

std::vector<Minimum> descend_to_minima(Residuals& residuals, const std::vector<Eigen::VectorXd>& starts, double scale) {
  std::vector<Minimum> minima;
  for (Linearisation& start : residuals.at(starts)) minima.push_back({.where = std::move(start)});
  descend(residuals, minima, {scale, 100});
  std::erase_if(minima, [](const Minimum& candidate) { return !candidate.has_converged; });
  return distinct(std::move(minima), residuals);
}

std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const FitOptions& options, double scale,
                                 Count& descents) {
  const DescentOptions round{scale, kStepsOfARound, kCoarseGain};
  std::vector<Minimum> far = distinct(descend_apart(coarse, choose_starts(coarse, options), round, descents), coarse);
  if (far.empty()) return far;
  const double noise = noise_scale(fine, far.front().objective());
  const double most = far.front().objective() + kFarAbove * noise;
  const auto end_of_near = std::ranges::upper_bound(far, most, {}, &Minimum::objective);
  std::vector<Eigen::VectorXd> points;
  for (auto minimum = far.begin(); minimum != end_of_near; ++minimum) points.push_back(minimum->where.at);
  far.erase(far.begin(), end_of_near);
  std::vector<Minimum> minima = descend_to_minima(fine, points, noise);
  std::erase_if(far, [](const Minimum& candidate) { return !candidate.has_converged; });
  std::ranges::move(far, std::back_inserter(minima));
  std::ranges::stable_sort(minima, {}, &Minimum::objective);
  return minima;
}

}  // namespace dolp::fit
