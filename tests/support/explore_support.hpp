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

inline Evaluate on_the_cpu(Evaluator& evaluator) {
  return [&evaluator](const Scene& scene, const PointList& list, const RunOptions& options) {
    return evaluate(evaluator, scene, list, options);
  };
}

/// A session and its worker, which computes on the CPU.
class Driver {
 public:
  explicit Driver(SceneEdits edits, const View& view = {})
      : session(std::move(edits)), worker_(on_the_cpu(evaluator_), [] {}) {
    session.set_view(view);
    settle();
  }

  /// Does what the window does for each frame: takes results and requests new ones. Returns false if all is done.
  bool frame() {
    const bool was_idle = worker_.is_idle();
    session.take(worker_.take_news());
    const bool is_changed = session.take_changed();
    std::vector<Job> jobs = is_changed ? session.wanted() : std::vector<Job>{};
    if (was_idle && jobs.empty()) return false;
    if (is_changed) worker_.want(std::move(jobs));
    return true;
  }

  void settle() {
    while (frame()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  Session session;

 private:
  Evaluator evaluator_{EvaluatorOptions{.evaluator = "cpu"}};
  Worker worker_;
};

inline std::vector<Point> truth(const Scene& scene, const PointList& list) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  return result_points(list, evaluator.evaluate(scene, list.columns()));
}

/// Accurate results of the scene at the zeniths of `points`.
inline std::vector<Point> truth(const Scene& scene, const std::vector<Point>& points) {
  std::vector<double> theta_deg;
  for (const Point& point : points) theta_deg.push_back(point.theta_deg);
  return truth(scene, points_at(scene, theta_deg));
}

/// The result of a job that has only one part.
inline JobPart done(const Job& job) {
  return {.key = job.key, .scene = job.scene, .points = truth(job.scene, job.parts.front()), .is_last = true};
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
