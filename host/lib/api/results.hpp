// Results of points, in the types of the public header.
#pragma once

#include <dolp/dolp.hpp>

#include <dolp/results.hpp>
#include "scene/points.hpp"
#include "table/table.hpp"

namespace dolp {

/// `head`: that of the table that a run over the points would write, or of the table that was read.
Results results_of(const std::vector<PointResult>& points, const Quantities& quantities, const TableHead& head);

/// Points of columns, as many as the columns that have not one value for all; one where there is none.
/// Errors: InputError for a column that is unknown, has another length, or has a value out of range.
Points points_of_columns(const std::vector<Column>& columns, PointsKind kind);

}  // namespace dolp
