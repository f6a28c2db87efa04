#include "explore/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/text.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kStride = 10;  // true_error() checks every tenth point of a fine curve: a point every 5 degrees

double point_dolp(const Point& point) { return point[Quantity::kDolp]; }

double upper_dolp(const Point& point) { return point_dolp(point) + point[Quantity::kErrorEstimate]; }

struct Removal {
  const char* effect;
  bool radiates;
  std::vector<Setting> changes;  ///< settings that remove the effect from a scene

  bool is_in(const Scene& scene) const {
    const std::string& key = changes.front().key;
    const bool is_table = key.find('.') == std::string::npos;
    if (is_table) return has_effect(scene, key);
    if (described(key).type == Key::Type::kNumber) return scene.number(key) > 0.0;
    return scene.word(key) && *scene.word(key) != plain_text(changes.front().value);
  }
};

const std::vector<Removal>& removals() {
  static const std::vector<Removal> all = {
      {"emission", true, {{"emission", {}}}},
      {"source", true, {{"source", {}}}},
      {"surroundings", true, {{"surroundings", {}}}},
      {"path", false, {{"path", {}}}},
      {"diffuse", false, {{"surface.diffuse", 0.0}}},
      {"specular", false, {{"surface.specular", 0.0}}},
      {"masking", false, {{"surface.masking", "none"}}},
      {"scattering", false, {{"surface.scattering", "single"}}},
      {"roughness", false, {{"surface.sigma", 0.0}, {kSigmaCross, Value()}, {"grid.sigma_cross", Value()}}},
  };
  return all;
}

std::vector<WithoutEffect> without_each(const Scene& scene) {
  std::vector<WithoutEffect> without;
  for (const Removal& removal : removals()) {
    if (!removal.is_in(scene)) continue;
    try {
      without.push_back({removal.effect, removal.radiates, scene.with(removal.changes)});
    } catch (const InputError&) {
      // The scene is invalid without this effect, for example if nothing else radiates. So the list lacks it.
    }
  }
  return without;
}

/// The point at the peak (see PeakAnswer), or end() if no point is good.
std::vector<Point>::const_iterator dolp_peak(const std::vector<Point>& points) {
  const auto rank = [](const Point& point) {
    return std::tuple(point.is_trusted(), point.is_good(), point.is_good() ? point_dolp(point) : 0.0);
  };
  const auto best = std::ranges::max_element(points, {}, rank);
  return best == points.end() || best->is_good() ? best : points.end();
}

}  // namespace

void Curve::follow(const std::string& key, const Scene& scene, bool keep_all) {
  if (key != key_) peak_.reset();
  key_ = key;
  scene_ = scene;
  keep_all_ = keep_all;
}

std::optional<Job> Curve::wanted(Stage stage) const {
  if (key_.empty() || is_finished() || shown_.key == job_key(stage)) return std::nullopt;
  const bool is_coarse = stage == Stage::kCoarse;
  return Job{.key = job_key(stage),
             .scene = scene_,
             .list = points_at(scene_, Scale{0.0, 90.0}.values(is_coarse ? kCoarseCount : kFineCount)),
             .tolerance = is_coarse ? kCoarseTolerance : 0.0,
             .keep_all = keep_all_,
             .wants_effects = !is_coarse,
             .is_brief = is_coarse};
}

bool Curve::take(const JobResult& news) {
  const bool is_fine = news.key == job_key(Stage::kFine);
  if (!is_fine && news.key != job_key(Stage::kCoarse)) return false;
  if (is_fine) finished_ = news;
  if (is_fine || !is_finished()) shown_ = news;
  return true;
}

bool Curve::take_earlier(const JobResult& news) {
  if (!news.key.starts_with(key_prefix(Stage::kCoarse))) return false;
  if (!is_current()) shown_ = news;
  return true;
}

