#pragma once

#include <functional>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// A function of the zenith, and the zeniths at which the function has kinks.
struct SkyFunction {
  std::function<double(double zenith_deg)> value;
  std::vector<double> corners_deg;
};

struct Estimate {
  double value = 0.0;
  double error = 0.0;  ///< bound of the error of `value`
};

/// Integral of mu^power t_+(mu) g(zenith) over the cosine mu of the zenith from 0 to 1. t_+ = 1 - (R_s + R_p) / 2 of
/// the smooth surface at this zenith, g is the function of the sky. Domain: power > 0.
/// Accuracy: the returned error, about 1e-12 of the integral of |mu^power t_+ g| (tests Transmission*).
using TransmissionIntegral = Estimate (*)(const FacetOptics& optics, double power, const SkyFunction& sky);

/// A TransmissionIntegral, by tanh-sinh quadrature between the kinks of t_+ and of g.
Estimate transmission_integral(const FacetOptics& optics, double power, const SkyFunction& sky);

}  // namespace dolp
