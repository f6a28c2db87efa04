// Sample of entries that represent all of a run.
#pragma once

#include <cstddef>
#include <vector>

#include "model/scene_entry.hpp"

namespace dolp {

/// Up to `count` of the positions below `size`, ascending: spread evenly by a fixed sequence that does not resonate
/// with the axes of a grid.
std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count);

/// All entries where there are at most `count`, else those at drawn positions.
SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count);

}  // namespace dolp
