// Self-check of a run: computes some of its entries again, by a rule of another kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <dolp/results.hpp>

namespace dolp {

/// Check of all error bounds by the entries that were computed again.
struct SelfCheck {
  std::size_t entries = 0;
  double worst_ratio = 0.0;  ///< largest difference over the sum of the bounds of both results; above 1 a bound failed

  /// Adds the difference between `result` and `again`.
  void add(const PointResult& result, const PointResult& again);
  void add(const SelfCheck& other);
};

/// The number of a table's moments that are computed again: those that cost a fiftieth of all, at most 64 and
/// 64 more for each four million.
std::size_t checked_count(std::size_t moments);

/// `count` of the positions below `size`, ascending; which ones follows from the seed alone.
std::vector<std::size_t> checked_positions(std::size_t size, std::size_t count, std::uint64_t seed);

}  // namespace dolp
