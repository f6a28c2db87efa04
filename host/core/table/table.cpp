#include "table/table.hpp"

#include <algorithm>
#include <array>

namespace dolp {
namespace {

constexpr const char* kDolpQualifiers = "error_estimate status";
constexpr const char* kRhoQualifiers = "rho_error_estimate status";
constexpr const char* kStatus = "status";

constexpr std::array<TableVariable, 14> kVariables = {{
    {"dolp", "degree of linear polarisation", false, kDolpQualifiers, &Table::dolp, &PointResult::dolp},
    {"stokes_i", "Stokes parameter I of the radiation that leaves the surface and reaches the sensor", true, kStatus,
     &Table::stokes_i, &PointResult::stokes_i},
    {"stokes_q", "Stokes parameter Q = I_s - I_p", true, kStatus, &Table::stokes_q, &PointResult::stokes_q},
    {"stokes_u", "Stokes parameter U", true, kStatus, &Table::stokes_u, &PointResult::stokes_u},
    {"stokes_v", "Stokes parameter V", true, kStatus, &Table::stokes_v, &PointResult::stokes_v},
    {"rho_i", "hemispherical-directional reflectance, mean of s and p", false, kRhoQualifiers, &Table::rho_i,
     &PointResult::rho_i},
    {"rho_q", "hemispherical-directional reflectance, half the difference of s and p", false, kRhoQualifiers,
     &Table::rho_q, &PointResult::rho_q},
    {"albedo", "albedo of the surface model with perfectly reflecting facets", false, kStatus, &Table::albedo,
     &PointResult::albedo},
    {"emissivity_s", "emissivity of s-polarised radiation that the emission uses", false, kStatus, &Table::emissivity_s,
     &PointResult::emissivity_s},
    {"emissivity_p", "emissivity of p-polarised radiation that the emission uses", false, kStatus, &Table::emissivity_p,
     &PointResult::emissivity_p},
    {"dolp_low", "least degree of linear polarisation with all bounces", false, kDolpQualifiers, &Table::dolp_low,
     &PointResult::dolp_low},
    {"dolp_high", "largest degree of linear polarisation with all bounces", false, kDolpQualifiers, &Table::dolp_high,
     &PointResult::dolp_high},
    {"error_estimate", "bound of the absolute error of dolp", false, "", &Table::error_estimate,
     &PointResult::error_estimate},
    {"rho_error_estimate", "bound of the errors of rho_i and rho_q relative to rho_i", false, "",
     &Table::rho_error_estimate, &PointResult::rho_error_estimate},
}};

}  // namespace

PerAxis TableHead::counts() const {
  PerAxis counts;
  for (std::size_t i = 0; i < kTableAxes.size(); ++i)
    counts[i] = std::max<std::size_t>((this->*kTableAxes[i]).size(), 1);
  return counts;
}

std::span<const TableVariable> table_variables() { return kVariables; }

TableVariables present_variables(const Table& table) {
  TableVariables present;
  for (const TableVariable& variable : kVariables) {
    if (!(table.*variable.values).empty()) present.push_back(&variable);
  }
  return present;
}

}  // namespace dolp