std::vector<Point> Curve::drawn() const {
  std::vector<Point> all = points();
  if (!peak_ || !is_finished()) return all;
  const auto next = std::ranges::lower_bound(all, peak_->theta_deg, {}, &Point::theta_deg);
  if (next == all.end() || next->theta_deg != peak_->theta_deg) all.insert(next, *peak_);
  return all;
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
    const double error = std::abs(point_dolp(stated[i]) - truth[Quantity::kDolp][i]);
    if (!stated[i].is_good() || !(error > largest)) continue;
    largest = error;
    worst = &stated[i];
  }
  if (!worst) return "no direction has a DOLP with a meaning";
  return fmt::format("{:.1e} at θ = {:g}°, bound {:.1e}; {} directions", largest, worst->theta_deg,
                     (*worst)[Quantity::kErrorEstimate], stated.size());
}

void Peak::follow(const Curve& curve, double theta_max_deg) {
  const std::string key = "up to " + format_number(theta_max_deg) + ' ' + curve.key();
  if (key == key_) return;
  key_ = key;
  scene_ = curve.scene();
  theta_deg_.clear();
  answer_.reset();
  without_.clear();
  curve_ = curve.points();
  std::erase_if(curve_, [&](const Point& point) { return point.theta_deg > theta_max_deg; });
  const auto best = dolp_peak(curve_);
  if (best == curve_.end()) return;
  const double low = (best == curve_.begin() ? best : best - 1)->theta_deg;
  const double high = (best + 1 == curve_.end() ? best : best + 1)->theta_deg;
  theta_deg_ = Scale{low, high}.values(static_cast<std::size_t>(std::lround((high - low) / kStepDeg)) + 1);
  without_ = without_each(scene_);
}

std::vector<Job> Peak::wanted() const {
  std::vector<Job> jobs;
  if (theta_deg_.empty()) return jobs;
  if (!answer_) {
    jobs.push_back({.key = "peak " + key_, .scene = scene_, .list = points_at(scene_, theta_deg_)});
    return jobs;
  }
  for (const WithoutEffect& removed : without_) {
    if (removed.at_cursor) continue;
    jobs.push_back({.key = job_key(removed),
                    .scene = removed.scene,
                    .list = points_at(removed.scene, {cursor_.theta_deg, answer_->at.theta_deg})});
  }
  return jobs;
}

bool Peak::take(const JobResult& news) {
  if (news.key == "peak " + key_) {
    answer_from(news.points);
    return true;
  }
  const auto has_key = [&](const WithoutEffect& without) { return news.key == job_key(without); };
  const auto removed = std::ranges::find_if(without_, has_key);
  if (removed == without_.end()) return false;
  removed->at_cursor = news.points.front();
  removed->at_peak = news.points.back();
  return true;
}

void Peak::answer_from(const std::vector<Point>& points) {
  const auto best = dolp_peak(points);
  if (best == points.end()) return theta_deg_.clear();
  const double least = point_dolp(*best) - (*best)[Quantity::kErrorEstimate];
  const auto counts = [&](const Point& point) { return best->is_trusted() ? point.is_trusted() : point.is_good(); };
  const auto may_be_largest = [&](const Point& point) { return counts(point) && upper_dolp(point) >= least; };
  auto first = best;
  auto last = best;
  while (first != points.begin() && may_be_largest(*(first - 1))) --first;
  while (last + 1 != points.end() && may_be_largest(*(last + 1))) ++last;
  const auto is_rival = [&](const Point& point) {
    const bool is_beside = point.theta_deg >= theta_deg_.front() && point.theta_deg <= theta_deg_.back();
    return !is_beside && may_be_largest(point);
  };
  answer_ = PeakAnswer{*best, first->theta_deg, last->theta_deg};
  answer_->is_at_end = best + 1 == points.end() || !counts(*(best + 1));
  const auto rival = std::ranges::find_if(curve_, is_rival);
  if (rival != curve_.end()) answer_->rival_deg = rival->theta_deg;
}

void Peak::set_cursor(const Point& at) {
  const bool is_moved = std::exchange(cursor_, at).theta_deg != at.theta_deg;
  if (!is_moved) return;
  for (WithoutEffect& removed : without_) removed.at_cursor.reset();
}

std::string Peak::job_key(const WithoutEffect& removed) const {
  return fmt::format("without {} at {} {}", removed.effect, cursor_.theta_deg, key_);
}

}  // namespace dolp::explore
