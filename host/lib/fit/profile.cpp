#include "fit/profile.hpp"
#include "fit/constants.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace dolp::fit {
namespace {

/// A point of the profile.
struct Point {
  double distance = 0.0;  ///< from the start, in coordinates of the parameter
  double root = 0.0;      ///< of how far the objective lies above where rises count from
  Minimum found;
};

/// The way from a point of a profile in one direction of the parameter.
class Side {
 public:
  Side(Minimum start, std::size_t parameter, int direction, double most, double least, const ProfileOptions& options)
      : parameter_(parameter), direction_(direction), most_(most), least_(least), options_(&options) {
    start.held = {parameter};
    points_.push_back({0.0, root_of(start), std::move(start)});
    settle();
  }

  bool is_done() const { return rise_ == options_->rises.size(); }
  std::size_t parameter() const { return parameter_; }
  int direction() const { return direction_; }
  double start() const { return at(points_.front()); }
  const std::vector<Point>& points() const { return points_; }
  const std::optional<Minimum>& lower() const { return lower_; }
  /// The coordinate at which a rise is met, or the last one where none is. None where the start lies above it.
  const std::optional<double>& end(std::size_t rise) const { return ends_[rise]; }
  /// The last point below a rise.
  const Minimum* last_below(std::size_t rise) const {
    const double most = (1.0 + kRootTolerance) * std::sqrt(options_->rises[rise]);
    const auto last =
        std::ranges::find_if(points_.rbegin(), points_.rend(), [&](const Point& p) { return p.root <= most; });
    return last == points_.rend() ? nullptr : &last->found;
  }
  /// The lowest point at which a parameter lies beyond an end, clearly below a rise.
  const Minimum* lowest_beyond(std::size_t parameter, double end, int direction, double rise) const {
    const Point* lowest = nullptr;
    for (const Point& point : points_) {
      const double at = point.found.where.at[static_cast<Eigen::Index>(parameter)];
      const bool is_beyond = direction * (at - end) > kCoordinateRounding;
      if (is_beyond && point.root * point.root < kClearlyLower * rise &&
          (lowest == nullptr || point.root < lowest->root))
        lowest = &point;
    }
    return lowest == nullptr ? nullptr : &lowest->found;
  }

  Neighbour next() {
    ++tries_;
    distance_ = std::clamp(next_distance(), 0.0, most_);
    const auto after = place(distance_);
    const bool is_nearer_after =
        after != points_.end() && after->distance - distance_ < distance_ - (after - 1)->distance;
    const Minimum& near = is_nearer_after ? after->found : (after - 1)->found;
    Eigen::VectorXd to = near.where.at;
    to[static_cast<Eigen::Index>(parameter_)] = std::clamp(start() + direction_ * distance_, 0.0, 1.0);
    return {&near, {parameter_}, to};
  }

  void add(Minimum found) {
    if (found.objective < least_ - kLowerMinimum * options_->scale) {
      lower_ = std::move(found);
      finish(start() + direction_ * distance_);
      return;
    }
    const double root = root_of(found);
    points_.insert(points_.begin() + (place(distance_) - points_.cbegin()), {distance_, root, std::move(found)});
    settle();
  }

 private:
  using Place = std::vector<Point>::const_iterator;

  double at(const Point& point) const { return point.found.where.at[static_cast<Eigen::Index>(parameter_)]; }
  double root_of(const Minimum& found) const {
    const double growth = (found.objective - options_->from) / options_->scale;
    return std::isfinite(growth) ? std::sqrt(std::max(0.0, growth)) : 1e6;
  }
  double wanted() const { return std::sqrt(options_->rises[rise_]); }
  Place place(double distance) const {
    return std::ranges::find_if(points_, [&](const Point& point) { return point.distance > distance; });
  }
  Place above() const {
    return std::ranges::find_if(points_, [&](const Point& point) { return point.root >= wanted(); });
  }

  /// Ends the rises that are met, or cannot be.
  void settle() {
    for (; !is_done(); ++rise_, tries_ = 0) {
      const Place above = this->above();
      if (above == points_.cbegin()) continue;
      // A start just below a rise has not met it, and on the way down again it does not.
      const double least = std::min(wanted(), points_.front().root + kRootTolerance * wanted());
      const auto is_met = [&](const Point& p) {
        return p.root >= least && std::abs(p.root - wanted()) <= kRootTolerance * wanted();
      };
      const auto met = std::find_if(points_.cbegin() + 1, points_.cend(), is_met);
      if (met != points_.cend()) {
        ends_[rise_] = at(*met);
      } else if (above == points_.cend() && points_.back().distance >= most_) {
        finish(start() + direction_ * most_);
        return;
      } else if (tries_ >= kMostProfilePoints ||
                 (above != points_.cend() && above->distance - (above - 1)->distance < kLeastGap * above->distance)) {
        ends_[rise_] = at(above == points_.cend() ? points_.back() : *(above - 1));
      } else {
        return;
      }
    }
  }

