#pragma once

#include <cstddef>
#include <dolp/options.hpp>
#include <dolp/results.hpp>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

struct AxisValue {
  Axis axis;
  double value;
  std::string label;
};

struct CheckedValue {
  std::string quantity;
  std::vector<AxisValue> position;  ///< value of each axis of the table
  double stored = 0.0;
  double reference = 0.0;
  double stated = 0.0;           ///< error bound that the table states, in the unit of `stored`
  double reference_error = 0.0;  ///< error bound of `reference`, in the unit of `stored`
  std::string complaint;         ///< what is wrong; empty if nothing is wrong
  double error() const;
  /// True if the error may exceed `stated`, but the reference is less accurate than the table and cannot tell.
  bool is_undecided() const { return complaint.empty() && error() > stated && reference_error > stated; }
  double ratio() const;  ///< error() / (stated + reference_error); 0 if the table states no bound
};

struct QuantityCheck {
  std::string name;
  std::size_t compared = 0;
  std::size_t unstated = 0;   ///< compared values for which the table states no bound
  std::size_t undecided = 0;  ///< CheckedValue::is_undecided()
  CheckedValue worst;         ///< value with the largest ratio()
};

struct TableCheck {
  std::size_t entries = 0;
  std::size_t checked = 0;
  std::size_t missed = 0;  ///< checked entries that miss the tolerance, according to the table
  double tolerance = 0.0;
  std::vector<QuantityCheck> quantities;
  std::vector<CheckedValue> failures;
  bool passed() const { return failures.empty(); }
};

std::vector<AxisValue> entry_axis_values(std::size_t entry, const TableHead& table);

/// Some entries of a table. `table` has only these entries; `positions` are their positions in the whole table.
struct TableSample {
  TableValues table;
  std::vector<std::size_t> positions;
};

/// Compares a sample of a table with results of ReferenceEvaluator. integrate_band() integrates them over a band.
/// A value is wrong if its error exceeds the bound of the table plus the bound of the reference. It is also wrong if
/// only the table or only the reference has a number, or if rho or DOLP misses the tolerance without a status bit.
/// Values from closed forms, for example for a mirror, are not checked independently, because every evaluator takes
/// them from the same code.
/// Errors: InputError that begins with `name` if the table has nothing to compare or has axes out of range; Cancelled.
TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress);

/// Compares the weights in a sample of a response table with weights from ReferenceEvaluator. The weights of an entry
/// are wrong if their response_distance() to the reference exceeds the sum of both response_errors.
/// Errors: InputError that begins with `name` if the table has no response_error; Cancelled.
TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress);

/// Results at points of a scene with a band, by adaptive Gauss-Kronrod quadrature over the wavelength. The error
/// estimates include the error of this quadrature. evaluate_scene() gives the bounds dolp_low and dolp_high. It also
/// gives all results at points where the quadrature gives no DOLP.
std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
