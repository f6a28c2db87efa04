#include "table/table_store.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

#include "model/scene_entry.hpp"

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
  return head;
}

TableStore::TableStore(const TableLayout& layout, AtomicFile& file)
    : layout_(layout), file_(file), skeleton_(layout), sums_(skeleton_.offsets().size(), 0) {}

void TableStore::write(const TableValues& part, const PerAxis& first) {
  const auto put = [&](std::size_t variable, const auto& values) {
    const std::span all(values);
    for_each_run(first, part.counts(), layout_.head.counts(), [&](const GridRun& run) {
      const auto own = all.subspan(run.in_part, run.count);
      sums_[variable] += ValuesHash::sum(own, run.in_whole);
      file_.write_at(skeleton_.offsets()[variable] + run.in_whole * sizeof(own[0]), own.data(), own.size_bytes());
    });
  };
  for (std::size_t i = 0; i < layout_.quantities.size(); ++i) put(i, part[layout_.quantities[i]]);
  if (layout_.has_status) put(layout_.quantities.size(), part.status);
}

TableValues TableStore::read(const TableBox& box) const {
  TableValues part;
  static_cast<TableHead&>(part) = head_of(layout_.head, box);
  const auto get = [&](std::size_t variable, auto& values) {
    values.resize(part.size());
    const std::span all(values);
    for_each_run(box.first, box.count, layout_.head.counts(), [&](const GridRun& run) {
      const auto own = all.subspan(run.in_part, run.count);
      file_.read_at(skeleton_.offsets()[variable] + run.in_whole * sizeof(own[0]), own.data(), own.size_bytes());
    });
  };
  for (std::size_t i = 0; i < layout_.quantities.size(); ++i) get(i, part[layout_.quantities[i]]);
  if (layout_.has_status) get(layout_.quantities.size(), part.status);
  return part;
}

void TableStore::finish(const std::vector<Attribute>& more) {
  std::vector<Attribute> attributes = more;
  attributes.push_back({kValuesHash, ValuesHash(layout_.head).text(layout_.quantities, sums_)});
  skeleton_.add(attributes);
  for (const NetcdfSkeleton::Piece& piece : skeleton_.pieces())
    file_.write_at(piece.offset, piece.bytes.data(), piece.bytes.size());
}

}  // namespace dolp
