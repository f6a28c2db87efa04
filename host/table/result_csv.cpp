#include "table/result_csv.hpp"

#include "base/number_text.hpp"

namespace dolp {

std::string result_header(const ExtraColumns& extra) {
  std::string header = "rho_i,rho_q,albedo,stokes_i,stokes_q,stokes_u,stokes_v,dolp,error_estimate,rho_error_estimate,";
  if (extra.emissivity) header += "emissivity_s,emissivity_p,";
  if (extra.bracket) header += "dolp_low,dolp_high,";
  return header + "status";
}

std::string result_cells(const PointResult& r, const ExtraColumns& extra) {
  std::string cells;
  const auto add = [&](std::initializer_list<double> values) {
    for (const double value : values) cells += number_text(value) + ',';
  };
  add({r.rho_i, r.rho_q, r.albedo, r.stokes_i, r.stokes_q, r.stokes_u, r.stokes_v, r.dolp, r.error_estimate,
       r.rho_error_estimate});
  if (extra.emissivity) add({r.emissivity_s, r.emissivity_p});
  if (extra.bracket) add({r.dolp_low, r.dolp_high});
  return cells + std::to_string(r.status);
}

}  // namespace dolp
