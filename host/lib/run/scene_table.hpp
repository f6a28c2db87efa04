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

/// The quantities that results of a scene have. With a plan: without the quantities that a run by this plan leaves out,
/// which are NaN in results at points.
Quantities quantities_of(const SceneValues& scene, const EffectPlan* plan = nullptr);

/// The table of a grid of the scene before anything is computed, with the attributes that are known at that time.
/// `axes` may be a part of the scene's grid.
TableLayout table_layout(const SceneValues& scene, const EffectPlan& plan, const Axes& axes);

/// Sets the values of the table's curves at its wavelengths.
void fill_used(TableHead& head, const SceneValues& scene);

/// The attribute with all that a table's values follow from, except the device: names and values, see difference().
inline constexpr const char* kIdentity = "identity";
std::string identity_of(const SceneValues& scene, const std::string& evaluator, bool keep_all);

/// The values of a part of the grid.
TableValues table_part(const TableLayout& layout, const SceneEntries& part, const std::vector<PointResult>& results);

/// Record of a run in its table file.
struct RunRecord {
  EvaluationReport evaluation;
  std::string effects, rule;
  double model_change = 0.0;
  SelfCheck check;
  double wall_s = 0.0;

  std::vector<Attribute> attributes(const std::string& command_line) const;
};
std::vector<Attribute> attributes_of(const SceneValues& scene, const RunOutcome& run, const std::string& command_line);
/// The attribute "history".
std::string history_text(const std::string& command_line);

/// The rule in words, for reports and table attributes.
std::string rule_text(double tolerance, const EvaluationReport& evaluation);

}  // namespace dolp
