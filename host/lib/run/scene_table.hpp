// Layout, values and attributes of a scene's table.
#pragma once

#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// The attribute with the largest PointResult::model_change of a table.
inline constexpr const char* kModelChange = "model_change";

/// The quantities that results of a scene have: of points, where those that a run leaves out are NaN; of a table that a
/// run by `plan` makes, without these.
Quantities quantities_of(const SceneValues& scene, const EffectPlan* plan = nullptr);

/// The table of a grid of the scene before anything is computed, with the attributes that are known at that time.
/// `axes` may be a part of the scene's grid.
TableLayout table_layout(const SceneValues& scene, const EffectPlan& plan, const Axes& axes);

/// Sets n, k and E0 as they are used at the table's wavelengths, of those that it has.
void fill_used(TableHead& head, const SceneValues& scene);

/// The attribute of a table for what its values follow from, but for the device: names and values, see difference().
inline constexpr const char* kIdentity = "identity";
std::string identity_of(const SceneValues& scene, const std::string& evaluator, bool keep_all);

/// The values of a part of the grid.
TableValues table_part(const TableLayout& layout, const SceneEntries& part, const std::vector<PointResult>& results);

std::string history_text(const std::string& command_line);
/// The attributes that are known after a run.
std::vector<Attribute> attributes_of(const SceneValues& scene, const RunOutcome& run, const std::string& command_line);

/// The rule in words, for reports and table attributes.
std::string rule_text(double tolerance, const EvaluationReport& evaluation);

}  // namespace dolp
