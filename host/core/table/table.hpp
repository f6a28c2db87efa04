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

inline constexpr std::size_t kMostTableEntries = std::size_t{1} << 36U;

inline constexpr const char* kConventions = "Conventions";
inline constexpr const char* kConventionsOfFiles = "CF-1.8";

/// Attribute with the scene's n, k and E0. Each line of its text has a name, a wavelength in um and a value.
inline constexpr const char* kSpectralData = "spectral_data";

std::string spectral_data_text(const TableHead& head);

/// Moves n, k and E0 from the attribute kSpectralData to `head`'s curves. Errors: InputError that begins with `name`.
void take_spectral_data(TableHead& head, const std::string& name);

template <class Content>
const Content* find_attribute(const TableHead& head, std::string_view name) {
  const auto found = std::ranges::find(head.attributes, name, &Attribute::name);
  return found == head.attributes.end() ? nullptr : std::get_if<Content>(&found->value);
}

/// Value of the CF attribute `coordinates`: names, separated by blanks, of coordinates that are no axes, such as
/// index_n.
std::string coordinate_names(const TableHead& head);

/// The layout of a table: everything that is known before its values.
struct TableLayout {
  TableHead head;
  Quantities quantities;
  bool has_status = true;
  std::vector<ResponseVariable> responses = {};
  std::vector<DerivativeColumn> derivatives = {};  ///< without values
};

/// Attribute with the keys of the derivatives in a table, separated by commas.
inline constexpr const char* kDerivativeKeys = "derivatives";

std::vector<std::string> derivative_keys(const TableHead& head);  ///< the keys in this attribute
inline constexpr std::size_t kDerivativesPerKey = 3;
/// The kDerivativesPerKey columns for each key of `keys`, without values and units.
std::vector<DerivativeColumn> derivative_columns(const std::vector<std::string>& keys);

TableLayout values_layout(const TableValues& table);

/// The names of the variables, in the order of the file.
std::vector<std::string> variable_names(const TableLayout& layout);

/// Calls use(of, width) for each variable, in the order of the file. `of` is a function that returns the variable's
/// column in a TableValues; `width` is the number of values per entry.
template <class Use>
void for_each_variable(const TableLayout& layout, const Use& use) {
  for (const Quantity quantity : layout.quantities)
    use(
        [=](auto& table) -> auto& { return table[quantity]; }, std::size_t{1});
  for (const ResponseVariable variable : layout.responses)
    use(
        [=](auto& table) -> auto& { return table.responses[variable]; }, layout.head.values_per_entry(variable));
  for (std::size_t i = 0; i < layout.derivatives.size(); ++i)
    use(
        [i](auto& table) -> auto& { return table.derivatives[i].values; }, std::size_t{1});
  if (layout.has_status)
    use(
        [](auto& table) -> auto& { return table.status; }, std::size_t{1});
}

TableHead part_head(const TableHead& whole, const GridBox& box);

/// Name of the attribute with the hash of a table's values, by which a reader detects damage.
inline constexpr const char* kValuesHash = "values_hash";

/// One checksum per variable, in the order of for_each_variable. The table's checksum is the sum over its parts.
using ValueSums = std::vector<std::uint64_t>;

ValueSums value_sums(const TableValues& part, const TableLayout& layout, const PerAxis& first);

void add(ValueSums& sums, const ValueSums& part_sums);

/// Hash over the checksums of all values, the axes, and the optical curves (n, k and E0) that layout.head stores.
std::string values_hash(const TableLayout& layout, const ValueSums& sums);

}  // namespace dolp
