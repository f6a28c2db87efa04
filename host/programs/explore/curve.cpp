#include "explore/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dolp::explore {
namespace {

constexpr std::size_t kStride = 10;  // of the points that the reference recomputes: five degrees

}  // namespace

void Curve::follow(const std::string& key, const Scene& scene, bool keep_all) {
  if (key != key_) peak_.reset();
  key_ = key;
  scene_ = scene;
  keep_all_ = keep_all;
}

std::optional<Job> Curve::wanted(Stage stage) const {
  if (key_.empty() || is_finished() || shown_.key == key_of(stage)) return std::nullopt;
  const bool is_coarse = stage == Stage::kCoarse;
  return Job{.key = key_of(stage),
             .scene = scene_,
             .parts = {points_at(scene_, zeniths(0.0, 90.0, is_coarse ? kCoarseCount : kFineCount))},
             .tolerance = is_coarse ? kCoarseTolerance : 0.0,
             .keep_all = keep_all_,
             .wants_effects = !is_coarse,
             .is_brief = is_coarse};
}

bool Curve::take(const JobPart& news) {
  const bool is_fine = news.key == key_of(Stage::kFine);
  if (!is_fine && news.key != key_of(Stage::kCoarse)) return false;
  if (!is_fine && is_finished()) return true;
  shown_ = news;
  if (is_fine) finished_ = news;
  return true;
}

bool Curve::take_earlier(const JobPart& news) {
  if (!news.key.starts_with(prefix_of(Stage::kCoarse))) return false;
  if (!is_current()) shown_ = news;
  return true;
}

std::vector<Point> Curve::drawn() const {
  std::vector<Point> all = points();
  if (!peak_ || !is_finished()) return all;
  const auto place = std::ranges::lower_bound(all, peak_->theta_deg, {}, &Point::theta_deg);
  if (place == all.end() || place->theta_deg != peak_->theta_deg) all.insert(place, *peak_);
  return all;
}

double Curve::worst_error() const {
  double worst = 0.0;
  for (const Point& point : points()) {
    if (point.is_good()) worst = std::max(worst, point[Quantity::kErrorEstimate]);
  }
  return worst;
}

std::string true_error(const Curve& curve, const Progress& progress) {
  std::vector<Point> stated;
  std::vector<double> theta_deg;
  for (std::size_t i = 0; i < curve.points().size(); i += kStride) {
    stated.push_back(curve.points()[i]);
    theta_deg.push_back(stated.back().theta_deg);
  }
  Evaluator reference(EvaluatorOptions{.evaluator = "reference"});
  const PointList list = points_at(curve.scene(), theta_deg);
  const Results truth = reference.evaluate(curve.scene(), list.columns(), {.keep_all = true, .progress = progress});
  const Point* worst = nullptr;
  double largest = -1.0;
  for (std::size_t i = 0; i < stated.size(); ++i) {
    const double error = std::abs(stated[i][Quantity::kDolp] - truth[Quantity::kDolp][i]);
    if (!stated[i].is_good() || !(error > largest)) continue;
    largest = error;
    worst = &stated[i];
  }
  if (!worst) return "no direction whose DOLP means something";
  return fmt::format("{:.1e} at θ = {:g}°, bound {:.1e}; {} directions", largest, worst->theta_deg,
                     (*worst)[Quantity::kErrorEstimate], stated.size());
}

}  // namespace dolp::explore
