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

/// The value of an axis, with its label if the axis has labels.
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
  double reference_error = 0.0;  ///< error bound of `reference`, in the same unit
  std::string complaint;         ///< what is wrong; empty if nothing is wrong
  double error() const;
  /// Ratio of error() to `stated` plus `reference_error`; 0 if the table states no bound.
  double ratio() const;
};

struct QuantityCheck {
  std::string name;
  std::size_t compared = 0;
  std::size_t unstated = 0;  ///< compared values for which the table states no bound
  CheckedValue worst;        ///< value with the largest ratio()
};

struct TableCheck {
  std::size_t entries = 0;
  std::size_t checked = 0;
  std::size_t missed = 0;  ///< checked entries with status bit 2 (DOLP) or 16 (rho): tolerance missed
  double tolerance = 0.0;
  std::vector<QuantityCheck> quantities;
  std::vector<CheckedValue> failures;
  bool passed() const { return failures.empty(); }
};

std::vector<AxisValue> position_of(std::size_t entry, const TableHead& table);

/// `options.samples` different positions below `entries`, in ascending order. They depend only on the seed.
std::vector<std::size_t> sample_positions(std::size_t entries, const TableCheckOptions& options);

/// Some entries of a table. Each column of `table` has one value for each of `positions`, which are in ascending order.
struct TableSample {
  TableValues table;
  std::vector<std::size_t> positions;
};

/// Compares a sample of a table with results for the table's scene that ReferenceEvaluator and the radiometry give, or
/// integrate_band over a band.
/// A value is wrong in three cases: its error exceeds the stated bound plus the bound of the reference; only one of
/// stored value and reference is a number; rho or DOLP misses the tolerance, but the status has no bit for it. The
/// stated bound is rho_error_estimate rho_I for rho, error_estimate for DOLP, error_estimate |I| for Q, U and V, and
/// error_estimate |I| / DOLP for I. For emissivities, for the albedo and for I near DOLP = 0, it is ten times the
/// largest of both estimates and the tolerance, relative to the terms that add up to the value. Closed forms of mirrors
/// and limits are not checked independently: every evaluator takes them from the same code.
/// Errors: InputError that begins with `name` if the table has nothing to compare or has axes out of range; Cancelled.
TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress);

/// Compares the weights in a sample of a response table with weights of ReferenceEvaluator. Weights of an entry are
/// wrong if their response_distance() exceeds the sum of response_error in the table and in the reference. Errors:
/// InputError that begins with `name` if the table has no response_error; Cancelled.
TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress);

/// Results at some points of a scene with a band. Instead of the spectral rule, an adaptive Gauss-Kronrod quadrature
/// integrates results at single wavelengths. Its first intervals begin and end at wavelengths in the data of material,
/// source and sky. A point has at most kMostIntervals intervals; the remaining error is part of the error estimates.
/// Results that are no integral over the wavelength (bracket, limit at 90 degrees) use the spectral rule.
std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
