#include "plan/groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "plan/rule.hpp"

namespace dolp {
namespace {

// Below it the masking tables of heavy and light tails have scales that no common one serves.
constexpr double kSmallestGroupedM = 1e-3;

// Between the exponents of a family, as a factor of q - 1: shapes further apart would want nodes in different places.
constexpr double kMostSpread = 6.0;

// The share of members in use from which on groups are worth while.
constexpr double kLeastUse = 0.5;

bool has_line(const KernelData& data, const kernel::ShapeNode& shape) {
  return needs_line(data.distribution, data.masking, {shape.m / std::sqrt(2.0), 1.0 + shape.q_minus_1},
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

Grouping grouped_exactly(const KernelData& data, std::uint32_t size) {
  Grouping grouping;
  grouping.size = size;
  const std::vector<std::uint32_t> positions = make_families(data, grouping);
  std::vector<std::uint32_t> family_of(grouping.shapes.size());
  for (std::uint32_t f = 0; f < grouping.families.size(); ++f) {
    const ShapeFamily& family = grouping.families[f];
    std::fill_n(family_of.begin() + family.first, family.count, f);
  }
  // (family, index, direction), ascending, then the member
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
  std::vector<std::pair<Key, std::uint32_t>> keys;
  keys.reserve(data.entries.size());
  for (std::uint32_t i = 0; i < data.entries.size(); ++i) {
    const MomentsEntry& entry = data.entries[i];
    const std::uint32_t position = positions[entry.shape];
    const std::uint32_t family = family_of[position];
    keys.push_back({{family, entry.index, entry.theta, position - grouping.families[family].first}, i});
  }
  std::sort(keys.begin(), keys.end());
  grouping.places.resize(data.entries.size());
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto& [family, index, theta, member] = keys[k].first;
    const bool is_new_group = k == 0 || std::tie(family, index, theta) != std::tie(std::get<0>(keys[k - 1].first),
                                                                                   std::get<1>(keys[k - 1].first),
                                                                                   std::get<2>(keys[k - 1].first));
    if (is_new_group) grouping.groups.push_back({theta, family, index, 0});
    const bool is_new_member = is_new_group || member != std::get<3>(keys[k - 1].first);
    grouping.groups.back().used += is_new_member ? 1 : 0;
    grouping.places[keys[k].second] = {static_cast<std::uint32_t>(grouping.groups.size() - 1), member};
  }
  return grouping;
}

}  // namespace

Grouping grouped(const KernelData& data, std::uint32_t size) {
  if (size > 1 && may_group(data.rule)) {
    Grouping grouping = grouped_exactly(data, size);
    double used = 0.0;
    for (const EntryGroup& group : grouping.groups) used += group.used;
    if (used >= kLeastUse * size * static_cast<double>(grouping.groups.size())) return grouping;
  }
  return grouped_exactly(data, 1);
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
        if (piece < piece_count(data.thetas[grouping.groups[g].theta], shape)) pieces.push_back({g, piece});
      }
    }
    begin = next;
  }
  return pieces;
}

}  // namespace dolp
