#include "base/numbers.hpp"
#include "fit/constants.hpp"
#include "fit/search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace dolp::fit {
namespace {

struct ProfilePoint {
  double distance = 0.0;  ///< distance from the start along the coordinate of the parameter
  double root = 0.0;      ///< square root of (objective - ProfileOptions::from) / scale
  Minimum found;
};

/// One side of a profile likelihood. It goes from a minimum towards one end of the parameter's range.
class Side {
 public:
  Side(Minimum start, Eigen::Index parameter, int direction, double most, double least, const ProfileOptions& options)
      : parameter_(parameter), direction_(direction), most_(most), least_(least), options_(&options) {
    start.held = {parameter};
    points_.push_back({0.0, root_growth(start), std::move(start)});
    settle();
  }

  bool is_done() const { return rise_ == options_->rises.size(); }
  std::size_t parameter() const { return static_cast<std::size_t>(parameter_); }
  const std::vector<ProfilePoint>& points() const { return points_; }
  const std::optional<Minimum>& lower() const { return lower_; }
  /// The coordinate at which the side ends for rises[rise]. Empty if the growth at the start is not below this rise.
  const std::optional<double>& end(std::size_t rise) const { return ends_[rise]; }
  const Minimum* last_below(std::size_t rise) const {
    const double most = (1.0 + kRootTolerance) * std::sqrt(options_->rises[rise]);
    const auto last =
        std::ranges::find_if(points_.rbegin(), points_.rend(), [&](const ProfilePoint& p) { return p.root <= most; });
    return last == points_.rend() ? nullptr : &last->found;
  }

  Neighbour next() {
    ++tries_;
    distance_ = std::clamp(next_distance(), 0.0, most_);
    // Begins on the side of the start: a point beyond may lie on a higher branch.
    const Minimum& near = (first_from(distance_) - 1)->found;
    Eigen::VectorXd to = near.where.at;
    to[parameter_] = std::clamp(coordinate(distance_), 0.0, 1.0);
    return {&near, {parameter_}, to};
  }

  void add(Minimum found) {
    if (found.objective() < least_ - kLowerMinimum * options_->scale) {
      lower_ = std::move(found);
      finish(distance_);
      return;
    }
    const double root = root_growth(found);
    ProfilePoint point{distance_, root, std::move(found)};
    const PointPosition place = first_from(distance_);
    if (place == points_.cend() || place->distance > distance_) {
      points_.insert(place, std::move(point));
    } else if (root < place->root) {
      points_[static_cast<std::size_t>(place - points_.cbegin())] = std::move(point);
    }
    settle();
  }

 private:
  using PointPosition = std::vector<ProfilePoint>::const_iterator;

  double coordinate(double distance) const {
    return points_.front().found.where.at[parameter_] + direction_ * distance;
  }
  double root_growth(const Minimum& found) const {
    const double growth = (found.objective() - options_->from) / options_->scale;
    return std::isfinite(growth) ? std::sqrt(std::max(0.0, growth)) : 1e6;
  }
  double wanted() const { return std::sqrt(options_->rises[rise_]); }
  PointPosition first_from(double distance) const {
    return std::ranges::find_if(points_, [&](const ProfilePoint& point) { return point.distance >= distance; });
  }
  PointPosition first_above() const {
    return std::ranges::find_if(points_, [&](const ProfilePoint& point) { return point.root >= wanted(); });
  }

  /// True if the first point above the rise is so near to the point before that the profile seems to be discontinuous.
  bool is_at_jump() const {
    const PointPosition above = first_above();
    return above != points_.cend() && above->distance - (above - 1)->distance < kLeastGap * above->distance;
  }

  /// Sets ends_ for each rise that the growth has reached or cannot reach on this side.
  void settle() {
    for (; !is_done(); ++rise_, tries_ = 0) {
      const PointPosition above = first_above();
      if (above == points_.cbegin()) continue;
      // A point is an end if its growth is close to the rise. The growth at the start may be that close already. So the
      // growth at the end must also be clearly larger than at the start, or reach the rise.
      const double least = std::min(wanted(), points_.front().root + kRootTolerance * wanted());
      const auto last = above == points_.cend() ? above : above + 1;
      const auto met = std::find_if(points_.cbegin() + 1, last, [&](const ProfilePoint& p) {
        return p.root >= least && std::abs(p.root - wanted()) <= kRootTolerance * wanted();
      });
      const bool is_jump = is_at_jump() && repeated_ == above->distance;
      if (met != last) {
        ends_[rise_] = coordinate(met->distance);
      } else if (above == points_.cend() && points_.back().distance >= most_) {
        return finish(most_);
      } else if (is_jump || tries_ >= kMostProfilePoints) {
        ends_[rise_] = coordinate((above - 1)->distance);
      } else {
        return;
      }
    }
  }

  void finish(double distance) {
    for (; !is_done(); ++rise_) ends_[rise_] = coordinate(distance);
  }

