#include "reference/fresnel.hpp"

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <numbers>

#include "base/interrupt.hpp"
#include "reference/film_spread.hpp"

namespace dolp::reference {
namespace {

FresnelCoefficients bare_coefficients(const OpticalConstants& constants, double cos_beta) {
  const std::complex<double> refractive_index{constants.n, constants.k};
  const std::complex<double> n2 = refractive_index * refractive_index;
  // w = sqrt(N^2 - sin^2(beta)), in a form that gives exactly cos(beta) for N = 1
  const std::complex<double> w = std::sqrt((refractive_index - 1.0) * (refractive_index + 1.0) + cos_beta * cos_beta);
  const std::complex<double> below_s = cos_beta + w;
  const std::complex<double> below_p = n2 * cos_beta + w;
  FresnelCoefficients result;
  result.r_s = (cos_beta - w) / below_s;
  result.r_p = (n2 * cos_beta - w) / below_p;
  result.absorbed_s = 4.0 * cos_beta * w.real() / std::norm(below_s);
  result.absorbed_p = 4.0 * cos_beta * (std::conj(n2) * w).real() / std::norm(below_p);
  return result;
}

FresnelCoefficients measured_coefficients(const MeasuredReflectance& measured, double cos_beta) {
  const double beta_deg = std::acos(std::min(cos_beta, 1.0)) * 180.0 / std::numbers::pi;
  std::size_t i = 1;
  while (i + 1 < measured.beta_deg.size() && measured.beta_deg[i] < beta_deg) ++i;
  const double before = measured.beta_deg[i - 1];
  const double after = measured.beta_deg[i];
  const auto between = [&](double a, double b) {
    return (a * (after - beta_deg) + b * (beta_deg - before)) / (after - before);
  };
  double r_s = between(measured.r_s[i - 1], measured.r_s[i]);
  double r_p = between(measured.r_p[i - 1], measured.r_p[i]);
  if (i == 1) {
    const double ratio = std::sin(beta_deg * std::numbers::pi / 180.0) / std::sin(after * std::numbers::pi / 180.0);
    const double half = 0.5 * (measured.r_s[1] - measured.r_p[1]) * ratio * ratio;
    const double mean = 0.5 * (r_s + r_p);
    // The difference is at most so large that both reflectances are in [0, 1]. Their mean stays as it is.
    const double excess = std::max({0.0, std::abs(half) - mean, std::abs(half) - (1.0 - mean)});
    r_s = std::max(mean + half - std::copysign(excess, half), 0.0);
    r_p = std::max(mean - half + std::copysign(excess, half), 0.0);
  }
  return {std::sqrt(r_s), std::sqrt(r_p), 1.0 - r_s, 1.0 - r_p};
}

}  // namespace

FresnelCoefficients fresnel(const FacetOptics& optics, double cos_beta) {
  if (interrupted()) throw Cancelled();  // one entry may take minutes
  if (optics.measured) return measured_coefficients(*optics.measured, cos_beta);
  if (optics.films.empty()) return bare_coefficients(optics.index, cos_beta);
  if (has_spread(optics)) return mean_coefficients(optics, cos_beta);
  const auto r = stack_amplitudes<std::complex<double>>(optics, cos_beta, (1.0 - cos_beta) * (1.0 + cos_beta));
  return {r.s, r.p, 1.0 - std::norm(r.s), 1.0 - std::norm(r.p)};
}

}  // namespace dolp::reference
