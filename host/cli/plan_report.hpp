// What `dolp plan` reports: for people, and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/report.hpp"
#include "evaluate/vulkan/dispatch_forecast.hpp"
#include "plan/effects.hpp"
#include "run/prediction.hpp"
#include "scene/scene.hpp"

namespace dolp::cli {

/// The rule of the moments in the first attempt.
struct RuleSize {
  double digits = 0.0;
  int most_nodes = 0;  ///< of a piece of the slope axis or an arc of azimuth
};

/// Everything that there is to say about a run that has not happened.
struct PlanReport {
  Scene scene;
  EffectPlan plan;
  std::vector<EffectRow> effects;
  std::vector<double> work_shares;  ///< of each effect: evaluations and f that would go with it, 0 to 1
  RunPrediction run;
  std::optional<RuleSize> rule;        ///< none without moments
  std::vector<std::string> pipelines;  ///< of the first attempt; none when nothing is left for the evaluator
  DispatchForecast dispatches;         ///< likewise
  std::string device;                  ///< its name; empty without one
  std::string why_no_device;
};

Report plan_report(const PlanReport& plan);

}  // namespace dolp::cli