  /// The next distance to compute: where a line through two points reaches wanted(), the square root of the rise. The
  /// two points are the last one below wanted() and the first one above. If none is above, the line uses the last two.
  double next_distance() {
    if (points_.size() == 1) return first_distance();
    const PointPosition above = first_above();
    if (is_at_jump()) return repeated_ = above->distance;
    if (above != points_.end()) {
      const ProfilePoint& below = *(above - 1);
      const double share = (wanted() - below.root) / (above->root - below.root);
      return std::lerp(below.distance, above->distance, tries_ > kProfileSecants ? 0.5 : std::clamp(share, 0.02, 0.98));
    }
    const ProfilePoint& last = points_.back();
    const ProfilePoint& before = points_[points_.size() - 2];
    const double slope = (last.root - before.root) / (last.distance - before.distance);
    const double farthest = kMostGrowth * last.distance;
    return slope > 0.0 ? std::clamp(last.distance + (wanted() - last.root) / slope, 1.01 * last.distance, farthest)
                       : farthest;
  }

  /// The distance at which the growth reaches the rise, as predicted by the derivatives at the start.
  double first_distance() const {
    const ProfilePoint& first = points_.front();
    Neighbour probe{&first.found, {parameter_}, first.found.where.at};
    probe.to[parameter_] += direction_ * kFirstProbe;
    const double squares = first.found.where.residuals.squaredNorm();
    const double growth = (predict_step(probe, options_->scale).second - squares) / options_->scale;
    const double slope = std::sqrt(std::max(growth, 1e-12)) / kFirstProbe;
    return std::clamp((wanted() - first.root) / slope, 1e-6, 0.5);
  }

  Eigen::Index parameter_;
  int direction_;
  double most_;   ///< largest distance: up to a bound of the range, or back to the interval from another branch
  double least_;  ///< objective of the best minimum
  const ProfileOptions* options_;
  std::vector<ProfilePoint> points_;  ///< points in the order of their distances
  std::size_t rise_ = 0;
  int tries_ = 0;
  double distance_ = 0.0;
  double repeated_ = 0.0;  ///< distance of a point above the rise that was computed again from the point before it
  std::array<std::optional<double>, 2> ends_;
  std::optional<Minimum> lower_;
};

/// An end of an interval. A search for other branches may still move it.
struct ProfileEnd {
  Eigen::Index parameter;
  std::size_t rise;
  int direction;
  double at;  ///< coordinate of the parameter
  auto operator<=>(const ProfileEnd&) const = default;
};

class Profiler {
 public:
  Profiler(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options, Count& done_sides)
      : residuals_(residuals),
        options_(options),
        done_sides_(done_sides),
        least_(minima.empty() ? kInfinity : minima.front().objective()) {
    const double secant_below = objective_at(kTrustedShare * options.rises[0]);
    descent_ = {.scale = options.scale, .least_gain = kProfileGain, .secant_below = secant_below};
    result_.intervals.resize(residuals.model().parameters().size());
    for (const Minimum& minimum : minima) {
      for (Eigen::Index j = 0; j < minimum.where.at.size(); ++j) {
        const double at = minimum.where.at[j];
        sides_.emplace_back(minimum, j, -1, at, least_, options_);
        sides_.emplace_back(minimum, j, 1, 1.0 - at, least_, options_);
      }
    }
  }

  Profiles run() {
    constexpr int kMostSearches = 4;
    constexpr double kKeptRise = 1.6;  // contours use points whose growth is below kKeptRise * rises[1]
    complete(0);
    for (int i = 0; i < kMostSearches && !result_.lower && search_other_branches(); ++i) {
    }
    for (const Side& side : sides_) {
      for (const ProfilePoint& point : side.points()) {
        if (point.root * point.root < kKeptRise * options_.rises[1]) result_.points.push_back(point.found);
      }
    }
    return std::move(result_);
  }

 private:
  void complete(std::size_t first) {
    for (;;) {
      std::vector<Neighbour> wanted;
      std::vector<Side*> open;
      for (Side& side : std::span(sides_).subspan(first)) {
        if (side.is_done()) continue;
        open.push_back(&side);
        wanted.push_back(side.next());
      }
      if (!sides_.empty())
        done_sides_ = {static_cast<std::size_t>(std::ranges::count_if(sides_, &Side::is_done)), sides_.size()};
      if (wanted.empty()) break;
      std::vector<Minimum> found = follow(residuals_, wanted, descent_);
      for (std::size_t k = 0; k < open.size(); ++k) open[k]->add(std::move(found[k]));
    }
    for (std::size_t i = first; i < sides_.size(); i += 2) {
      for (const Side* side : {&sides_[i], &sides_[i + 1]}) {
        if (!side->lower()) continue;
        if (!result_.lower || side->lower()->objective() < result_.lower->objective()) result_.lower = side->lower();
      }
      for (std::size_t rise = 0; rise < options_.rises.size(); ++rise) {
        if (!sides_[i].end(rise)) continue;
        merge(result_.intervals[sides_[i].parameter()][rise], {*sides_[i].end(rise), *sides_[i + 1].end(rise)});
      }
    }
  }

