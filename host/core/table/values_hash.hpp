// Hash of a table's values, to detect damage.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// The attribute that holds it.
inline constexpr const char* kValuesHash = "values_hash";

/// The sums of a table's values, or of a part of them: of the bits of each value, times an odd number that follows from
/// its place, so that another value or place changes the sum. Parts may come in any order.
///
/// Shape: one number for each of the quantities, of the responses that are there, and for status where it is there.
using ValueSums = std::vector<std::uint64_t>;

/// The sum of a variable's values from a place on.
std::uint64_t sum_of_values(std::span<const double> values, std::size_t first_place);
std::uint64_t sum_of_values(std::span<const std::uint32_t> values, std::size_t first_place);

/// The sums of the values of a part of a table of `whole` entries on each axis.
ValueSums sums_of(const TableValues& part, const Quantities& quantities, const PerAxis& first, const PerAxis& whole);

/// Adds the sums of another part.
void add(ValueSums& sums, const ValueSums& of_part);

/// The hash of all values, with axes and curves of the head.
std::string values_hash(const TableHead& head, const Quantities& quantities, const ValueSums& sums);

}  // namespace dolp
