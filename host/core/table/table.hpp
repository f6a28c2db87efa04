// Layout of a lookup table.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <dolp/table_values.hpp>
#include "model/axes.hpp"

namespace dolp {

/// The most entries that a table has.
inline constexpr std::size_t kMostTableEntries = std::size_t{1} << 36U;

/// The attribute for the conventions that a table file keeps, and its value.
inline constexpr const char* kConventions = "Conventions";
inline constexpr const char* kConventionsOfFiles = "CF-1.8";

/// The attribute of a file with n, k and E0 as the scene has them: lines of name, wavelength in um, value.
inline constexpr const char* kSpectralData = "spectral_data";

/// That attribute; empty for a table without curves.
std::string spectral_data_of(const TableHead& head);

/// Moves that attribute into the curves. Errors: InputError that begins with `name`.
void take_spectral_data(TableHead& head, const std::string& name);

/// The names of the coordinates that are no axes, as files list them.
std::string coordinates_of(const TableHead& head);

/// Layout of a table, known before its values.
struct TableLayout {
  TableHead head;
  Quantities quantities;
  bool has_status = true;
  std::vector<ResponseVariable> responses = {};
};

/// Shape: a column for each of `quantities`, and the status.
ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities);

}  // namespace dolp