  /// The ends beyond which no search for other branches was made yet. Ends at a bound of the range are left out.
  std::vector<ProfileEnd> new_ends() {
    std::vector<ProfileEnd> ends;
    for (std::size_t j = 0; j < result_.intervals.size(); ++j) {
      for (std::size_t rise = 0; rise < options_.rises.size(); ++rise) {
        const auto parameter = static_cast<Eigen::Index>(j);
        for (const CoordinateInterval& piece : result_.intervals[j][rise]) {
          for (const ProfileEnd& end : {ProfileEnd{parameter, rise, -1, piece.low}, {parameter, rise, 1, piece.high}}) {
            if (end.at >= kAtBound && end.at <= 1.0 - kAtBound && searched_.insert(end).second) ends.push_back(end);
          }
        }
      }
    }
    return ends;
  }

  double objective_at(double rise) const { return options_.from + rise * options_.scale; }

  bool search_other_branches() {
    std::vector<Neighbour> ways;
    std::vector<ProfileEnd> end_of_way;
    for (const ProfileEnd& end : new_ends()) {
      std::ranges::move(ways_beyond(end), std::back_inserter(ways));
      end_of_way.resize(ways.size(), end);
    }
    const std::vector<Minimum> found = follow(residuals_, ways, descent_);
    std::map<ProfileEnd, const Minimum*> lowest;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Minimum*& best = lowest.try_emplace(end_of_way[i], &found[i]).first->second;
      if (found[i].objective() < best->objective()) best = &found[i];
    }
    const std::size_t first = sides_.size();
    for (const auto& [end, best] : lowest) {
      if (!(best->objective() < objective_at(kClearlyLower * options_.rises[end.rise]))) continue;
      const double start = best->where.at[end.parameter];
      const double back = std::abs(start - end.at) + kAtBound;
      const double away = end.direction < 0 ? start : 1.0 - start;
      for (const int direction : {-1, 1}) {
        const double most = direction == end.direction ? away : back;
        sides_.emplace_back(*best, end.parameter, direction, most, least_, options_);
      }
    }
    complete(first);
    return first < sides_.size();
  }

  /// Descents that search for other branches beyond `end`. Each side has a last point below the rise. The descents
  /// begin shortly beyond `end`, near these points. They leave out the point nearest to `end`, and the points to which
  /// a straight path leads from it, see is_straight(). Such points are on the same branch. Another descent begins at
  /// the lowest point of each side that is beyond `end` and outside of the intervals, if its growth is clearly below
  /// the rise.
  std::vector<Neighbour> ways_beyond(const ProfileEnd& end) const {
    const std::vector<CoordinateInterval>& all = result_.intervals[static_cast<std::size_t>(end.parameter)][end.rise];
    const double width = all.back().high - all.front().low;
    const double beyond = std::clamp(end.at + end.direction * kBeyond * width, 0.0, 1.0);
    const auto coordinate = [&](const Minimum& point) { return point.where.at[end.parameter]; };
    const auto distance = [&](const Minimum& point) { return std::abs(coordinate(point) - end.at); };
    const auto objective_beyond = [&](const ProfilePoint& point) {
      const double at = coordinate(point.found);
      const auto is_inside = [&](const CoordinateInterval& piece) {
        return at >= piece.low - kAtBound && at <= piece.high + kAtBound;
      };
      const bool is_beyond = end.direction * (at - end.at) > 0.0 && std::ranges::none_of(all, is_inside);
      return is_beyond ? point.found.objective() : kInfinity;
    };
    const Minimum* nearest = nullptr;
    std::vector<Neighbour> ways;
    for (const Side& side : sides_) {
      const Minimum* const last = side.last_below(end.rise);
      if (last == nullptr) continue;
      if (nearest == nullptr || distance(*last) < distance(*nearest)) nearest = last;
      ways.emplace_back(Neighbour{last, {end.parameter}, last->where.at}).to[end.parameter] = beyond;
    }
    std::erase_if(ways, [&](const Neighbour& way) {
      return way.near == nearest || is_straight(nearest->where, way.near->where, options_.scale);
    });
    for (const Side& side : sides_) {
      const ProfilePoint& lowest = *std::ranges::min_element(side.points(), {}, objective_beyond);
      if (objective_beyond(lowest) < objective_at(kClearlyLower * options_.rises[end.rise]))
        ways.push_back({&lowest.found, {end.parameter}, lowest.found.where.at});
    }
    return ways;
  }

  Residuals& residuals_;
  const ProfileOptions& options_;
  Count& done_sides_;
  double least_;
  DescentOptions descent_;
  std::vector<Side> sides_;
  std::set<ProfileEnd> searched_;
  Profiles result_;
};

}  // namespace

void merge(std::vector<CoordinateInterval>& all, CoordinateInterval added) {
  std::erase_if(all, [&](const CoordinateInterval& other) {
    if (other.high < added.low || added.high < other.low) return false;
    added = {std::min(added.low, other.low), std::max(added.high, other.high)};
    return true;
  });
  all.insert(std::ranges::find_if(all, [&](const CoordinateInterval& other) { return other.low > added.low; }), added);
}

Profiles compute_profiles(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options,
                          Count& sides) {
  return Profiler(residuals, minima, options, sides).run();
}

}  // namespace dolp::fit
