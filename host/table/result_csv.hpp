// The columns that a result has in CSV files of points and curves.
#pragma once

#include <string>

#include "model/point_result.hpp"

namespace dolp {

inline constexpr const char* kResultColumns =
    "rho_i,rho_q,albedo,stokes_i,stokes_q,stokes_u,stokes_v,dolp,error_estimate,rho_error_estimate,status";

/// The cells of a row in the order of kResultColumns.
std::string result_cells(const PointResult& result);

}  // namespace dolp
