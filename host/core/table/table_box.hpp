// Parts of a table.
#pragma once

#include <cstddef>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// Place of a part of a table in the whole: from `first` on `count` values of each axis.
struct TableBox {
  PerAxis first = {};
  PerAxis count = {};
};

/// Boxes of at most `most` entries each, or of one, that follow each other in the order of the table.
std::vector<TableBox> boxes_in_order(const PerAxis& counts, std::size_t most);

/// The head of a part of a table.
TableHead head_of(const TableHead& whole, const TableBox& box);

}  // namespace dolp
