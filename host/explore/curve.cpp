#include "explore/curve.hpp"

#include <algorithm>
#include <cmath>

#include "model/status.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kCoarsePrefix = "coarse curve ";

}  // namespace

std::vector<double> zeniths(double from_deg, double to_deg, std::size_t count) {
  std::vector<double> theta_deg(count, from_deg);
  const double last = static_cast<double>(count - 1);
  for (std::size_t i = 1; i < count; ++i) {
    const double done = static_cast<double>(i);
    theta_deg[i] = ((last - done) * from_deg + done * to_deg) / last;
  }
  return theta_deg;
}

SceneEntries entries_at(const Scene& scene, const std::vector<double>& theta_deg) {
  return SceneEntries::grid(theta_deg, {scene.surface.sigma}, {scene.surface.q});
}

bool is_good(const PointResult& result) { return promises_dolp(result.status) && std::isfinite(result.dolp); }

bool has_bracket(const PointResult& result) {
  return std::isfinite(result.dolp_low) && std::isfinite(result.dolp_high);
}

void Curve::follow(const std::string& key, const Scene& scene, bool keep_all) {
  key_ = key;
  scene_ = scene;
  keep_all_ = keep_all;
}

std::string Curve::key_of(Stage stage) const { return (stage == Stage::kCoarse ? kCoarsePrefix : "curve ") + key_; }

Job Curve::job(Stage stage) const {
  const bool is_coarse = stage == Stage::kCoarse;
  Job job;
  job.key = key_of(stage);
  job.scene = scene_;
  if (is_coarse) job.scene.accuracy.tolerance = std::max(kCoarseTolerance, scene_.accuracy.tolerance);
  job.entries = entries_at(scene_, zeniths(0.0, 90.0, is_coarse ? kCoarseCount : kFineCount));
  job.keep_all = keep_all_;
  job.wants_rows = !is_coarse;
  job.is_brief = is_coarse;
  return job;
}

std::optional<Job> Curve::wanted(Stage stage) const {
  if (key_.empty() || is_finished() || shown_ == key_of(stage)) return std::nullopt;
  return job(stage);
}

bool Curve::take(const JobPart& news) {
  const bool is_fine = news.key == key_of(Stage::kFine);
  if (!is_fine && news.key != key_of(Stage::kCoarse)) return false;
  if (!is_fine && is_finished()) return true;
  show(news);
  if (is_fine) report_ = {news.scene, news.rows, news.wall_s, news.evaluations, news.entries.size()};
  return true;
}

void Curve::take_earlier(const JobPart& news) {
  if (!is_current() && news.key.starts_with(kCoarsePrefix)) show(news);
}

void Curve::show(const JobPart& news) {
  shown_ = news.key;
  shown_scene_ = news.scene;
  entries_ = news.entries;
  results_ = news.results;
}

double Curve::worst_error() const {
  double worst = 0.0;
  for (const PointResult& result : results_) {
    if (is_good(result)) worst = std::max(worst, result.error_estimate);
  }
  return worst;
}

}  // namespace dolp::explore
