#include "table/result_csv.hpp"

#include <sstream>

#include "base/number_text.hpp"

namespace dolp {

std::string result_header(const ExtraColumns& extra) {
  std::string header = "rho_i,rho_q,albedo,stokes_i,stokes_q,stokes_u,stokes_v,dolp,error_estimate,rho_error_estimate,";
  if (extra.emissivity) header += "emissivity_s,emissivity_p,";
  if (extra.bracket) header += "dolp_low,dolp_high,";
  return header + "status";
}

std::vector<std::string> result_columns() {
  std::vector<std::string> columns;
  std::istringstream header(result_header({.emissivity = true, .bracket = true}));
  for (std::string name; std::getline(header, name, ',');) columns.push_back(name);
  return columns;
}

void append_result_cells(std::string& text, const PointResult& r, const ExtraColumns& extra) {
  const auto add = [&text](std::initializer_list<double> values) {
    for (const double value : values) {
      append_number(text, value);
      text += ',';
    }
  };
  add({r.rho_i, r.rho_q, r.albedo, r.stokes_i, r.stokes_q, r.stokes_u, r.stokes_v, r.dolp, r.error_estimate,
       r.rho_error_estimate});
  if (extra.emissivity) add({r.emissivity_s, r.emissivity_p});
  if (extra.bracket) add({r.dolp_low, r.dolp_high});
  text += std::to_string(r.status);
}

}  // namespace dolp
