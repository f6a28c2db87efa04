#include "plan/groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "plan/rule.hpp"

namespace dolp {
namespace {

// Below it the masking tables of heavy and light tails have scales that no common one serves.
constexpr double kSmallestGroupedM = 1e-3;

// Between the exponents of a family, as a factor of q - 1: shapes further apart would want nodes in different places.
constexpr double kMostSpread = 6.0;

// Groups are not for entries that would leave this share of the members unused.
constexpr double kLeastUse = 0.5;

// What a group takes, in units of what each of its members takes at kUsualDigits. Look-ups in masking tables are each
// member's own.
struct GroupWork {
  double shared = 16.0;     // by the members
  double kernel = 40000.0;  // to make the kernel, for each member that it is made for
};
constexpr GroupWork kWithTables = {.shared = 5.0, .kernel = 7000.0};
constexpr double kUsualDigits = 6.0;

bool has_line(const KernelData& data, const kernel::ShapeNode& shape) {
  return needs_line(rule_model(data.masking), data.distribution, data.masking, {shape.m / std::sqrt(2.0), 1.0 + shape.q_minus_1},
                    data.rule.digits);
}

// Whether `next` may join the family that begins with `first`.
bool belongs(const KernelData& data, const kernel::ShapeNode& first, const kernel::ShapeNode& next) {
  return data.distribution == Distribution::kCauchy && first.m == next.m && first.m >= kSmallestGroupedM &&
         next.q_minus_1 <= kMostSpread * first.q_minus_1 && has_line(data, first) == has_line(data, next);
}

// Gives the shapes of a family what the kernel takes from the first of them.
void unite(std::span<kernel::ShapeNode> family) {
  kernel::ShapeNode common = family.front();
  for (const kernel::ShapeNode& shape : family) {
    common.scale = std::min(common.scale, shape.scale);
    common.cut = std::max(common.cut, shape.cut);
    common.table_scale = std::min(common.table_scale, shape.table_scale);
    common.cusp_digits = std::max(common.cusp_digits, shape.cusp_digits);
  }
  for (kernel::ShapeNode& shape : family) {
    shape.scale = common.scale;
    shape.cut = common.cut;
    shape.table_scale = common.table_scale;
    shape.cusp_digits = common.cusp_digits;
  }
}

// The families, and for each shape of the data its position in the order of the families.
std::vector<std::uint32_t> make_families(const KernelData& data, Grouping& grouping) {
  std::vector<std::uint32_t> order(data.shapes.size());
  std::iota(order.begin(), order.end(), 0U);
  if (grouping.size > 1) {
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto key = [&](std::uint32_t i) { return std::pair(data.shapes[i].m, data.shapes[i].q_minus_1); };
      return key(a) < key(b);
    });
  }
  std::vector<std::uint32_t> positions(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const kernel::ShapeNode& shape = data.shapes[order[i]];
    positions[order[i]] = i;
    grouping.shapes.push_back(shape);
    const bool joins = grouping.size > 1 && i > 0 && grouping.families.back().count < grouping.size &&
                       belongs(data, data.shapes[order[grouping.families.back().first]], shape);
    if (joins) {
      ++grouping.families.back().count;
    } else {
      grouping.families.push_back({i, 1});
    }
  }
  for (const ShapeFamily& family : grouping.families) {
    unite(std::span(grouping.shapes).subspan(family.first, family.count));
  }
  return positions;
}

bool is_of(const EntryGroup& group, std::uint32_t family, std::uint32_t index, std::uint32_t theta) {
  return group.family == family && group.index == index && group.theta == theta;
}

// Sorts positions by the number below `count` that `key` gives each, keeping the order of those that share one.
template <class Key>
void sort_by(std::vector<std::uint32_t>& positions, std::size_t count, const Key& key) {
  if (count < 2) return;
  std::vector<std::uint32_t> ends(count, 0);
  for (const std::uint32_t i : positions) ++ends[key(i)];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<std::uint32_t> sorted(positions.size());
  for (auto i = positions.rbegin(); i != positions.rend(); ++i) sorted[--ends[key(*i)]] = *i;
  positions.swap(sorted);
}

