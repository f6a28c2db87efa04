// What `dolp plan` reports: for people, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "effects/effects.hpp"
#include "evaluate/run/prediction.hpp"
#include "evaluate/vulkan/dispatch_plan.hpp"
#include "scene/scene.hpp"

namespace dolp::cli {

/// The kernel's rule and pipelines of the first attempt.
struct KernelPlan {
  double digits = 0.0;
  int most_slope_nodes = 0;    ///< of a piece of the slope axis
  int most_azimuth_nodes = 0;  ///< of an arc
  std::vector<std::string> pipelines;
};

/// Everything that there is to say about a run that has not happened.
struct PlanReport {
  Scene scene;
  EffectPlan plan;
  std::vector<EffectRow> effects;
  std::vector<double> work_shares;  ///< of each effect: evaluations that would go with it, 0 to 1
  RunPrediction run;
  std::optional<KernelPlan> kernel;  ///< none when nothing is integrated
  DispatchPlan dispatches;           ///< of the first attempt
  std::string device;                ///< its name; empty without one
  std::string why_no_device;
};

std::string plan_text(const PlanReport& report);
nlohmann::ordered_json plan_json(const PlanReport& report);

}  // namespace dolp::cli