  /// All rises that are left have this end.
  void finish(double end) {
    for (; !is_done(); ++rise_) ends_[rise_] = end;
  }

  /// The intersection of the wanted root with a straight line through the two points beside it, or the last two.
  double next_distance() const {
    const Place above = this->above();
    if (above != points_.end()) {
      const Point& below = *(above - 1);
      const double share = (wanted() - below.root) / (above->root - below.root);
      return std::lerp(below.distance, above->distance, tries_ > kProfileSecants ? 0.5 : std::clamp(share, 0.02, 0.98));
    }
    const Point& last = points_.back();
    if (points_.size() == 1) return first_distance();
    const Point& before = points_[points_.size() - 2];
    const double slope = (last.root - before.root) / (last.distance - before.distance);
    const double farthest = kMostGrowth * last.distance;
    return slope > 0.0 ? std::clamp(last.distance + (wanted() - last.root) / slope, 1.01 * last.distance, farthest)
                       : farthest;
  }

  /// The distance at which derivatives foretell the rise.
  double first_distance() const {
    const Point& first = points_.front();
    Neighbour probe{&first.found, {parameter_}, first.found.where.at};
    probe.to[static_cast<Eigen::Index>(parameter_)] += direction_ * kFirstProbe;
    const double squares = first.found.where.residuals.squaredNorm();
    const double growth = (foretell(probe, options_->scale).second - squares) / options_->scale;
    const double slope = std::sqrt(std::max(growth, 1e-12)) / kFirstProbe;
    return std::clamp((wanted() - first.root) / slope, 1e-6, 0.5);
  }

  std::size_t parameter_;
  int direction_;
  double most_;   ///< distance
  double least_;  ///< objective
  const ProfileOptions* options_;
  std::vector<Point> points_;  ///< by distance
  std::size_t rise_ = 0;
  int tries_ = 0;
  double distance_ = 0.0;
  std::array<std::optional<double>, 2> ends_;
  std::optional<Minimum> lower_;
};

/// A stretch with another one; those that meet become one.
void merge(std::vector<Stretch>& all, Stretch one) {
  std::erase_if(all, [&](const Stretch& other) {
    if (other.high < one.low || one.high < other.low) return false;
    one = {std::min(one.low, other.low), std::max(one.high, other.high)};
    return true;
  });
  all.insert(std::ranges::find_if(all, [&](const Stretch& other) { return other.low > one.low; }), one);
}

/// An end of what is known of a profile.
struct End {
  std::size_t parameter, rise;
  int direction;
  auto operator<=>(const End&) const = default;
};

class Profiler {
 public:
  Profiler(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options)
      : residuals_(residuals), options_(options), least_(minima.front().objective) {
    descent_.loss = options.loss;
    descent_.scale = options.scale;
    descent_.least_gain = kProfileGain;
    descent_.secant_below = options.from + kTrustedShare * options.rises[0] * options.scale;
    result_.stretches.resize(residuals.model().parameters().size());
    for (const Minimum& minimum : minima) {
      for (std::size_t j = 0; j < result_.stretches.size(); ++j) {
        const double at = minimum.where.at[static_cast<Eigen::Index>(j)];
        sides_.emplace_back(minimum, j, -1, at, least_, options_);
        sides_.emplace_back(minimum, j, 1, 1.0 - at, least_, options_);
      }
    }
  }

  Profiles run() {
    go(0);
    for (int round = 0; round < kMostLooks && !result_.lower && search_other_branches(); ++round) {
    }
    for (const Side& side : sides_) {
      for (const Point& point : side.points()) {
        if (point.root * point.root < kKeptRise * options_.rises[1]) result_.seen.push_back(point.found);
      }
    }
    return std::move(result_);
  }

 private:
  /// Completes the sides from a position on, which come in pairs from one start.
  void go(std::size_t first) {
    const auto is_done = [](const Side& side) { return side.is_done(); };
    for (;;) {
      std::vector<Neighbour> wanted;
      std::vector<std::size_t> askers;
      for (std::size_t i = first; i < sides_.size(); ++i) {
        if (sides_[i].is_done()) continue;
        askers.push_back(i);
        wanted.push_back(sides_[i].next());
      }
      if (options_.count)
        options_.count(static_cast<std::size_t>(std::ranges::count_if(sides_, is_done)), sides_.size());
      if (wanted.empty()) break;
      std::vector<Minimum> found = follow(residuals_, wanted, descent_);
      for (std::size_t k = 0; k < askers.size(); ++k) sides_[askers[k]].add(std::move(found[k]));
    }
    for (std::size_t i = first; i < sides_.size(); i += 2) {
      for (const Side* side : {&sides_[i], &sides_[i + 1]}) {
        if (!side->lower()) continue;
        if (!result_.lower || side->lower()->objective < result_.lower->objective) result_.lower = side->lower();
      }
      for (std::size_t rise = 0; rise < options_.rises.size(); ++rise) {
        if (!sides_[i].end(rise)) continue;
        merge(result_.stretches[sides_[i].parameter()][rise], {*sides_[i].end(rise), *sides_[i + 1].end(rise)});
      }
    }
  }

