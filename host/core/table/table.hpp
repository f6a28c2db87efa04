// Layout of a lookup table.
#pragma once

#include <cstddef>
#include <span>

#include <dolp/table_values.hpp>
#include "model/axes.hpp"

namespace dolp {

/// The most entries that a table has.
inline constexpr std::size_t kMostTableEntries = std::size_t{1} << 36U;

/// The attribute for the conventions that a table file keeps, and its value.
inline constexpr const char* kConventions = "Conventions";
inline constexpr const char* kConventionsOfFiles = "CF-1.8";

/// Layout of a table, known before its values.
struct TableLayout {
  TableHead head;
  Quantities quantities;
  bool has_status = true;
};

/// Shape: a column for each of `quantities`, and the status.
ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities);

}  // namespace dolp
