#include "fit/descent.hpp"
#include "fit/constants.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace dolp::fit {
namespace {

/// True if a coordinate is at its bound (0 or 1), perhaps apart from rounding.
bool is_on_bound(double coordinate) {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  return coordinate <= kRounding || coordinate >= 1.0 - kRounding;
}

/// A step of the Levenberg-Marquardt method within the ranges. Held parameters keep their components of `step`.
Eigen::VectorXd bounded_step(const Linearisation& where, Eigen::VectorXd step, const std::vector<Eigen::Index>& held,
                             double damping, const Eigen::VectorXd& weights) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index j = 0; j < step.size(); ++j) {
    if (std::ranges::find(held, j) == held.end()) free.push_back(j);
  }
  while (!free.empty()) {
    for (const Eigen::Index j : free) step[j] = 0.0;
    const Eigen::MatrixXd jacobian = weights.asDiagonal() * where.jacobian(Eigen::all, free);
    const Eigen::VectorXd residuals = weights.cwiseProduct(where.residuals + where.jacobian * step);
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += damping;
    step(free) = -principal_axes(normal).inverse() * (jacobian.transpose() * residuals);
    // A parameter that would leave its range goes to the bound instead. Then the other parameters are computed again.
    const auto leaves = [&](Eigen::Index j) {
      const double to = where.at[j] + step[j];
      if (to >= 0.0 && to <= 1.0) return false;
      step[j] = std::clamp(to, 0.0, 1.0) - where.at[j];
      return true;
    };
    if (std::erase_if(free, leaves) == 0) break;
  }
  return step;
}

/// The point `to` with the Jacobian of `near` after Broyden's update. The residuals of `to` are known.
Linearisation moved(const Linearisation& near, Linearisation to) {
  to.jacobian = near.jacobian;
  to.steps = near.steps;
  const Eigen::VectorXd step = to.at - near.at;
  if (step.squaredNorm() > 0.0 && to.residuals.allFinite()) {
    to.jacobian += (to.residuals - near.residuals - near.jacobian * step) * step.transpose() / step.squaredNorm();
  }
  return to;
}

struct Walk {
  Minimum* minimum;
  bool is_stale;        ///< the derivatives must be computed at the current point
  bool is_updated;      ///< the derivatives contain Broyden's updates
  double shrink = 2.0;  ///< divisor of the radius if the next step fails
  bool is_done = false;
  double promised = 0.0;
  Eigen::VectorXd point = {};

  /// Chooses the next point to try, or ends the descent if derivatives predict too small a decrease.
  void aim(const DescentOptions& options) {
    const Linearisation& where = minimum->where;
    if (!where.jacobian.allFinite()) minimum->where.objective = std::numeric_limits<double>::infinity();
    is_done = !std::isfinite(where.objective);
    if (is_done) return;
    // A parameter leaves its bound only if steps of the other parameters do not lower the objective. The reason is the
    // bound k = 0: the model is an even function of k, so finite differences there predict a decrease that is not real.
    std::vector<Eigen::Index> held = minimum->held;
    for (Eigen::Index j = 0; j < where.at.size(); ++j) {
      if (is_on_bound(where.at[j])) held.push_back(j);
    }
    aim(options, held);
    if (is_done && held.size() > minimum->held.size()) aim(options, minimum->held);
    minimum->has_converged = is_done;
  }

  void aim(const DescentOptions& options, const std::vector<Eigen::Index>& held) {
    const Linearisation& where = minimum->where;
    const Eigen::VectorXd step = bounded_step(where, Eigen::VectorXd::Zero(where.at.size()), held,
                                              options.scale / minimum->radius, where.weights);
    point = (where.at + step).cwiseMax(0.0).cwiseMin(1.0);
    promised = where.weights.cwiseProduct(where.residuals).squaredNorm() -
               where.weights.cwiseProduct(where.residuals + where.jacobian * step).squaredNorm();
    constexpr double kLeastStepLength = 1e-7;
    is_done = !(promised >= options.least_gain * options.scale) || step.norm() <= kLeastStepLength;
  }

  /// True if the descent ended with an objective above secant_below, and its derivatives are not computed there.
  bool ends_with_guess(const DescentOptions& options) const {
    return is_done && (is_stale || is_updated) && minimum->objective() > options.secant_below.value_or(0.0);
  }

  /// Moves to the tried point if the objective is lower there. Otherwise the next step is shorter (Nielsen 1999).
  void judge(Linearisation tried, const DescentOptions& options) {
    constexpr double kLeastRadius = 1e-8, kMostRadius = 1e8;
    constexpr double kLeastDecrease = 1e-8;  // a descent ends after a smaller decrease (relative to the objective)
    const double before = minimum->objective();
    const double decrease = before - tried.objective;
    const double ratio = decrease / promised;
    if (!(ratio > kLeastRatio)) {
      minimum->radius /= std::exchange(shrink, 2.0 * shrink);
      minimum->has_converged = is_done = minimum->radius < kLeastRadius;
      is_stale = is_updated;
      return;
    }
    minimum->where = moved(minimum->where, std::move(tried));
    minimum->has_converged = is_done = decrease < kLeastDecrease * before;
    minimum->radius =
        std::min(kMostRadius, minimum->radius / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)));
    shrink = 2.0;
    is_updated = options.secant_below && ratio > kPredictedRatio && ratio < 1.0 / kPredictedRatio;
    is_stale = !is_updated;
  }
};

