// Interpolation of a table at scattered points.
#pragma once

#include <dolp/errors.hpp>
#include <vector>

#include <dolp/results.hpp>
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table_lookup.hpp"

namespace dolp {

/// Looks up a table at points. Where points lack sigma, q or wavelength, those of `scene`, the table's own, are used.
/// An axis of one value needs no column; n, k and wavelength, where the table has no axis of them, must be the table's.
/// Errors: InputError that names the point, column, value and what the table has; Cancelled when `progress` returns
/// false.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

}  // namespace dolp
