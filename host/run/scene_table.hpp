// The table of a scene, for whoever writes it.
#pragma once

#include <string>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "model/point_result.hpp"
#include "plan/effects.hpp"
#include "run/self_check.hpp"
#include "scene/scene.hpp"
#include "table/result_csv.hpp"
#include "table/table.hpp"

namespace dolp {

/// A run over the grid of a scene.
struct TableContent {
  const Scene& scene;
  const std::vector<PointResult>& results;  ///< of grid_entries, in their order
  const EffectPlan& plan;
  const std::vector<EffectRow>& effects;  ///< effect_rows of the run
  EvaluationReport evaluation;
  SelfCheck check;
  double wall_s = 0.0;
  std::string command_line;  ///< for the history
};

/// The columns that a scene's results have beside those of every scene.
ExtraColumns extra_columns(const Scene& scene);

/// The table with all attributes, as `dolp table` and the window write it.
Table scene_table(const TableContent& content);

/// The rule in words, for reports and table attributes.
std::string rule_text(double tolerance, const EvaluationReport& evaluation);

}  // namespace dolp