// A shape's family, and which of its members it is.
struct Member {
  std::uint32_t family = 0;
  std::uint32_t number = 0;
};

// Of each shape of the data.
std::vector<Member> members_of(const Grouping& grouping, const std::vector<std::uint32_t>& positions) {
  std::vector<Member> by_position(positions.size());
  for (std::uint32_t f = 0; f < grouping.families.size(); ++f) {
    const ShapeFamily& family = grouping.families[f];
    for (std::uint32_t g = 0; g < family.count; ++g) by_position[family.first + g] = {f, g};
  }
  std::vector<Member> members;
  members.reserve(positions.size());
  for (const std::uint32_t position : positions) members.push_back(by_position[position]);
  return members;
}

}  // namespace

Grouping grouped_by(const KernelData& data, std::uint32_t size) {
  Grouping grouping;
  grouping.size = size;
  const std::vector<std::uint32_t> positions = make_families(data, grouping);
  const std::vector<Member> members = members_of(grouping, positions);
  const std::vector<MomentsEntry>& entries = data.entries;
  // By family, index, direction and member: the last is sorted by first.
  std::vector<std::uint32_t> order(entries.size());
  std::iota(order.begin(), order.end(), 0U);
  sort_by(order, size, [&](std::uint32_t i) { return members[entries[i].shape].number; });
  sort_by(order, data.thetas.size(), [&](std::uint32_t i) { return entries[i].theta; });
  sort_by(order, data.indices.size(), [&](std::uint32_t i) { return entries[i].index; });
  sort_by(order, grouping.families.size(), [&](std::uint32_t i) { return members[entries[i].shape].family; });
  grouping.places.resize(entries.size());
  std::uint32_t last_member = 0;
  for (const std::uint32_t i : order) {
    const auto [family, member] = members[entries[i].shape];
    const bool is_new_group =
        grouping.groups.empty() || !is_of(grouping.groups.back(), family, entries[i].index, entries[i].theta);
    if (is_new_group) grouping.groups.push_back({entries[i].theta, family, entries[i].index, 0});
    if (is_new_group || member != last_member) ++grouping.groups.back().used;
    grouping.places[i] = {static_cast<std::uint32_t>(grouping.groups.size() - 1), member};
    last_member = member;
  }
  return grouping;
}

Grouping grouped(const KernelData& data, bool kernels_are_free) {
  Grouping best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t size : kGroupSizes) {
    Grouping grouping = grouped_by(data, size);
    const auto groups = static_cast<double>(grouping.groups.size());
    if (size > 1 && static_cast<double>(data.entries.size()) <= kLeastUse * size * groups) continue;
    const GroupWork unit = data.masking == Masking::kIntegral ? kWithTables : GroupWork{};
    const double evaluations = std::pow(data.rule.digits / kUsualDigits, 2.0);
    const double kernel = kernels_are_free ? 0.0 : unit.kernel * size;
    const double work = (unit.shared + size) * groups * evaluations + kernel;
    if (work < least) {
      least = work;
      best = std::move(grouping);
    }
  }
  return best;
}

std::vector<GroupPiece> pieces_of(const Grouping& grouping, const KernelData& data, std::uint32_t first,
                                  std::uint32_t count) {
  const auto same_work = [&](std::uint32_t a, std::uint32_t b) {
    return grouping.groups[a].family == grouping.groups[b].family &&
           grouping.groups[a].index == grouping.groups[b].index;
  };
  std::vector<GroupPiece> pieces;
  const std::uint32_t end = first + count;
  for (std::uint32_t begin = first; begin < end;) {
    std::uint32_t next = begin + 1;
    while (next < end && same_work(begin, next)) ++next;
    const kernel::ShapeNode& shape = grouping.shapes[grouping.families[grouping.groups[begin].family].first];
    for (std::uint32_t piece = 0; piece < DOLP_MAX_PIECES; ++piece) {
      for (std::uint32_t g = begin; g < next; ++g) {
        if (piece < piece_count(data, grouping.groups[g].theta, shape)) pieces.push_back({g, piece});
      }
    }
    begin = next;
  }
  return pieces;
}

}  // namespace dolp
