#include "fit/fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "fit/constants.hpp"
#include "fit/descent.hpp"
#include "fit/residuals.hpp"

namespace dolp::fit {
namespace {

using GridNode = std::pair<int, int>;  // position of a node: steps along both axes from the best minimum

std::optional<std::array<Eigen::Index, 2>> most_correlated(const Eigen::MatrixXd& correlation) {
  const auto pair_strength = [](double r) { return std::isnan(r) ? 0.0 : 1.0 + std::abs(r); };
  const Eigen::MatrixXd strength = correlation.unaryExpr(pair_strength);
  std::array<Eigen::Index, 2> pair{};
  const double largest = Eigen::MatrixXd(strength.triangularView<Eigen::StrictlyUpper>()).maxCoeff(&pair[0], &pair[1]);
  return largest > 0.0 ? std::optional(pair) : std::nullopt;
}

class GrowthMap {
 public:
  GrowthMap(const Model& model, ModelEvaluator& evaluator, const FitResult& result, const FitOptions& options,
            const std::array<Eigen::Index, 2>& pair)
      : result_(result),
        pair_(pair),
        residuals_(model, evaluator,
                   {.tolerance = result.tolerance,
                    .loss = options.loss,
                    .progress =
                        [this, &options](std::size_t, std::size_t) {
                          const std::size_t most = result_.evaluations;
                          return !options.progress || options.progress(std::min(residuals_.evaluations(), most), most);
                        }}),
        descent_{.scale = result.scale, .least_gain = kNodeGain, .secant_below = result.chi_square + result.scale},
        steps_(first_steps()) {}

  Contours contours() {
    for (std::size_t grid = 1; !spread((grid + 1) * result_.evaluations / 2) && grid < kMostGrids; ++grid) {
      nodes_.clear();
      steps_ *= 2.0;
    }
    return drawn();
  }

 private:
  Eigen::Matrix2d first_steps() const {
    const Eigen::MatrixXd& jacobian = result_.valley_points.front().where.jacobian;
    Eigen::MatrixXd information = jacobian.transpose() * jacobian / result_.scale;
    information.diagonal().array() += 1.0;
    const Eigen::MatrixXd covariance = principal_axes(information).inverse();
    const PrincipalAxes principal = principal_axes(covariance(pair_, pair_));
    const Eigen::Vector2d deviations = principal.values.cwiseSqrt().cwiseMax(kLeastDeviation).cwiseMin(kMostDeviation);
    return kStepOfDeviation * principal.directions * deviations.asDiagonal();
  }

  Eigen::Vector2d position(const GridNode& node) const {
    return result_.valley_points.front().where.at(pair_) + steps_ * Eigen::Vector2d(node.first, node.second);
  }
  /// True if a node is at most about one step outside the ranges of the parameters. beside() moves it into the ranges.
  bool is_near_range(const GridNode& node) const {
    const Eigen::Vector2d at = position(node);
    return (steps_.inverse() * (at - at.cwiseMax(0.0).cwiseMin(1.0))).norm() < 1.5;
  }
  double growth(double objective) const { return (objective - result_.chi_square) / result_.scale; }

  Neighbour beside(const Minimum& near, const GridNode& node) const {
    Neighbour neighbour{&near, {pair_.begin(), pair_.end()}, near.where.at};
    neighbour.to(pair_) = position(node).cwiseMax(0.0).cwiseMin(1.0);
    return neighbour;
  }

  /// The nodes to compute. Each has the known point where its descent begins.
  using Wanted = std::map<GridNode, const Minimum*>;

  Wanted first_nodes() const {
    Wanted wanted;
    for (const Minimum& point : result_.valley_points) {
      const Eigen::Vector2d steps = steps_.inverse() * (point.where.at - result_.valley_points.front().where.at)(pair_);
      const GridNode node = {static_cast<int>(std::lround(steps[0])), static_cast<int>(std::lround(steps[1]))};
      if (is_near_range(node)) wanted.try_emplace(node, &point);
    }
    return wanted;
  }

