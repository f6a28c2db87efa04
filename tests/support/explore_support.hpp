// For tests: a scene of paint, and a Session (state and commands of the window) that runs without a window.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "contains.hpp"
#include "explore/session.hpp"

namespace dolp::explore {

inline const std::string kPaint = R"(title = "Paint"
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "v-cavity"
specular = 0.97
diffuse = 0.03
[emission]
temperature_K = 290
[surroundings]
temperature_K = 240
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 60]
sigma = [0.1, 0.4]
[accuracy]
tolerance = 1e-3
)";

inline SceneEdits paint(const std::vector<std::string>& overrides = {}) {
  return SceneEdits(Scene::from_text(kPaint, settings_from_text(overrides), "paint.toml"));
}

inline Results on_the_cpu(const Scene& scene, const std::vector<Column>& points, const RunOptions& options = {}) {
  thread_local Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  return evaluator.evaluate(scene, points, options);
}

/// A session with its worker, which computes on the CPU.
class Driver : public Session {
 public:
  explicit Driver(SceneEdits edits, const View& view = {}) : Session(std::move(edits)), worker_(on_the_cpu, [] {}) {
    set_view(view);
    settle();
  }

  /// Does what the window does for each frame: takes results and requests new ones. Returns false if all is done.
  bool frame() {
    const bool was_idle = worker_.is_idle();
    take(worker_.take_news());
    const bool is_changed = take_changed();
    std::vector<Job> jobs = is_changed ? wanted() : std::vector<Job>{};
    if (was_idle && jobs.empty()) return false;
    if (is_changed) worker_.want(std::move(jobs));
    return true;
  }

  void settle() {
    while (frame()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  Worker worker_;
};

inline std::vector<Point> truth(const Scene& scene, const PointList& list) {
  return result_points(list, on_the_cpu(scene, list.columns()));
}

inline JobResult done(const Job& job) {
  const Scene scene = job.scene.with(job.settings);
  return {.key = job.key, .scene = scene, .list = job.list, .points = truth(scene, job.list)};
}

/// Compares a shown point with an accurate result for `scene` at this zenith.
inline void expect_agreement(const Point& shown, const Scene& scene, double theta_deg) {
  const Point exact = truth(scene, points_at(scene, {theta_deg})).front();
  if (std::isnan(shown[Quantity::kDolp]) || std::isnan(exact[Quantity::kDolp])) return;
  EXPECT_NEAR(shown[Quantity::kDolp], exact[Quantity::kDolp],
              shown[Quantity::kErrorEstimate] + exact[Quantity::kErrorEstimate])
      << surface_name(scene) << " at " << theta_deg;
}

inline void expect_same(const std::vector<Point>& a, const std::vector<Point>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i][Quantity::kDolp]) && std::isnan(b[i][Quantity::kDolp])) continue;
    for (const Quantity quantity : {Quantity::kDolp, Quantity::kErrorEstimate})
      EXPECT_EQ(a[i][quantity], b[i][quantity]) << i;
  }
}

}  // namespace dolp::explore
