#include "calibrate/random_entries.hpp"

#include <cmath>
#include <numbers>

namespace dolp {
namespace {

MomentsPoint ordinary_entry(Draws& draw, double q_end) {
  MomentsPoint entry;
  entry.theta_deg = draw.chance(0.1) ? 5.0 * std::floor(draw.uniform(0.0, 17.0)) : draw.uniform(0.0, 85.0);
  entry.shape = {draw.log_uniform(0.01, 2.0), draw.chance(0.1) ? 2.0 : q_end + draw.log_uniform(0.1, 10.0)};
  const double kind = draw.uniform(0.0, 3.0);
  entry.index = {draw.uniform(1.1, 5.0), kind < 1.0 ? 0.0 : draw.log_uniform(1e-3, 1.0)};
  if (kind > 2.0) entry.index = {draw.log_uniform(1.1, 30.0), draw.log_uniform(1.0, 50.0)};
  return entry;
}

double corner_theta_deg(Draws& draw) {
  const double kind = draw.uniform(0.0, 1.0);
  if (kind < 0.05) return 0.0;
  if (kind < 0.15) return draw.log_uniform(1e-3, 5.0);
  return kind < 0.45 ? 90.0 - draw.log_uniform(1e-4, 5.0) : draw.uniform(0.0, 90.0);
}

OpticalConstants corner_index(Draws& draw, double theta_deg) {
  const double kind = draw.uniform(0.0, 1.0);
  if (kind < 0.1) {  // near the critical angle
    const double beside = (draw.chance(0.5) ? 1.0 : -1.0) * draw.log_uniform(1e-6, 0.1);
    return {std::max(std::sin(theta_deg * std::numbers::pi / 180.0) * (1.0 + beside), 0.02), 0.0};
  }
  if (kind < 0.35) return {draw.log_uniform(0.03, 1.0), 0.0};
  if (kind < 0.5) return {draw.log_uniform(0.03, 1.0), draw.log_uniform(1e-8, 0.3)};
  if (kind < 0.65) return {1.0 + draw.log_uniform(1e-4, 0.3), draw.chance(0.5) ? 0.0 : draw.log_uniform(1e-5, 0.3)};
  if (kind < 0.8) return {draw.log_uniform(0.02, 1.0), draw.log_uniform(0.3, 30.0)};
  if (kind < 0.9) return {draw.uniform(1.3, 4.0), 0.0};
  return {draw.log_uniform(0.2, 100.0), draw.log_uniform(0.1, 100.0)};
}

MomentsPoint corner_entry(Draws& draw, double q_end) {
  MomentsPoint entry;
  entry.theta_deg = corner_theta_deg(draw);
  entry.shape.sigma = draw.log_uniform(draw.chance(0.3) ? 1e-3 : 0.01, 10.0);
  entry.shape.q = draw.chance(0.1) ? 2.0 : q_end + draw.log_uniform(2e-3, draw.chance(0.3) ? 0.2 : 20.0);
  entry.index = corner_index(draw, entry.theta_deg);
  return entry;
}

}  // namespace

double least_q(Distribution distribution, Masking masking) {
  return masking == Masking::kSmith && distribution == Distribution::kCauchy ? 1.5 : 1.0;
}

MomentsPoint random_entry(Draws& draw, Domain domain, Distribution distribution, Masking masking) {
  const double q_end = least_q(distribution, masking);
  return domain == Domain::kOrdinary ? ordinary_entry(draw, q_end) : corner_entry(draw, q_end);
}

}  // namespace dolp
