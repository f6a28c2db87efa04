// The hemispherical moments of one direction, integrated over the other direction.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "model/moments.hpp"
#include "reference/attenuation.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// Accuracy of the integrals. Two different settings give two nearly independent values.
struct Refinement {
  double relative_tolerance = 1e-9;  ///< for r_i, albedo and absorbed part; the error of r_q is relative to r_i
  int subdivisions = 1;              ///< equal parts of each first panel
};

/// A function of the zenith of the reflected ray, for ColumnMoments.
struct SkyFunction {
  std::function<double(double zenith_deg)> value;
  std::vector<double> corners_deg;
};

/// Number of the functions of cos(beta) that replace (R_s + R_p) / 2 and (R_s - R_p) / (2 sin^2). They have either sign
/// and are at most 1.
inline constexpr std::size_t kCurves = 24;
using Curves = std::function<std::array<double, kCurves>(double cos_beta)>;

/// Zenith angle in degrees, exact at 0 and 90.
Zenith zenith_from_deg(double theta_deg);

/// The moments of a rough surface (sigma > 0) with k_s = 1, and with a function of the sky.
/// Equation: r = cos(theta) int f cos(theta_r) sin(theta_r) dtheta_r dDelta_phi, eqs. (7), (15), (16), over
///   theta_r (outer) and delta = pi - Delta_phi (inner).
/// Domain: theta in [0, 90] degrees. At 90 degrees all four are limits: 0 for v-cavity and smith. For the other
/// maskings they are finite, except for the Cauchy distribution with q <= 3/2: it has too many vertical facets, and
/// they are infinite.
Moments hemisphere_moments(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                           const Refinement& refinement, const SkyFunction* sky = nullptr);

/// The moments r_i and r_q with each curve instead of the reflectances, relative to the albedo. `bend` is the cosine at
/// which the curves bend.
std::vector<ColumnMoments> hemisphere_responses(const Slopes& slopes, Masking masking, double theta_deg,
                                                const Curves& curves, double bend, const Refinement& refinement);

/// The moments of a mirror (sigma = 0), with its direct emission.
Moments mirror_moments(double theta_deg, const FacetOptics& constants);

}  // namespace dolp::reference
