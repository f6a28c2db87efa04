#include "explore/peak.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

/// A part of a scene that can be taken away.
struct Removal {
  const char* effect;
  Setting change;  ///< takes it away
  bool radiates;
  bool (*is_in)(const Scene& scene);
};

const std::vector<Removal>& removals() {
  using S = const Scene&;
  static const std::vector<Removal> all = {
      {"emission", {"emission", {}}, true, [](S s) { return s.number("emission.temperature_K").has_value(); }},
      {"source", {"source", {}}, true, [](S s) { return s.number("source.scale").has_value(); }},
      {"surroundings",
       {"surroundings", {}},
       true,
       [](S s) { return s.number("surroundings.temperature_K") || s.word("surroundings.profile"); }},
      {"path", {"path", {}}, false, [](S s) { return s.number("path.transmittance").has_value(); }},
      {"diffuse", {"surface.diffuse", 0.0}, false, [](S s) { return s.number("surface.diffuse") > 0.0; }},
      {"specular", {"surface.specular", 0.0}, false, [](S s) { return s.number("surface.specular") > 0.0; }},
      {"masking", {"surface.masking", "none"}, false, [](S s) { return s.word("surface.masking") != "none"; }},
      {"scattering",
       {"surface.scattering", "single"},
       false,
       [](S s) { return s.word("surface.scattering") == "multiple"; }},
      {"roughness", {"surface.sigma", 0.0}, false, [](S s) { return s.number("surface.sigma") > 0.0; }},
  };
  return all;
}

double dolp_of(const Point& point) { return point[Quantity::kDolp]; }

/// The largest DOLP, with its error, that the point may have.
double most_of(const Point& point) { return dolp_of(point) + point[Quantity::kErrorEstimate]; }

std::size_t position_of_largest(const std::vector<Point>& points) {
  std::size_t best = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].is_good() && (best == points.size() || dolp_of(points[i]) > dolp_of(points[best]))) best = i;
  }
  return best;
}

}  // namespace

void Peak::follow(const Curve& curve, const SceneEdits& edits, double theta_max_deg) {
  const std::string key = "up to " + format_number(theta_max_deg) + ' ' + curve.key();
  if (key == key_) return;
  key_ = key;
  scene_ = curve.scene();
  theta_deg_.clear();
  answer_.reset();
  without_.clear();
  curve_ = curve.points();
  std::erase_if(curve_, [&](const Point& point) { return point.theta_deg > theta_max_deg; });
  const std::size_t best = position_of_largest(curve_);
  if (best == curve_.size()) return;
  const double low = curve_[best == 0 ? 0 : best - 1].theta_deg;
  const double high = curve_[std::min(best + 1, curve_.size() - 1)].theta_deg;
  theta_deg_ = zeniths(low, high, static_cast<std::size_t>(std::lround((high - low) / kStepDeg)) + 1);
  take_away(edits);
}

void Peak::take_away(const SceneEdits& edits) {
  for (const Removal& one : removals()) {
    if (!one.is_in(scene_)) continue;
    try {
      without_.push_back({one.effect, one.radiates, edits.scene().with({one.change})});
    } catch (const InputError&) {
      // Nothing else radiates, the source is relative to the emission, or the emission needs the masking.
    }
  }
}

std::vector<Job> Peak::wanted() const {
  std::vector<Job> jobs;
  if (theta_deg_.empty()) return jobs;
  if (!answer_) {
    jobs.push_back({.key = "peak " + key_, .scene = scene_, .parts = {points_at(scene_, theta_deg_)}});
    return jobs;
  }
  for (const WithoutEffect& of : without_) {
    if (of.result) continue;
    jobs.push_back({.key = key_of(of), .scene = of.scene, .parts = {points_at(of.scene, {answer_->at.theta_deg})}});
  }
  return jobs;
}

bool Peak::take(const JobPart& news) {
  if (news.key == "peak " + key_) {
    answer_from(news.points);
    return true;
  }
  const auto own = std::ranges::find_if(without_, [&](const WithoutEffect& of) { return news.key == key_of(of); });
  if (own == without_.end()) return false;
  own->result = news.points.front();
  return true;
}

void Peak::answer_from(const std::vector<Point>& points) {
  const std::size_t best = position_of_largest(points);
  if (best == points.size()) {
    theta_deg_.clear();
    return;
  }
  const Point& at = points[best];
  const double least = dolp_of(at) - at[Quantity::kErrorEstimate];
  const auto may_be_largest = [&](std::size_t i) { return points[i].is_good() && most_of(points[i]) >= least; };
  std::size_t first = best;
  std::size_t last = best;
  while (first > 0 && may_be_largest(first - 1)) --first;
  while (last + 1 < points.size() && may_be_largest(last + 1)) ++last;
  const bool is_at_end = best + 1 == points.size() || !points[best + 1].is_good();
  answer_ = PeakAnswer{at, theta_deg_[first], theta_deg_[last], rival(least), is_at_end};
}

std::optional<double> Peak::rival(double least) const {
  for (const Point& point : curve_) {
    const bool is_beside = point.theta_deg >= theta_deg_.front() && point.theta_deg <= theta_deg_.back();
    if (!is_beside && point.is_good() && most_of(point) >= least) return point.theta_deg;
  }
  return std::nullopt;
}

bool Peak::is_complete() const {
  return answer_ && std::ranges::all_of(without_, [](const WithoutEffect& away) { return away.result.has_value(); });
}

double Peak::contribution(const WithoutEffect& of) const {
  const Point& at = answer_->at;
  return (at[Quantity::kStokesQ] - (*of.result)[Quantity::kStokesQ]) / at[Quantity::kStokesI];
}

}  // namespace dolp::explore
