#include "cli/result_csv.hpp"

#include "table/atomic_file.hpp"

namespace dolp::cli {

std::string result_cells(const PointResult& r) {
  std::string cells;
  for (const double value : {r.rho_i, r.rho_q, r.albedo, r.stokes_i, r.stokes_q, r.stokes_u, r.stokes_v, r.dolp,
                             r.error_estimate, r.rho_error_estimate}) {
    cells += number_text(value) + ',';
  }
  return cells + std::to_string(r.status);
}

std::string result_csv(const Points& points, const std::vector<PointResult>& results) {
  std::string csv = points.header + ',' + kResultColumns + '\n';
  for (std::size_t i = 0; i < results.size(); ++i) csv += points.rows[i] + ',' + result_cells(results[i]) + '\n';
  return csv;
}

}  // namespace dolp::cli
