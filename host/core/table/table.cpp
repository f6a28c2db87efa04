#include "table/table.hpp"

#include "base/parallel_ranges.hpp"

namespace dolp {

ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities) {
  constexpr std::size_t kEntriesAtOnce = 16384;
  ResultColumns columns;
  for (const Quantity quantity : quantities) columns[quantity].resize(results.size());
  columns.status.resize(results.size());
  parallel_ranges(results.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const Quantity quantity : quantities) columns[quantity][i] = results[i][quantity];
      columns.status[i] = results[i].status;
    }
  });
  return columns;
}

}  // namespace dolp
