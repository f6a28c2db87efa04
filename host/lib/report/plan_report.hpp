// Report on a planned run that has not started.
#pragma once

#include <string>
#include <vector>

#include "plan/effects.hpp"
#include "report/report.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The report of a run of `plan` over the scene's grid. `device`: a position or a part of a name; empty is the default
/// device, or the limits that every device keeps where there is none.
/// Errors: InputError of grid_entries; DeviceError where a named device is not usable.
ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan plan);

/// "91 x 32 x 5 (theta x sigma x q)"; an axis that the grid lacks is left out.
std::string grid_text(const Axes& grid);

/// Names and reasons of the effects that are kept, dropped, not needed and absent.
ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
