#include "table/table_box.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace dolp {

std::vector<TableBox> boxes_in_order(const PerAxis& counts, std::size_t most) {
  if (size_of(counts) == 0) return {};
  // Boxes have all of the fastest axes, some of one, and one value of the slowest.
  std::size_t cut = counts.size() - 1;
  std::size_t of_one = 1;
  while (cut > 0 && of_one * counts[cut] <= most) of_one *= counts[cut--];
  const std::size_t at_once = std::clamp<std::size_t>(most / of_one, 1, counts[cut]);
  const auto end_of_slow = counts.begin() + static_cast<std::ptrdiff_t>(cut);
  const std::size_t slow = std::accumulate(counts.begin(), end_of_slow, std::size_t{1}, std::multiplies<>());
  std::vector<TableBox> boxes;
  for (std::size_t i = 0; i < slow; ++i) {
    TableBox box{{}, counts};
    for (std::size_t axis = cut, rest = i; axis-- > 0; rest /= counts[axis]) {
      box.first[axis] = rest % counts[axis];
      box.count[axis] = 1;
    }
    for (std::size_t first = 0; first < counts[cut]; first += at_once) {
      box.first[cut] = first;
      box.count[cut] = std::min(at_once, counts[cut] - first);
      boxes.push_back(box);
    }
  }
  return boxes;
}

TableHead head_of(const TableHead& whole, const TableBox& box) {
  TableHead head = whole;
  head.axes = part_of(whole.axes, box.first, box.count);
  if (!whole.wind_m_s.empty()) {
    const auto first = whole.wind_m_s.begin() + static_cast<std::ptrdiff_t>(box.first[Axis::kSigma]);
    head.wind_m_s = {first, first + static_cast<std::ptrdiff_t>(box.count[Axis::kSigma])};
  }
  for (const TableCurve& described : kTableCurves) {
    std::vector<double>& used = (head.*described.curve).used;
    if (used.empty()) continue;
    const auto first = used.begin() + static_cast<std::ptrdiff_t>(box.first[Axis::kWavelength]);
    used = {first, first + static_cast<std::ptrdiff_t>(box.count[Axis::kWavelength])};
  }
  return head;
}

}  // namespace dolp
