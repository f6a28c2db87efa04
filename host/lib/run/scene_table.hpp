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

inline constexpr const char* kModelChange = "model_change";           ///< attribute with ModelChange::i
inline constexpr const char* kModelChangeDolp = "model_change_dolp";  ///< attribute with ModelChange::dolp_points

/// The quantities in the results of a scene. With a plan: only the quantities that the run computes. With a list of
/// entries: also rho_u if they have a sigma_cross.
Quantities output_quantities(const SceneValues& scene, const EffectPlan* plan = nullptr,
                             const SceneEntries* entries = nullptr);

/// The layout of the table over `axes` (a grid or a part of it), with all attributes that are known before the run.
TableLayout table_layout(const SceneValues& scene, const EffectPlan& plan, const Axes& axes);
/// The layout of the table that a run computes, with its derivatives.
TableLayout table_layout(const SceneValues& scene, const Run& run);

/// Keeps only the variables with these names; all if there are none. Errors: InputError that lists the allowed names.
void choose_variables(TableLayout& layout, const std::vector<std::string>& names);

/// For the curves n, k and E0 of `head`, sets Curve::used to the values at the wavelengths of the table.
void fill_used(TableHead& head, const SceneValues& scene);

/// Attribute with everything on which a table's values depend, except the device. difference() compares two such texts.
inline constexpr const char* kIdentity = "identity";
std::string run_identity(const SceneValues& scene, const std::string& evaluator, const RunOptions& options);

/// The columns of `quantities`, the derivatives and the status. Values are NaN if the run has not computed them.
ResultColumns run_columns(const Quantities& quantities, RunResults results);
TableValues table_part(const TableLayout& layout, const SceneEntries& part, RunResults results);

struct RunRecord {
  EvaluationReport evaluation;
  std::string effects, rule;
  ModelChange model_change;
  SelfCheck check;
  double wall_s = 0.0;

  std::vector<Attribute> attributes(const std::string& command_line) const;
};
std::vector<Attribute> run_attributes(const SceneValues& scene, const RunOutcome& run, const std::string& command_line);
std::string history_text(const std::string& command_line);

/// Describes the quadrature and the interpolation in words, for reports and the attribute "rule".
std::string rule_text(double tolerance, const EvaluationReport& evaluation);

}  // namespace dolp