  /// Nodes beside computed nodes with low growth. The descent to each node begins at its lowest computed neighbour.
  Wanted next_nodes() const {
    Wanted wanted;
    for (const auto& [node, point] : nodes_) {
      if (!(growth(point.objective()) < kSpreadGrowth)) continue;
      for (int i = 0; i < 9; ++i) {
        const GridNode other = {node.first + i / 3 - 1, node.second + i % 3 - 1};
        if (nodes_.contains(other) || !is_near_range(other)) continue;
        const Minimum*& near = wanted.try_emplace(other, &point).first->second;
        if (point.objective() < near->objective()) near = &point;
      }
    }
    return wanted;
  }

  /// Computes nodes until they enclose the outer contour. Returns false if `most_evaluations` are not enough.
  bool spread(std::size_t most_evaluations) {
    for (Wanted wanted = first_nodes(); !wanted.empty(); wanted = next_nodes()) {
      if (residuals_.evaluations() >= most_evaluations) return false;
      std::vector<Neighbour> neighbours;
      for (const auto& [node, near] : wanted) neighbours.push_back(beside(*near, node));
      std::vector<Minimum> found = follow(residuals_, neighbours, descent_);
      auto next = found.begin();
      for (const auto& [node, near] : wanted) nodes_.emplace(node, std::move(*next++));
    }
    return true;
  }

  /// The growth on a finer grid, from interpolated residuals. Interpolated growth would miss a valley inside a cell.
  Contours drawn() const {
    GridNode low, high;
    for (const auto& [node, point] : nodes_) {
      low = {std::min(low.first, node.first), std::min(low.second, node.second)};
      high = {std::max(high.first, node.first), std::max(high.second, node.second)};
    }
    const Eigen::Index rows = kPartsOfACell * (high.first - low.first) + 1;
    const Eigen::Index columns = kPartsOfACell * (high.second - low.second) + 1;
    Contours contours{{static_cast<std::size_t>(pair_[0]), static_cast<std::size_t>(pair_[1])}, {}, {}, 0};
    contours.growth.setConstant(rows, columns, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < 2; ++k)
      contours.values[k].setConstant(rows, columns, result_.parameters[contours.parameters[k]].value);
    for (const auto& [node, point] : nodes_) {
      std::vector<const Linearisation*> corners;
      for (int k = 0; k < 4; ++k) {
        const auto corner = nodes_.find({node.first + k / 2, node.second + k % 2});
        if (corner != nodes_.end() && std::isfinite(corner->second.objective()))
          corners.push_back(&corner->second.where);
      }
      if (corners.size() == 4)
        fill(contours, kPartsOfACell * (node.first - low.first), kPartsOfACell * (node.second - low.second), corners);
    }
    contours.evaluations = residuals_.evaluations();
    return contours;
  }

  void fill(Contours& contours, Eigen::Index row, Eigen::Index column,
            const std::vector<const Linearisation*>& corners) const {
    for (int i = 0; i <= kPartsOfACell; ++i) {
      for (int j = 0; j <= kPartsOfACell; ++j) {
        const double x = static_cast<double>(i) / kPartsOfACell, y = static_cast<double>(j) / kPartsOfACell;
        const auto between = [&](Eigen::VectorXd Linearisation::*value) -> Eigen::VectorXd {
          return (1.0 - x) * ((1.0 - y) * corners[0]->*value + y * corners[1]->*value) +
                 x * ((1.0 - y) * corners[2]->*value + y * corners[3]->*value);
        };
        const Eigen::VectorXd at = residuals_.model().values(between(&Linearisation::at));
        for (std::size_t k = 0; k < 2; ++k) contours.values[k](row + i, column + j) = at[pair_[k]];
        const double reached = growth(residuals_.objective(between(&Linearisation::residuals)));
        contours.growth(row + i, column + j) = std::max(0.0, reached);
      }
    }
  }

  const FitResult& result_;
  std::array<Eigen::Index, 2> pair_;
  Residuals residuals_;
  DescentOptions descent_;
  Eigen::Matrix2d steps_;  ///< each column is one step of the grid
  std::map<GridNode, Minimum> nodes_;
};

}  // namespace

std::optional<Contours> compute_contours(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                         const FitOptions& options) {
  const auto pair = most_correlated(result.correlation);
  if (!pair) return std::nullopt;
  if (options.phase) options.phase("parameter sets of the contours");
  return GrowthMap(model, evaluator, result, options, *pair).contours();
}

}  // namespace dolp::fit
