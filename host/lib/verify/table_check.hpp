// Recomputes entries of a table with the independent reference and compares them with what the table states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <dolp/options.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// One stored value beside the reference's.
struct CheckedValue {
  std::string quantity;
  double theta_deg = 0.0;
  double sigma = 0.0;
  double q = 0.0;
  std::optional<double> wavelength_um, n, k;  ///< where the table has these axes
  double stored = 0.0;
  double reference = 0.0;
  double stated = 0.0;           ///< the table's bound of the error, in the units of the value
  double reference_error = 0.0;  ///< the reference's own
  std::string complaint;         ///< empty when it is right
  double error() const;
  /// error over the two bounds together; 0 where nothing is stated.
  double ratio() const;
};

/// All compared values of one quantity.
struct QuantityCheck {
  std::string name;
  std::size_t compared = 0;
  std::size_t unstated = 0;  ///< of them, those for which the table states no bound
  CheckedValue worst;        ///< the one of the largest ratio
};

struct TableCheck {
  std::size_t entries = 0;
  std::size_t checked = 0;
  std::size_t missed = 0;  ///< of the checked, those that say they miss the tolerance (status 2 or 16)
  double tolerance = 0.0;
  std::vector<QuantityCheck> quantities;
  std::vector<CheckedValue> failures;
  bool passed() const { return failures.empty(); }
};

/// Positions of `samples` distinct entries out of `entries`, ascending; the same for the same seed everywhere.
std::vector<std::size_t> sample_positions(std::size_t entries, const TableCheckOptions& options);

/// Some entries of a table: its variables have one value for each of the ascending positions.
struct TableSample {
  TableValues table;
  std::vector<std::size_t> positions;
};

/// Compares dolp, rho_i, rho_q and the Stokes parameters of the sample, as far as the table has them, with
/// ReferenceEvaluator through the radiometry of the table's scene, over a band with integrate_band.
///
/// A value is wrong if its error exceeds the stated bound plus the reference's own, if one of the two is no number and
/// the other is, or if rho or DOLP misses the tolerance where status does not say so. The bounds: rho_error_estimate
/// rho_I for rho, error_estimate for DOLP. What the latter implies for the Stokes parameters is error_estimate |I| for
/// Q, U and V and error_estimate |I| / DOLP for I, which states nothing where DOLP vanishes.
/// Not independent: closed forms of mirrors and limits, which come from the same code in every evaluator.
/// Errors: InputError that begins with `name` for a table without anything to compare or with axes out of range;
/// Cancelled when `progress` returns false.
TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress);

}  // namespace dolp
