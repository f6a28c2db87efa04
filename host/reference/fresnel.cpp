#include "reference/fresnel.hpp"

namespace dolp::reference {

FresnelCoefficients fresnel(const OpticalConstants& constants, double cos_beta) {
  const std::complex<double> refractive_index{constants.n, constants.k};
  const std::complex<double> n2 = refractive_index * refractive_index;
  // N^2 - sin^2 beta, written so that w = cos(beta) exactly for N = 1
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

}  // namespace dolp::reference
