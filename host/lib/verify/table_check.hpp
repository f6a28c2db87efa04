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
  double stated = 0.0;           ///< error bound that the table states, in the unit of the value
  double reference_error = 0.0;  ///< error bound of the reference, in the unit of the value
  std::string complaint;         ///< what is wrong; empty if nothing is wrong
  double error() const;
  /// Ratio of the error to the sum of both bounds; 0 if no bound is stated.
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
  std::size_t missed = 0;  ///< checked entries whose status reports a missed tolerance (2 or 16)
  double tolerance = 0.0;
  std::vector<QuantityCheck> quantities;
  std::vector<CheckedValue> failures;
  bool passed() const { return failures.empty(); }
};

std::vector<AxisValue> position_of(std::size_t entry, const TableHead& table);

/// Positions of `samples` different entries out of `entries`, in ascending order. They depend only on the seed.
std::vector<std::size_t> sample_positions(std::size_t entries, const TableCheckOptions& options);

/// Some entries of a table. The columns of `table` have one value per position; the positions are in ascending order.
struct TableSample {
  TableValues table;
  std::vector<std::size_t> positions;
};

/// Compares the quantities of a sample that its table has with results of ReferenceEvaluator and of the radiometry of
/// the table's scene; over a band with results of integrate_band.
/// A value is wrong in three cases: its error exceeds the stated bound plus the bound of the reference; only one of
/// both values is a number; rho or DOLP misses the tolerance without the status for it. The bound is rho_error_estimate
/// rho_I for rho, error_estimate for DOLP, error_estimate |I| for Q, U and V, and error_estimate |I| / DOLP for I. For
/// emissivities, for the albedo and for I near DOLP = 0, it is ten times the largest estimate, relative to the terms
/// that add up to the value. Closed forms of mirrors and limits are not independent: every evaluator takes them from
/// the same code.
/// Errors: InputError that begins with `name` if the table has nothing to compare or has axes out of range; Cancelled.
TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress);

/// Compares the weights of a sample of a response table with weights of ReferenceEvaluator. The weights of an entry are
/// wrong if their response_distance() exceeds response_error of the table plus that of the reference.
/// Errors: InputError that begins with `name` if the table has no response_error; Cancelled.
TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress);

/// Results at some points of a scene with a band, by adaptive Gauss-Kronrod quadrature over results at single
/// wavelengths instead of the spectral rule. The first intervals begin and end at rows of the material, the source and
/// the sky. A point has at most kMostIntervals intervals; the error that remains is part of the estimates. Only results
/// that are no integral over the wavelength (the bracket, a limit at 90 degrees) come from the spectral rule.
std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
