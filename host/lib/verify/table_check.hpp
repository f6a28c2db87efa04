// Recomputes entries of tables with the independent reference, and compares them with the values and errors stated.
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

/// One stored value beside the reference's.
struct CheckedValue {
  std::string quantity;
  std::vector<AxisValue> position;  ///< on the table's axes
  double stored = 0.0;
  double reference = 0.0;
  double stated = 0.0;           ///< the table's bound of the error, in the units of the value
  double reference_error = 0.0;  ///< bound of the reference's own error
  std::string complaint;         ///< empty when it is right
  double error() const;
  /// error over the two bounds together; 0 where nothing is stated.
  double ratio() const;
};

/// All compared values of one quantity.
struct QuantityCheck {
  std::string name;
  std::size_t compared = 0;
  std::size_t unstated = 0;  ///< compared values for which the table states no bound
  CheckedValue worst;        ///< the value of the largest ratio
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

/// The values of the axes at an entry of a table.
std::vector<AxisValue> position_of(std::size_t entry, const TableHead& table);

/// Positions of `samples` distinct entries out of `entries`, ascending. They depend only on the seed.
std::vector<std::size_t> sample_positions(std::size_t entries, const TableCheckOptions& options);

/// Some entries of a table: its variables have one value for each of the ascending positions.
struct TableSample {
  TableValues table;
  std::vector<std::size_t> positions;
};

/// Compares the quantities of the sample that the table has (dolp, rho_i, rho_q, Stokes parameters) with
/// ReferenceEvaluator through the radiometry of the table's scene, over a band with integrate_band.
///
/// A value is wrong if its error exceeds the stated bound plus the reference's bound, if only one of both is a number,
/// or if rho or DOLP misses the tolerance without the status for it. The bounds are rho_error_estimate rho_I for rho,
/// error_estimate for DOLP, error_estimate |I| for Q, U and V, and error_estimate |I| / DOLP for I, which is infinite
/// where DOLP vanishes.
/// Not independent: closed forms of mirrors and limits, which come from the same code in every evaluator.
/// Errors: InputError that begins with `name` for a table without anything to compare or with axes out of range;
/// Cancelled when `progress` returns false.
TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress);

/// Compares all weights of a response table's sample with the weights of ReferenceEvaluator. They are wrong where they
/// are farther apart, as response_distance measures it, than the table's response_error and the reference's own error
/// together. Errors: InputError that begins with `name` for a table without response_error; Cancelled.
TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress);

/// Results of a scene with a band at some points, without the spectral rule.
///
/// Method: for each point an adaptive Gauss-Kronrod quadrature over the results at single wavelengths. It begins at the
/// rows of the material, the source and the sky, and takes at most kMostIntervals; the rest of its error is in the
/// estimates. Only results that are not an integral over the wavelength (the bracket, a limit at 90 degrees) come from
/// the spectral rule.
std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
