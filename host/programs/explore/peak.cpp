#include "explore/peak.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

constexpr std::array kAway = {
    WithoutEffect{"emission", "emission=none", true},
    WithoutEffect{"source", "source=none", true},
    WithoutEffect{"surroundings", "surroundings=none", true},
    WithoutEffect{"path", "path=none", false},
    WithoutEffect{"diffuse", "surface.diffuse=0", false},
    WithoutEffect{"specular", "surface.specular=0", false},
    WithoutEffect{"masking", "surface.masking=none", false},
    WithoutEffect{"scattering", "surface.scattering=single", false},
    WithoutEffect{"roughness", "surface.sigma=0", false},
};

bool has(const Scene& scene, const WithoutEffect& away) {
  const std::string name = away.effect;
  if (name == "emission") return scene.number("emission.temperature_K").has_value();
  if (name == "source") return scene.number("source.scale").has_value();
  if (name == "surroundings") return scene.number("surroundings.temperature_K").has_value();
  if (name == "path") return scene.number("path.transmittance").has_value();
  if (name == "diffuse") return scene.number("surface.diffuse") > 0.0;
  if (name == "specular") return scene.number("surface.specular") > 0.0;
  if (name == "masking") return scene.word("surface.masking") != "none";
  if (name == "scattering") return scene.word("surface.scattering") == "multiple";
  return scene.number("surface.sigma") > 0.0;
}

std::size_t position_of_largest(const std::vector<Point>& points) {
  std::size_t best = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_good(points[i]) && (best == points.size() || points[i].dolp > points[best].dolp)) best = i;
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
  scenes_without_.clear();
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
  for (const WithoutEffect& away : kAway) {
    if (!has(scene_, away)) continue;
    try {
      scenes_without_.push_back(edits.scene().with({Setting::from_text(away.change)}));
      without_.push_back(away);
    } catch (const InputError&) {
      // Nothing else radiates, the source is relative to the emission, or the emission needs the masking.
    }
  }
}

std::string Peak::key_of(const WithoutEffect& of) const { return std::string("without ") + of.change + ' ' + key_; }

std::vector<Job> Peak::wanted() const {
  std::vector<Job> jobs;
  if (theta_deg_.empty()) return jobs;
  if (!answer_) {
    jobs.push_back({.key = "peak " + key_, .scene = scene_, .parts = {points_at(scene_, theta_deg_)}});
    return jobs;
  }
  for (std::size_t i = 0; i < without_.size(); ++i) {
    if (without_[i].is_known) continue;
    const Scene& scene = scenes_without_[i];
    jobs.push_back({.key = key_of(without_[i]), .scene = scene, .parts = {points_at(scene, {answer_->theta_deg})}});
  }
  return jobs;
}

bool Peak::take(const JobPart& news) {
  if (news.key == "peak " + key_) {
    answer_from(news.points);
    return true;
  }
  for (WithoutEffect& without : without_) {
    if (news.key != key_of(without)) continue;
    without.result = news.points.front();
    without.is_known = true;
    return true;
  }
  return false;
}

void Peak::answer_from(const std::vector<Point>& points) {
  const std::size_t best = position_of_largest(points);
  if (best == points.size()) {
    theta_deg_.clear();
    return;
  }
  at_peak_ = points[best];
  PeakAnswer answer;
  answer.theta_deg = theta_deg_[best];
  answer.dolp = at_peak_.dolp;
  answer.q_over_i = at_peak_.stokes_q / at_peak_.stokes_i;
  answer.error = at_peak_.error_estimate;
  answer.albedo = at_peak_.albedo;
  const double least = at_peak_.dolp - at_peak_.error_estimate;
  const auto may_be_largest = [&](std::size_t i) {
    return is_good(points[i]) && points[i].dolp + points[i].error_estimate >= least;
  };
  std::size_t first = best;
  std::size_t last = best;
  while (first > 0 && may_be_largest(first - 1)) --first;
  while (last + 1 < points.size() && may_be_largest(last + 1)) ++last;
  answer.rival_deg = rival(least);
  answer.theta_low_deg = theta_deg_[first];
  answer.theta_high_deg = theta_deg_[last];
  answer.is_at_end = best + 1 == points.size() || (best + 1 < points.size() && !is_good(points[best + 1]));
  answer_ = answer;
}

std::optional<double> Peak::rival(double least) const {
  for (const Point& point : curve_) {
    const bool is_beside = point.theta_deg >= theta_deg_.front() && point.theta_deg <= theta_deg_.back();
    if (!is_beside && is_good(point) && point.dolp + point.error_estimate >= least) return point.theta_deg;
  }
  return std::nullopt;
}

bool Peak::is_complete() const {
  return answer_ && std::ranges::all_of(without_, [](const WithoutEffect& away) { return away.is_known; });
}

double Peak::contribution(const WithoutEffect& of) const {
  return (at_peak_.stokes_q - of.result.stokes_q) / at_peak_.stokes_i;
}

}  // namespace dolp::explore
