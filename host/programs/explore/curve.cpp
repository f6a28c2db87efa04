#include "explore/curve.hpp"

#include <algorithm>

namespace dolp::explore {
namespace {

constexpr const char* kCoarsePrefix = "coarse curve ";

}  // namespace

void Curve::follow(const std::string& key, const Scene& scene, bool keep_all) {
  key_ = key;
  scene_ = scene;
  keep_all_ = keep_all;
}

std::string Curve::key_of(Stage stage) const { return (stage == Stage::kCoarse ? kCoarsePrefix : "curve ") + key_; }

Job Curve::job(Stage stage) const {
  const bool is_coarse = stage == Stage::kCoarse;
  return {.key = key_of(stage),
          .scene = scene_,
          .parts = {points_at(scene_, zeniths(0.0, 90.0, is_coarse ? kCoarseCount : kFineCount))},
          .tolerance = is_coarse ? kCoarseTolerance : 0.0,
          .keep_all = keep_all_,
          .wants_effects = !is_coarse,
          .is_brief = is_coarse};
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
  if (is_fine) {
    report_ = {news.scene, news.effects, news.csv, news.wall_s, news.evaluations, news.points.size()};
  }
  return true;
}

void Curve::take_earlier(const JobPart& news) {
  if (!is_current() && news.key.starts_with(kCoarsePrefix)) show(news);
}

void Curve::show(const JobPart& news) {
  shown_ = news.key;
  shown_scene_ = news.scene;
  points_ = news.points;
}

double Curve::worst_error() const {
  double worst = 0.0;
  for (const Point& point : points_) {
    if (is_good(point)) worst = std::max(worst, point.error_estimate);
  }
  return worst;
}

}  // namespace dolp::explore
