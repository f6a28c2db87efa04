// Layout of a lookup table, its parts, and the hash of its values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <cstdint>
#include <dolp/table_values.hpp>
#include <vector>
#include "model/scene_entry.hpp"

namespace dolp {

/// The most entries that a table has.
inline constexpr std::size_t kMostTableEntries = std::size_t{1} << 36U;

/// The attribute for the conventions that a table file keeps, and its value.
inline constexpr const char* kConventions = "Conventions";
inline constexpr const char* kConventionsOfFiles = "CF-1.8";

/// The attribute of a file with n, k and E0 as the scene has them: lines of name, wavelength in um, value.
inline constexpr const char* kSpectralData = "spectral_data";

/// The text of this attribute; empty for a table without curves.
std::string spectral_data_of(const TableHead& head);

/// Moves this attribute into the curves. Errors: InputError that begins with `name`.
void take_spectral_data(TableHead& head, const std::string& name);

/// The content of an attribute; null if there is none of this type.
template <class Content>
const Content* find_attribute(const TableHead& head, std::string_view name) {
  const auto found = std::ranges::find(head.attributes, name, &Attribute::name);
  return found == head.attributes.end() ? nullptr : std::get_if<Content>(&found->value);
}

/// The names of the coordinates other than axes, as files list them.
std::string coordinates_of(const TableHead& head);

/// Layout of a table, known before its values.
struct TableLayout {
  TableHead head;
  Quantities quantities;
  bool has_status = true;
  std::vector<ResponseVariable> responses = {};
};

/// The layout of a table in memory.
TableLayout layout_of(const TableValues& table);

/// Calls use(of, width) for each variable, in the order of files: of(values) is its column in TableValues, `width` the
/// number of its values for each entry.
template <class Use>
void for_each_variable(const TableLayout& layout, const Use& use) {
  for (const Quantity quantity : layout.quantities)
    use(
        [=](auto& table) -> auto& { return table[quantity]; }, std::size_t{1});
  for (const ResponseVariable variable : layout.responses)
    use(
        [=](auto& table) -> auto& { return table.responses[variable]; }, layout.head.width_of(variable));
  if (layout.has_status)
    use(
        [](auto& table) -> auto& { return table.status; }, std::size_t{1});
}

/// Shape: a column for each of `quantities`, and the status.
ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities);

/// A part of a table: `count` values of each axis, from `first`.
struct TableBox {
  PerAxis first = {};
  PerAxis count = {};
};

/// Cuts a table into boxes of at most `most` entries, but at least one, in the order of the table.
std::vector<TableBox> boxes_in_order(const PerAxis& counts, std::size_t most);

/// The head of a part of a table.
TableHead head_of(const TableHead& whole, const TableBox& box);

/// The attribute with the hash of a table's values, which detects damage.
inline constexpr const char* kValuesHash = "values_hash";

/// Sums over the values of each variable, in the order of for_each_variable. Each value's bits are multiplied by an odd
/// number that follows from the value's place, so that another value or place changes the sum. Parts may come in any
/// order.
using ValueSums = std::vector<std::uint64_t>;

/// The sums over a part of a table that begins at `first`.
ValueSums sums_of(const TableValues& part, const TableLayout& layout, const PerAxis& first);

/// Adds the sums of another part.
void add(ValueSums& sums, const ValueSums& of_part);

/// The hash of all values, with axes and curves of the head.
std::string values_hash(const TableLayout& layout, const ValueSums& sums);

}  // namespace dolp
