#include "evaluate/run/grazing_limit.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>

#include "evaluate/radiometry/smooth_surface.hpp"

namespace dolp {
namespace {

constexpr double kRelativeError = 1e-12;

}  // namespace

Moments grazing_limit_moments(const OpticalConstants& index, double q) {
  boost::math::quadrature::tanh_sinh<double> integrator;
  // phi = pi/2 - psi, so that x = sin(psi) keeps its digits at grazing incidence, where the power is not smooth.
  const auto integral = [&](auto&& of_cosine) {
    const auto integrand = [&](double psi) {
      const double x = std::sin(psi);
      return x > 0.0 ? std::pow(x, 4.0 - 2.0 * q) * of_cosine(x) : 0.0;
    };
    return integrator.integrate(integrand, 0.0, boost::math::constants::half_pi<double>());
  };
  Moments moments;
  moments.albedo = integral([](double) { return 1.0; });
  moments.r_i = integral([&](double x) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, x);
    return 1.0 - 0.5 * (absorbed.s + absorbed.p);
  });
  moments.r_q = integral([&](double x) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, x);
    return 0.5 * (absorbed.s - absorbed.p);
  });
  moments.deficit = -moments.r_i;
  moments.albedo_error = kRelativeError * moments.albedo;
  moments.r_i_error = moments.r_q_error = moments.deficit_error = kRelativeError * moments.albedo;
  return moments;
}

}  // namespace dolp
