#pragma once

#include <boost/math/constants/constants.hpp>
#include <complex>
#include <utility>
#include <vector>

#include "model/facet_optics.hpp"
#include "reference/vectors.hpp"

namespace dolp::reference {

struct FresnelCoefficients {
  std::complex<double> r_s;
  std::complex<double> r_p;
  double absorbed_s = 0.0;  ///< 1 - |r_s|^2
  double absorbed_p = 0.0;  ///< 1 - |r_p|^2
};

/// beta is the angle of incidence on the facet. At normal incidence r_p = -r_s.
FresnelCoefficients fresnel(const FacetOptics& optics, double cos_beta);

/// The stack at single thicknesses of its films, for light with this angle of incidence, with weights whose sum is 1. A
/// mean over the normal distributions of the thicknesses is the weighted sum of values at these stacks. Equation:
/// Gauss-Legendre panels, at least six for each fringe, between 8 spreads below (but not below 0) and above.
std::vector<std::pair<FacetOptics, double>> single_stacks(const FacetOptics& optics, double cos_beta);

/// Reflection amplitudes of a medium under films. Source: Born and Wolf, Principles of Optics, section 1.6.2.
/// Equation: a layer of index N has q = sqrt(N^2 - sin^2(beta)). Its admittance y is q for s, q / N^2 for p. The
/// tangential fields (E, H) are (1, y) in the medium. From the lowest film to the highest, each film multiplies them by
/// [cos(d), -i sin(d) / y; -i y sin(d), cos(d)], where d = 2 pi q thickness, with the thickness in wavelengths. Above
/// the films r = (y_0 E - H) / (y_0 E + H), where y_0 = cos(beta) is the admittance of air. The code also multiplies
/// E and H by e^(i d) at each film, so that they stay finite in thick absorbing films. This factor cancels in r.
template <class Number, class Real>
Amplitudes<Number> stack_amplitudes(const FacetOptics& optics, const Real& cos_beta, const Real& sin2_beta) {
  using std::exp;
  using std::sqrt;
  const Number i(0, 1);
  const auto index_square = [](const OpticalConstants& index) {
    const Number n(index.n, index.k);
    return Number(n * n);
  };
  const auto reflected = [&](bool is_p) {
    const auto admittance = [&](const Number& n2, const Number& q) { return is_p ? Number(q / n2) : q; };
    const Number n2 = index_square(optics.index);
    Number e(1), h = admittance(n2, sqrt(Number(n2 - sin2_beta)));
    for (auto film = optics.films.rbegin(); film != optics.films.rend(); ++film) {
      const Number square = index_square(film->index);
      const Number q = sqrt(Number(square - sin2_beta));
      const Number y = admittance(square, q);
      const Number turned = exp(Number(i * (4 * boost::math::constants::pi<Real>() * Real(film->thickness)) * q));
      const Number cosine = (turned + Real(1)) / Real(2);
      const Number sine = (turned - Real(1)) / Number(0, 2);
      const Number above = cosine * e - i * sine * h / y;
      h = cosine * h - i * y * sine * e;
      e = above;
    }
    const Number y0(cos_beta);
    return Number((y0 * e - h) / (y0 * e + h));
  };
  return {reflected(false), reflected(true)};
}

}  // namespace dolp::reference
