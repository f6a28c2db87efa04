#include "evaluate/radiometry/smooth_surface.hpp"

#include <complex>

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

}  // namespace dolp
