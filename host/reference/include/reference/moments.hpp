#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "model/moments.hpp"
#include "model/transmission.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// Accuracy of the quadratures. Two computations with different settings have nearly independent errors.
struct Refinement {
  /// Tolerance of r_i, the albedo and the absorbed part, relative to each of them. For r_q it is relative to r_i.
  double relative_tolerance = 1e-9;
  int subdivisions = 1;  ///< initial number of panels between two neighbouring break points
};

/// Functions of cos(beta) within [-1, 1]. In integrals each replaces (R_s + R_p) / 2 and (R_s - R_p) / (2 sin^2(beta)).
inline constexpr std::size_t kCurves = 24;
using Curves = std::function<std::array<double, kCurves>(double cos_beta)>;

Zenith zenith_from_deg(double theta_deg);

/// The moments of a rough surface (sigma > 0) with k_s = 1. If `sky` is given, Moments::columns contains r_i, r_q and
/// r_u with the function `sky` as a factor of the integrand.
/// Equation: r = cos(theta) int f cos(theta_r) sin(theta_r) dtheta_r dDelta_phi with the pBRDF f, eqs. (7), (15), (16)
/// of Wang, Li, Wang 2025. The outer integral is over theta_r, the inner integral over delta = pi - Delta_phi.
/// Domain: theta in [0, 90] degrees. At 90 degrees the moments are 0 with v-cavity and smith masking. With other
/// maskings they are infinite for the cauchy with q <= 3/2, else finite.
Moments hemisphere_moments(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                           const Refinement& refinement, const SkyFunction* sky = nullptr);

/// r_i and r_q with each of the `curves` instead of the reflectances. The errors are relative to the albedo. `bend`:
/// cosine of the angle of incidence at which the curves bend sharply.
std::vector<ColumnMoments> hemisphere_responses(const Slopes& slopes, Masking masking, double theta_deg,
                                                const Curves& curves, double bend, const Refinement& refinement);

Moments mirror_moments(double theta_deg, const FacetOptics& constants);

/// A TransmissionIntegral, by adaptive Gauss-Kronrod quadrature over the zenith. Domain: a bare medium.
Estimate transmission_integral(const FacetOptics& optics, double power, const SkyFunction& sky);

/// The moments of a surface of symmetric V-grooves (sigma > 0) with all bounces, for k_s = 1.
/// Equation: r_i = int P(t) t dt dphi sum_k w_k |E_k|^2. The integral runs over the slope t and the azimuth phi of the
/// facet that the light meets first; P is the density of slopes. w_k is the flux that leaves a groove after k bounces,
/// divided by half the groove's width. |E_k|^2 is the intensity after k bounces, averaged over s and p light.
/// Domain: theta in [0, 90] degrees; at 90 degrees all moments are 0, which is the limit.
/// Accuracy: the returned errors. For many steep grooves of metal they exceed `refinement` and are 1e-8 to 1e-4 of r_i.
Moments groove_moments(const Slopes& slopes, double theta_deg, const FacetOptics& constants,
                       const Refinement& refinement, const SkyFunction* sky = nullptr);

/// The direct emission of a rough surface (sigma > 0): direct_i, direct_q, direct_u and their errors.
/// Equation: cos(theta) eps = int P(t) t dt dphi e G_1 (1 - |r|^2), with the slope density P, the masking G_1 toward
/// the viewer and the reflection amplitude r. The integral is over all facets (slope t, azimuth phi) with a projected
/// area e = cos(theta) + sin(theta) t cos(phi) > 0.
/// Domain: masking smith or v-cavity; theta in [0, 90] degrees. At 90 degrees both moments are 0.
Moments direct_emission(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                        const Refinement& refinement);

/// The direct emission if `curve` replaces both 1 - (R_s + R_p) / 2 and (R_p - R_s) / (2 sin^2(beta)). The errors are
/// relative to cos(theta). `bend`: cosine of the angle of incidence at which the curve bends sharply.
Moments direct_response(const Slopes& slopes, Masking masking, double theta_deg,
                        const std::function<double(double cos_beta)>& curve, double bend, const Refinement& refinement);

}  // namespace dolp::reference
