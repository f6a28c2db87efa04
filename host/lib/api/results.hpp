// Results of points as the public header has them.
#pragma once

#include <dolp/dolp.hpp>

#include <dolp/results.hpp>
#include "scene/points.hpp"
#include "table/table.hpp"

namespace dolp {

/// `head`: of the table that a run over the points would have, or that was read.
Results results_of(const std::vector<PointResult>& points, const Quantities& quantities, const TableHead& head);

/// Points of columns, as many as the columns that have not one value for all; one where there is none.
/// Errors: InputError of the rooms.
Points points_of_columns(const std::vector<Column>& columns, PointsKind kind);

}  // namespace dolp
