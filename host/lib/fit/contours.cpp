#include "fit/contours.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fit/constants.hpp"
#include "fit/descent.hpp"
#include "fit/principal_axes.hpp"
#include "fit/residuals.hpp"

namespace dolp::fit {
namespace {

using Place = std::pair<int, int>;  // along both axes
using Pair = std::array<std::size_t, 2>;

std::optional<Pair> most_correlated(const Eigen::MatrixXd& correlation) {
  std::optional<Pair> found;
  double largest = -1.0;  // NaN is not larger
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < correlation.cols(); ++j) {
      if (!(std::abs(correlation(i, j)) > largest)) continue;
      largest = std::abs(correlation(i, j));
      found = {static_cast<std::size_t>(i), static_cast<std::size_t>(j)};
    }
  }
  return found;
}

class Map {
 public:
  Map(const Model& model, ModelEvaluator& evaluator, const FitResult& result, const FitOptions& options,
      const Pair& pair)
      : result_(result),
        pair_(pair),
        budget_(result.evaluations),
        residuals_(model, result.tolerance, Differences::kForward, evaluator,
                   [this, &options](std::size_t, std::size_t) {
                     return !options.progress || options.progress(std::min(residuals_.evaluations(), budget_), budget_);
                   }) {
    descent_.loss = options.loss;
    descent_.scale = result.scale;
    descent_.least_gain = kNodeGain;
    descent_.secant_below = result.chi_square + kTrustedGrowth * result.scale;
    axes_ = axes();
  }

  Contours contours() {
    choose_widths();
    spread();
    for (std::optional<int> axis = worst_axis(); axis && can_refine(); axis = worst_axis()) {
      const std::map<Place, Minimum> coarse = nodes_;
      const auto coarse_widths = widths_;
      refine(*axis);
      if (spread()) continue;
      nodes_ = coarse;  // an unfinished map shows less
      widths_ = coarse_widths;
      break;
    }
    return drawn();
  }

 private:
  /// The principal axes of the covariance of both parameters, one standard deviation each, limited by the range.
  Eigen::Matrix2d axes() const {
    const Eigen::MatrixXd& jacobian = result_.seen.front().where.jacobian;
    Eigen::MatrixXd information = jacobian.transpose() * jacobian / result_.scale;
    information.diagonal().array() += 1.0;
    const Eigen::MatrixXd covariance = principal_axes(information).inverse();
    const std::array<Eigen::Index, 2> both = {static_cast<Eigen::Index>(pair_[0]), static_cast<Eigen::Index>(pair_[1])};
    const PrincipalAxes principal = principal_axes(covariance(both, both));
    const Eigen::Vector2d units = principal.values.cwiseSqrt().cwiseMax(kLeastUnit).cwiseMin(kMostUnit);
    return principal.directions * units.asDiagonal();
  }

  Eigen::Vector2d of(const Eigen::VectorXd& at) const {
    return {at[static_cast<Eigen::Index>(pair_[0])], at[static_cast<Eigen::Index>(pair_[1])]};
  }
  double growth(const Minimum& node) const { return (node.objective - result_.chi_square) / result_.scale; }
  bool is_inside(const Minimum& node) const { return growth(node) < kContourLevels.back(); }
  bool is_in_range(const Place& place) const {
    const Eigen::Vector2d at = position(place);
    return at.minCoeff() >= 0.0 && at.maxCoeff() <= 1.0;
  }
  Eigen::Vector2d position(const Place& place) const {
    return of(result_.seen.front().where.at) +
           axes_ * Eigen::Vector2d(place.first * widths_[0], place.second * widths_[1]);
  }

