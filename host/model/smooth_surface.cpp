#include "model/smooth_surface.hpp"
#include "model/moments.hpp"
#include "model/optical_constants.hpp"

#include <complex>
#include <limits>

namespace dolp {

SmoothAbsorptance smooth_absorptance(const OpticalConstants& index, double cosine) {
  using Complex = std::complex<double>;
  // (n - 1)(n + 1) keeps the digits of N^2 - 1 where n is close to 1.
  const Complex square_minus_one((index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k);
  const Complex square = square_minus_one + 1.0;
  const Complex w = std::sqrt(square_minus_one + cosine * cosine);
  return {4.0 * cosine * w.real() / std::norm(cosine + w),
          4.0 * cosine * (std::conj(square) * w).real() / std::norm(square * cosine + w)};
}

Moments mirror_moments(const OpticalConstants& index, double cosine) {
  const SmoothAbsorptance absorbed = smooth_absorptance(index, cosine);
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * cosine;
  Moments moments;
  moments.albedo = cosine;
  moments.deficit = 0.5 * (absorbed.s + absorbed.p) * cosine;
  moments.r_i = cosine - moments.deficit;
  moments.r_q = 0.5 * (absorbed.p - absorbed.s) * cosine;
  // Vacuum reflects nothing, exactly.
  moments.r_i_error = moments.r_i == 0.0 ? 0.0 : rounding;
  moments.r_q_error = moments.r_i == 0.0 ? 0.0 : rounding;
  moments.albedo_error = rounding;
  moments.deficit_error = rounding * 0.5 * (absorbed.s + absorbed.p);
  moments.direct_i = moments.deficit;
  moments.direct_q = -moments.r_q;
  moments.direct_i_error = moments.direct_q_error = moments.deficit_error;
  return moments;
}

}  // namespace dolp
