#include "model/facet_optics.hpp"

#include <boost/container/small_vector.hpp>
#include <cmath>
#include <numbers>

namespace dolp {
namespace {

/// A medium at one angle: N^2, and q = sqrt(N^2 - sin^2 beta) with an imaginary part of at least 0.
struct Wave {
  std::complex<double> square;
  std::complex<double> q;
};

Wave wave_in(const OpticalConstants& index, double cosine) {
  const double n = index.n, k = index.k;
  const std::complex<double> square((n - k) * (n + k), 2.0 * n * k);
  const std::complex<double> of_q((n - 1.0) * (n + 1.0) - k * k + cosine * cosine, square.imag());
  return {square, std::sqrt(of_q)};
}

// Much faster than operator/, which guards against overflow that does not occur here.
std::complex<double> quotient(std::complex<double> a, std::complex<double> b) {
  return a * std::conj(b) / std::norm(b);
}

ReflectedAmplitudes interface_amplitudes(const Wave& above, const Wave& below) {
  const std::complex<double> p_above = below.square * above.q;
  const std::complex<double> p_below = above.square * below.q;
  return {quotient(above.q - below.q, above.q + below.q), quotient(p_above - p_below, p_above + p_below)};
}

}  // namespace

ReflectedAmplitudes film_amplitudes(const FacetOptics& optics, double cosine) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  boost::container::small_vector<Wave, 8> waves = {{1.0, cosine}};
  for (const Film& film : optics.films) waves.push_back(wave_in(film.index, cosine));
  waves.push_back(wave_in(optics.index, cosine));
  ReflectedAmplitudes r = interface_amplitudes(waves[waves.size() - 2], waves.back());
  for (std::size_t j = optics.films.size(); j-- > 0;) {
    const ReflectedAmplitudes own = interface_amplitudes(waves[j], waves[j + 1]);
    const std::complex<double> turn =
        std::exp(std::complex<double>(0.0, 2.0 * kTwoPi * optics.films[j].thickness) * waves[j + 1].q);
    r = {quotient(own.s + r.s * turn, 1.0 + own.s * r.s * turn),
         quotient(own.p + r.p * turn, 1.0 + own.p * r.p * turn)};
  }
  return r;
}

double fringe_count(const FacetOptics& optics) {
  double fringes = 0.0;
  for (const Film& film : optics.films) {
    const double normal = wave_in(film.index, 1.0).q.real();
    const double grazing = wave_in(film.index, 0.0).q.real();
    fringes += 2.0 * film.thickness * (normal - grazing);
  }
  return fringes;
}

}  // namespace dolp