  /// The place of a neighbour; beyond the range the way to it ends at the bound.
  Neighbour beside(const Minimum& near, const Place& place) const {
    const Eigen::Vector2d from = of(near.where.at);
    const Eigen::Vector2d way = position(place) - from;
    double share = 1.0;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double to = from[k] + way[k];
      if (to < 0.0 || to > 1.0) share = std::min(share, (std::clamp(to, 0.0, 1.0) - from[k]) / way[k]);
    }
    Eigen::VectorXd at = near.where.at;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto index = static_cast<Eigen::Index>(k);
      at[static_cast<Eigen::Index>(pair_[k])] = std::clamp(from[index] + share * way[index], 0.0, 1.0);
    }
    return {&near, {pair_[0], pair_[1]}, std::move(at)};
  }

  /// Asks for the node beside a known point.
  void seed(const Minimum& point) {
    const Eigen::Array2d way = way_to(point).array() / widths_.array();
    const Place place = {static_cast<int>(std::lround(way[0])), static_cast<int>(std::lround(way[1]))};
    if (node(place) == nullptr && is_in_range(place)) wanted_.try_emplace(place, &point);
  }

  /// From the best minimum, in units of the axes.
  Eigen::Vector2d way_to(const Minimum& point) const {
    return axes_.inverse() * (of(point.where.at) - of(result_.seen.front().where.at));
  }

  static std::vector<Place> around(const Place& place) {
    std::vector<Place> all;
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) {
        if (a != 0 || b != 0) all.emplace_back(place.first + a, place.second + b);
      }
    }
    return all;
  }

  const Minimum* node(const Place& place) const {
    const auto found = nodes_.find(place);
    return found == nodes_.end() ? nullptr : &found->second;
  }

  /// Asks for all that is unknown beside nodes and cells below the higher level.
  void ask() {
    for (const auto& [place, one] : nodes_) {
      if (is_inside(one)) ask_around(place, one);
      if (!is_crossed(place)) continue;
      for (int i = 0; i < 4; ++i) {
        const Place corner = {place.first + i / 2, place.second + i % 2};
        ask_around(corner, *node(corner));
      }
    }
  }

  void ask_around(const Place& place, const Minimum& one) {
    for (const Place& other : around(place)) {
      // A node that was moved to a bound asks for its neighbours inside alone.
      if (node(other) != nullptr || !(is_in_range(place) || is_in_range(other))) continue;
      const Minimum*& near = wanted_.try_emplace(other, &one).first->second;
      if (one.objective < near->objective) near = &one;
    }
  }

  /// True where a valley leads out of a cell between two corners that lie above.
  bool is_crossed(const Place& place) const {
    const std::optional<Spots> spots = cell(place);
    if (!spots) return false;
    const auto is_low = [&](int i, int j) {
      const double root = (*spots)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)][2];
      return root * root < kContourLevels.back();
    };
    for (const int end : {0, kPartsOfACell}) {
      for (int i = 1; i < kPartsOfACell; ++i) {
        if (is_low(end, i) && !is_low(end, 0) && !is_low(end, kPartsOfACell)) return true;
        if (is_low(i, end) && !is_low(0, end) && !is_low(kPartsOfACell, end)) return true;
      }
    }
    return false;
  }

  /// Asks for the nodes to which a neighbour foretells a much lower growth, once for each neighbour and growth.
  void retry_suspicious_nodes() {
    if (result_.parameters.size() == 2) return;
    for (const auto& [place, one] : nodes_) {
      double least = kSuspiciousShare * std::min(growth(one), 1e6);
      for (const Place& other : around(place)) {
        const Minimum* const near = node(other);
        if (near == nullptr || !is_in_range(other) || growth(*near) > kFarGrowth) continue;
        const double foretold =
            (foretell(beside(*near, place), result_.scale).second - result_.chi_square) / result_.scale;
        if (foretold > std::min(least, kFarGrowth) || !doubted_.insert({place, other}).second) continue;
        least = foretold;
        wanted_[place] = near;
      }
    }
  }

  double cost_of_a_node() const {
    const auto guess = static_cast<double>(2 * result_.parameters.size() - 3);
    return nodes_.empty() ? guess : static_cast<double>(residuals_.evaluations()) / static_cast<double>(nodes_.size());
  }
  bool can_pay(std::size_t nodes) const {
    return static_cast<double>(residuals_.evaluations()) +
               kCostSafety * cost_of_a_node() * static_cast<double>(nodes) <=
           static_cast<double>(budget_);
  }
  bool can_refine() const { return can_pay(nodes_.size()); }

  /// Widens the grid until half of what may be spent suffices for a rectangle around all that is known.
  void choose_widths() {
    Eigen::Array2d extent = Eigen::Array2d::Zero();
    for (const Minimum& one : result_.seen) extent = extent.max(way_to(one).array().abs());
    const auto nodes = [&] { return (2.0 * extent / widths_.array() + 3.0).prod(); };
    const auto is_wider = [&] { return (extent / widths_.array()).maxCoeff() > 1.0; };
    while (2.0 * cost_of_a_node() * nodes() > static_cast<double>(budget_) && is_wider()) {
      Eigen::Index longer = 0;
      (extent / widths_.array()).maxCoeff(&longer);
      widths_[longer] *= 2.0;
    }
  }

  /// Completes the nodes; false where it ends because that costs too much.
  bool spread() {
    for (const Minimum& one : result_.seen) seed(one);
    for (;;) {
      ask();
      if (wanted_.empty()) retry_suspicious_nodes();
      if (wanted_.empty()) return true;
      if (!can_pay(wanted_.size())) {
        wanted_.clear();
        return false;
      }
      std::vector<Neighbour> neighbours;
      for (const auto& [place, near] : wanted_) neighbours.push_back(beside(*near, place));
      std::vector<Minimum> found = follow(residuals_, neighbours, descent_);
      auto next = found.begin();
      for (const auto& [place, near] : wanted_) {
        const auto [known, is_new] = nodes_.try_emplace(place, *next);
        if (!is_new && next->objective < known->second.objective) known->second = std::move(*next);
        ++next;
      }
      wanted_.clear();
    }
  }

  /// The axis along which residuals bend most between nodes; none where they are straight enough.
  std::optional<int> worst_axis() const {
    std::array<double, 2> worst{};
    for (const auto& [place, one] : nodes_) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const int a = axis == 0 ? 1 : 0;
        const Minimum* const before = node({place.first - a, place.second - 1 + a});
        const Minimum* const after = node({place.first + a, place.second + 1 - a});
        const bool is_coarse = widths_[static_cast<Eigen::Index>(axis)] > kFinestUnit;
        if (before == nullptr || after == nullptr || growth(one) > kFarGrowth || !is_coarse) continue;
        const double bend = (before->where.residuals - 2.0 * one.where.residuals + after->where.residuals).norm();
        if (std::isfinite(bend)) worst[axis] = std::max(worst[axis], bend / std::sqrt(result_.scale));
      }
    }
    if (std::max(worst[0], worst[1]) < kStraightCell) return std::nullopt;
    return worst[0] > worst[1] ? 0 : 1;
  }

  /// Halves the distance of nodes along an axis.
  void refine(int axis) {
    std::map<Place, Minimum> nodes;
    for (auto& [place, one] : nodes_) {
      if (!is_in_range(place)) continue;  // one that was moved to a bound
      nodes.emplace(Place{place.first * (axis == 0 ? 2 : 1), place.second * (axis == 1 ? 2 : 1)}, std::move(one));
    }
    nodes_ = std::move(nodes);
    doubted_.clear();
    widths_[axis] *= 0.5;
  }

  /// A point of a cell: both coordinates, and the root of the growth.
  using Spot = Eigen::Vector3d;
  using Spots = std::array<std::array<Spot, kPartsOfACell + 1>, kPartsOfACell + 1>;

  /// The values interpolated in the cell above a place; none where a corner is not known.
  std::optional<Spots> cell(const Place& place) const {
    std::array<const Minimum*, 4> corners{};
    for (int i = 0; i < 4; ++i) {
      const Minimum* const corner = node({place.first + i / 2, place.second + i % 2});
      if (corner == nullptr || !std::isfinite(corner->objective)) return std::nullopt;
      corners[static_cast<std::size_t>(i)] = corner;
    }
    Spots spots;
    for (std::size_t i = 0; i <= kPartsOfACell; ++i) {
      for (std::size_t j = 0; j <= kPartsOfACell; ++j) {
        const double x = static_cast<double>(i) / kPartsOfACell, y = static_cast<double>(j) / kPartsOfACell;
        const std::array<double, 4> weights = {(1.0 - x) * (1.0 - y), (1.0 - x) * y, x * (1.0 - y), x * y};
        Minimum spot{{Eigen::VectorXd::Zero(corners[0]->where.at.size())}};
        spot.where.residuals = Eigen::VectorXd::Zero(corners[0]->where.residuals.size());
        for (std::size_t k = 0; k < 4; ++k) {
          spot.where.at += weights[k] * corners[k]->where.at;
          spot.where.residuals += weights[k] * corners[k]->where.residuals;
        }
        spot.objective = objective(spot.where.residuals, descent_.loss);
        spots[i][j] << of(spot.where.at), std::sqrt(std::max(0.0, growth(spot)));
      }
    }
    return spots;
  }

  /// Adds the part of a level's line in a triangle, in values of the parameters.
  void add_segment(std::vector<Eigen::Vector4d>& segments, double root, const std::array<Spot, 3>& corners) const {
    std::vector<double> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Spot &from = corners[i], &to = corners[(i + 1) % 3];
      if ((from[2] < root) == (to[2] < root)) continue;
      const Spot at = from + (root - from[2]) / (to[2] - from[2]) * (to - from);
      for (std::size_t k = 0; k < 2; ++k) {
        ends.push_back(residuals_.model().parameters()[pair_[k]].at(at[static_cast<Eigen::Index>(k)]));
      }
    }
    if (ends.size() == 4) segments.emplace_back(ends[0], ends[1], ends[2], ends[3]);
  }

  Contours drawn() const {
    Contours result;
    result.parameters = pair_;
    result.evaluations = residuals_.evaluations();
    for (const auto& [place, one] : nodes_) {
      const std::optional<Spots> spots = cell(place);
      for (std::size_t i = 0; spots && i < kPartsOfACell * kPartsOfACell; ++i) {
        const auto spot = [&](std::size_t right, std::size_t up) {
          return (*spots)[i / kPartsOfACell + right][i % kPartsOfACell + up];
        };
        for (std::size_t level = 0; level < kContourLevels.size(); ++level) {
          const double root = std::sqrt(kContourLevels[level]);
          add_segment(result.segments[level], root, {spot(0, 0), spot(1, 0), spot(1, 1)});
          add_segment(result.segments[level], root, {spot(0, 0), spot(1, 1), spot(0, 1)});
        }
      }
    }
    return result;
  }

  const FitResult& result_;
  Pair pair_;
  std::size_t budget_;
  Residuals residuals_;
  DescentOptions descent_;
  Eigen::Matrix2d axes_;
  Eigen::Vector2d widths_ = {1.0, 1.0};
  std::map<Place, Minimum> nodes_;
  std::map<Place, const Minimum*> wanted_;  ///< places, and the points from which they will be reached
  std::set<std::pair<Place, Place>> doubted_;
};

}  // namespace

std::optional<Contours> contours_of(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options) {
  const auto pair = most_correlated(result.correlation);
  if (!pair) return std::nullopt;
  if (options.phase) options.phase("parameter sets of the contours");
  return Map(model, evaluator, result, options, *pair).contours();
}

}  // namespace dolp::fit
