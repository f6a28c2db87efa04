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

inline constexpr const char* kModelChange = "model_change";  ///< attribute with the largest PointResult::model_change

/// The quantities that results of a scene have or, with a plan, that a run computes; at points the others are NaN.
Quantities quantities_of(const SceneValues& scene, const EffectPlan* plan = nullptr);

/// The layout of the table over `axes`, a grid or a part of it, with the attributes that are known before the run.
TableLayout table_layout(const SceneValues& scene, const EffectPlan& plan, const Axes& axes);

/// Sets Curve::used of the curves: their values at the wavelengths of the table.
void fill_used(TableHead& head, const SceneValues& scene);

/// The attribute that names everything on which the values of a table depend, except the device. It is a text of names
/// and values, which difference() compares.
inline constexpr const char* kIdentity = "identity";
std::string identity_of(const SceneValues& scene, const std::string& evaluator, bool keep_all);

TableValues table_part(const TableLayout& layout, const SceneEntries& part, const std::vector<PointResult>& results);

/// Data about a run that the attributes of its table record.
struct RunRecord {
  EvaluationReport evaluation;
  std::string effects, rule;
  double model_change = 0.0;
  SelfCheck check;
  double wall_s = 0.0;

  std::vector<Attribute> attributes(const std::string& command_line) const;
};
std::vector<Attribute> attributes_of(const SceneValues& scene, const RunOutcome& run, const std::string& command_line);
/// The value of the attribute "history": time and command line.
std::string history_text(const std::string& command_line);

/// The quadrature and the interpolation in words, for reports and table attributes.
std::string rule_text(double tolerance, const EvaluationReport& evaluation);

}  // namespace dolp
