// Report on a planned run that has not started: for people, and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/vulkan/tiles.hpp"
#include "plan/effects.hpp"
#include "report/report.hpp"
#include "run/estimates.hpp"
#include "run/lookup_forecast.hpp"
#include "run/prediction.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The rule of the moments in the first attempt.
struct RuleSize {
  double digits = 0.0;
  int most_nodes = 0;  ///< of a piece of the slope axis or an arc of azimuth
};

/// All information about a planned run that has not started.
struct PlanReport {
  SceneValues scene;
  EffectPlan plan;
  std::vector<Effect> effects;
  Looked looked;              ///< by the influences
  double model_change = 0.0;  ///< estimated_model_change
  RunPrediction run;
  std::optional<RuleSize> rule;        ///< none without moments
  std::vector<std::string> pipelines;  ///< of the first attempt; none when nothing is left for the evaluator
  vulkan::DispatchCount dispatches;    ///< of the first attempt
  std::vector<AxisForecast> lookup;    ///< of the axes of more than one value
  std::string device;                  ///< its name; empty without one
  std::string why_no_device;
};

/// The plan report of a run of `plan` over the scene's grid. `device`: a position or a part of a name; empty is the
/// default device, or the limits that every device keeps where there is none.
/// Errors: InputError of grid_entries; DeviceError where a named device is not usable.
PlanReport plan_of(const SceneValues& scene, const std::string& device, EffectPlan plan);

ReportBuilder plan_report(const PlanReport& plan);

/// "91 x 32 x 5 (theta x sigma x q)"; an axis that the grid lacks is left out.
std::string grid_text(const Axes& grid);

/// Names and reasons of what is kept, dropped, not needed and absent.
ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
