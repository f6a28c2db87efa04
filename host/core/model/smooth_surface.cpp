#include "model/smooth_surface.hpp"
#include "model/moments.hpp"
#include "model/optical_constants.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace dolp {

SmoothAbsorptance smooth_absorptance(const OpticalConstants& index, double cosine) {
  using Complex = std::complex<double>;
  // Squares of squares of what is smaller underflow, and what it absorbs is less than 4e-75.
  constexpr double kLeast = 1e-75;
  const double n = index.k < kLeast ? std::max(index.n, kLeast) : index.n;
  const double k = index.k;
  const Complex square((n - k) * (n + k), 2.0 * n * k);
  // N^2 - sin^2, keeping the digits of N^2 where it is small, and of N^2 - 1 where n is close to 1.
  const bool is_small = n < 0.5 && k < 0.5;
  const double real =
      is_small ? square.real() - (1.0 - cosine) * (1.0 + cosine) : (n - 1.0) * (n + 1.0) - k * k + cosine * cosine;
  const Complex w = std::sqrt(Complex(real, square.imag()));
  const double of_s = std::norm(cosine + w);
  const double of_p = std::norm(square * cosine + w);
  const double transmitted = 4.0 * cosine * w.real();
  return {transmitted / of_s, 4.0 * cosine * (std::conj(square) * w).real() / of_p,
          transmitted / of_s * (std::norm(square - 1.0) / of_p)};
}

double critical_cosine(const OpticalConstants& index) {
  constexpr double kSoft = 0.3;  // chosen, of Im N^2: from there on the rules need no line
  const double squared = (1.0 - index.n) * (1.0 + index.n) + index.k * index.k;
  const bool is_sharp = 2.0 * index.n * index.k < kSoft;
  return is_sharp && squared > 0.0 && squared < 1.0 ? std::sqrt(squared) : 0.0;
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