  double end_of(const End& end) const {
    const std::vector<Stretch>& all = result_.stretches[end.parameter][end.rise];
    return end.direction < 0 ? all.front().low : all.back().high;
  }

  /// Looks for other branches of the valley beyond ends that are new; true where there are some.
  bool search_other_branches() {
    std::vector<std::pair<End, double>> ends;
    std::vector<Neighbour> looks;
    std::vector<std::size_t> look_of;
    for (std::size_t j = 0; j < result_.stretches.size(); ++j) {
      for (std::size_t rise = 0; rise < options_.rises.size(); ++rise) {
        if (result_.stretches[j][rise].empty()) continue;  // the minimum lies above
        for (const int direction : {-1, 1}) {
          const End end{j, rise, direction};
          const double at = end_of(end);
          if (at < kCoordinateRounding || at > 1.0 - kCoordinateRounding || !looked_.insert({end, at}).second) continue;
          for (const Neighbour& one : looks_beyond(end)) {
            looks.push_back(one);
            look_of.push_back(ends.size());
          }
          ends.emplace_back(end, at);
        }
      }
    }
    const std::vector<Minimum> found = follow(residuals_, looks, descent_);
    const std::size_t first = sides_.size();
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const Minimum* best = nullptr;
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (look_of[i] == k && (best == nullptr || found[i].objective < best->objective)) best = &found[i];
      }
      const auto& [end, at] = ends[k];
      if (best == nullptr ||
          !(best->objective < options_.from + kClearlyLower * options_.rises[end.rise] * options_.scale))
        continue;
      const double start = best->where.at[static_cast<Eigen::Index>(end.parameter)];
      const auto most = [&](int direction) {
        return direction != end.direction ? std::abs(start - at) + kCoordinateRounding
               : direction < 0            ? start
                                          : 1.0 - start;
      };
      for (const int direction : {-1, 1}) {
        sides_.emplace_back(*best, end.parameter, direction, most(direction), least_, options_);
      }
    }
    go(first);
    return first < sides_.size();
  }

  /// The ends of other sides, moved beyond an end, but where a straight way leads to them; and points of theirs that
  /// lie beyond it and below the rise.
  std::vector<Neighbour> looks_beyond(const End& end) const {
    if (result_.stretches.size() == 1) return {};  // the profile of a single parameter has no other branch
    const auto index = static_cast<Eigen::Index>(end.parameter);
    const std::vector<Stretch>& all = result_.stretches[end.parameter][end.rise];
    const double width = std::min(1.0, all.back().high) - std::max(0.0, all.front().low);
    const double beyond = std::clamp(end_of(end) + end.direction * kBeyond * width, 0.0, 1.0);
    const Minimum* own = nullptr;
    std::vector<Neighbour> looks;
    const auto distance = [&](const Minimum& one) { return std::abs(one.where.at[index] - end_of(end)); };
    for (const Side& side : sides_) {
      const Minimum* const last = side.last_below(end.rise);
      if (last == nullptr) continue;
      if (own == nullptr || distance(*last) < distance(*own)) own = last;
      Neighbour one{last, {end.parameter}, last->where.at};
      one.to[index] = end.direction < 0 ? std::min(beyond, one.to[index]) : std::max(beyond, one.to[index]);
      looks.push_back(std::move(one));
    }
    std::erase_if(looks, [&](const Neighbour& one) {
      return one.near == own || is_straight(own->where, one.near->where, options_.scale);
    });
    for (const Side& side : sides_) {
      const Minimum* const one =
          side.lowest_beyond(end.parameter, end_of(end), end.direction, options_.rises[end.rise]);
      if (one != nullptr) looks.push_back({one, {end.parameter}, one->where.at});
    }
    return looks;
  }

  Residuals& residuals_;
  const ProfileOptions& options_;
  double least_;
  DescentOptions descent_;
  std::vector<Side> sides_;
  std::set<std::pair<End, double>> looked_;
  Profiles result_;
};

}  // namespace

Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options) {
  return Profiler(residuals, minima, options).run();
}

}  // namespace dolp::fit
