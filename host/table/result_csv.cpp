#include "table/result_csv.hpp"

#include "base/number_text.hpp"

namespace dolp {

std::string result_cells(const PointResult& r) {
  std::string cells;
  for (const double value : {r.rho_i, r.rho_q, r.albedo, r.stokes_i, r.stokes_q, r.stokes_u, r.stokes_v, r.dolp,
                             r.error_estimate, r.rho_error_estimate}) {
    cells += number_text(value) + ',';
  }
  return cells + std::to_string(r.status);
}

}  // namespace dolp