void refresh(Residuals& residuals, std::vector<Walk>& walks, const DescentOptions& options) {
  std::vector<Linearisation*> stale;
  for (Walk& walk : walks) {
    if (walk.is_stale) stale.push_back(&walk.minimum->where);
  }
  residuals.linearise(stale);
  for (Walk& walk : walks) {
    if (!std::exchange(walk.is_stale, false)) continue;
    walk.is_updated = false;
    walk.aim(options);
  }
}

}  // namespace

Eigen::MatrixXd PrincipalAxes::inverse(double least_share) const {
  const Eigen::VectorXd inverses =
      values.unaryExpr([least = least_share * values[0]](double value) { return value > least ? 1.0 / value : 0.0; });
  return directions * inverses.asDiagonal() * directions.transpose();
}

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues().reverse().cwiseMax(0.0), solver.eigenvectors().rowwise().reverse()};
}

bool is_straight(const Linearisation& from, const Linearisation& to, double scale) {
  const Eigen::VectorXd predicted = from.residuals + from.jacobian * (to.at - from.at);
  return (predicted - to.residuals).squaredNorm() < kBent * ((from.residuals - to.residuals).squaredNorm() + scale);
}

void descend(Residuals& residuals, std::vector<Minimum>& all, const DescentOptions& options) {
  std::vector<Walk> walks;
  for (Minimum& start : all) {
    const bool is_free = static_cast<std::size_t>(start.where.at.size()) > start.held.size();
    start.has_converged = !is_free && std::isfinite(start.objective());
    if (is_free && std::isfinite(start.objective()))
      walks.push_back({&start, start.where.jacobian.size() == 0, options.secant_below.has_value()});
  }
  const auto is_done = [](const Walk& walk) { return walk.is_done; };
  for (int i = 0; i < options.most_steps && !walks.empty(); ++i) {
    for (Walk& walk : walks) {
      if (walk.is_stale) continue;
      walk.aim(options);
      walk.is_stale = walk.ends_with_guess(options);
    }
    refresh(residuals, walks, options);
    std::erase_if(walks, is_done);
    std::vector<Eigen::VectorXd> points;
    for (const Walk& walk : walks) points.push_back(walk.point);
    std::vector<Linearisation> tried = residuals.at(points);
    for (std::size_t k = 0; k < walks.size(); ++k) walks[k].judge(std::move(tried[k]), options);
    std::vector<Linearisation*> guessed;
    for (Walk& walk : walks) {
      if (walk.ends_with_guess(options)) guessed.push_back(&walk.minimum->where);
    }
    residuals.linearise(guessed);
    std::erase_if(walks, is_done);
  }
  refresh(residuals, walks, options);
}

std::pair<Eigen::VectorXd, double> predict_step(const Neighbour& neighbour, double scale) {
  const Linearisation& near = neighbour.near->where;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(near.at.size());
  for (const Eigen::Index j : neighbour.held) step[j] = neighbour.to[j] - near.at[j];
  if (near.jacobian.size() == 0) return {near.at + step, std::numeric_limits<double>::infinity()};
  step = bounded_step(near, step, neighbour.held, scale / kRadiusOfNeighbours,
                      Eigen::VectorXd::Ones(near.residuals.size()));
  // A descent cannot leave a bound where the model is an even function of the parameter, such as k = 0. So a parameter
  // that is not held goes only half of the way to a bound.
  for (Eigen::Index j = 0; j < step.size(); ++j) {
    const bool is_held = std::ranges::find(neighbour.held, j) != neighbour.held.end();
    const double to = near.at[j] + step[j];
    if (!is_held && is_on_bound(to)) step[j] *= 0.5;
  }
  return {(near.at + step).cwiseMax(0.0).cwiseMin(1.0), (near.residuals + near.jacobian * step).squaredNorm()};
}

std::vector<Minimum> follow(Residuals& residuals, const std::vector<Neighbour>& all, const DescentOptions& options) {
  std::vector<Eigen::VectorXd> points;
  for (const Neighbour& neighbour : all) points.push_back(predict_step(neighbour, options.scale).first);
  std::vector<Linearisation> found = residuals.at(points);
  std::vector<Minimum> minima;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Linearisation& near = all[i].near->where;
    const bool is_predicted = near.jacobian.size() > 0 && is_straight(near, found[i], options.scale);
    Minimum& start = minima.emplace_back();
    start.where = is_predicted ? moved(near, std::move(found[i])) : std::move(found[i]);
    start.where.steps = near.steps;
    start.held = all[i].held;
    start.radius = kRadiusOfNeighbours;
  }
  descend(residuals, minima, options);
  return minima;
}

}  // namespace dolp::fit
