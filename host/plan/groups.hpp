// Which entries one invocation of the kernel computes together: those that differ in the exponent q alone share the
// nodes, the facets and their reflection (shaders/physics/row.glsl).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Members of a group that the kernel is compiled for.
inline constexpr std::array<std::uint32_t, 4> kGroupSizes = {1, 4, 8, 16};

/// Consecutive shapes of one sigma, in ascending order of q.
struct ShapeFamily {
  std::uint32_t first = 0;  ///< position in Grouping::shapes
  std::uint32_t count = 1;  ///< at most the size of a group
};

/// The entries of one direction, one index and one family of shapes.
struct EntryGroup {
  std::uint32_t theta = 0;
  std::uint32_t family = 0;
  std::uint32_t index = 0;
  std::uint32_t used = 0;  ///< members that entries ask for
};

/// One invocation of the kernel.
struct GroupPiece {
  std::uint32_t group = 0;
  std::uint32_t piece = 0;  ///< of the slope axis
};

/// Where the result of an entry is.
struct EntryPlace {
  std::uint32_t group = 0;
  std::uint32_t member = 0;
};

/// Entries sorted into groups. All of it follows from the sets of directions, shapes and indices, not from their order.
struct Grouping {
  std::uint32_t size = 1;                 ///< members of a group
  std::vector<kernel::ShapeNode> shapes;  ///< ordered by family; scale, cut and cusp are those of the family
  std::vector<ShapeFamily> families;
  std::vector<EntryGroup> groups;  ///< ordered by family, index and direction
  std::vector<EntryPlace> places;  ///< of each entry of the data
};

/// The invocations of groups first, first + 1, ...: neighbours differ in the direction, so that they do the same work.
std::vector<GroupPiece> pieces_of(const Grouping& grouping, const KernelData& data, std::uint32_t first,
                                  std::uint32_t count);

/// Groups of the size that takes the least work. Making a kernel is part of the work, unless `kernels_are_free`, so that
/// small requests have no groups.
Grouping grouped(const KernelData& data, bool kernels_are_free = false);
/// Groups of one size.
Grouping grouped_by(const KernelData& data, std::uint32_t size);

}  // namespace dolp
