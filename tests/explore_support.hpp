// A scene, and a session that a worker on the CPU serves.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "explore/session.hpp"
#include "explore/worker.hpp"
#include "run/scene_run.hpp"

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

inline SceneEdits paint(const std::vector<std::string>& overrides = {}) { return {kPaint, "paint.toml", overrides}; }

/// A session with a worker on the CPU.
class Driver {
 public:
  explicit Driver(SceneEdits edits) : session(std::move(edits)), worker_(evaluator_, [] {}) { settle(); }

  void settle() {
    for (;;) {
      const bool was_idle = worker_.is_idle();
      session.take(worker_.take_news());
      const bool is_changed = session.take_changed();
      std::vector<Job> jobs = is_changed ? session.wanted() : std::vector<Job>{};
      if (was_idle && jobs.empty()) return;
      if (is_changed) worker_.want(std::move(jobs));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Session session;

 private:
  CpuEvaluator evaluator_{Precision::kAuto};
  Worker worker_;
};

inline std::vector<PointResult> truth(const Scene& scene, const SceneEntries& entries) {
  CpuEvaluator evaluator(Precision::kAuto);
  return evaluate_scene(scene, entries, plan_effects(scene, entries, false), &evaluator, {});
}

/// What a worker would say of a job.
inline JobPart done(const Job& job) {
  JobPart part;
  part.key = job.key;
  part.scene = job.scene;
  part.entries = job.entries;
  part.results = truth(job.scene, job.entries);
  part.is_last = true;
  return part;
}

inline void expect_same(const std::vector<PointResult>& a, const std::vector<PointResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i].dolp) && std::isnan(b[i].dolp)) continue;
    EXPECT_EQ(a[i].dolp, b[i].dolp) << i;
    EXPECT_EQ(a[i].error_estimate, b[i].error_estimate) << i;
  }
}

}  // namespace dolp::explore
