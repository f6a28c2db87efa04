// The columns that a result has in CSV files of points and curves.
#pragma once

#include <string>
#include <vector>

#include "evaluate/radiometry/radiometry.hpp"
#include "scene/points.hpp"

namespace dolp::cli {

inline constexpr const char* kResultColumns =
    "rho_i,rho_q,albedo,stokes_i,stokes_q,stokes_u,stokes_v,dolp,error_estimate,rho_error_estimate,status";

/// The cells of a row in the order of kResultColumns.
std::string result_cells(const PointResult& result);

/// The columns of the points as they were given, and those of their results.
std::string result_csv(const Points& points, const std::vector<PointResult>& results);

}  // namespace dolp::cli
