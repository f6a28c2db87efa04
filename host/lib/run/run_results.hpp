#pragma once

#include <cstddef>
#include <dolp/results.hpp>
#include <vector>

namespace dolp {

/// The results of some entries of a run. Shape: one value per entry in each column.
struct RunResults : ResultColumns {
  RunResults() = default;
  /// Columns for `quantities`, the status, and derivatives as in `derivatives`. Their values are still to be set.
  RunResults(const Quantities& quantities, const std::vector<DerivativeColumn>& derivatives, std::size_t entries);

  std::vector<double> model_change, model_change_dolp;  ///< see PointResult

  std::size_t size() const { return status.size(); }
  PointResult at(std::size_t position) const;
  std::vector<PointResult> list() const;  ///< at() of all positions
  void set(std::size_t position, const PointResult& result);
  /// Copies `count` entries of `part`, which has the same columns, from number `in_part` to number `in_whole`.
  void copy(const RunResults& part, std::size_t in_part, std::size_t in_whole, std::size_t count);
};

}  // namespace dolp
