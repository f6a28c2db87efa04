// The columns that a result has in CSV files of points and curves.
#pragma once

#include <string>
#include <vector>

#include "model/point_result.hpp"

namespace dolp {

/// Columns that not every scene has.
struct ExtraColumns {
  bool emissivity = false;  ///< emissivity_s, emissivity_p
  bool bracket = false;     ///< dolp_low, dolp_high
};

/// The names of the columns, with commas between them.
std::string result_header(const ExtraColumns& extra);

/// All columns that a result may have.
std::vector<std::string> result_columns();

/// Appends the cells of a row in the order of the header.
void append_result_cells(std::string& text, const PointResult& result, const ExtraColumns& extra);

}  // namespace dolp
