#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "model/moments.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// Two different settings give two nearly independent values.
struct Refinement {
  double relative_tolerance = 1e-9;  ///< for r_i, albedo and absorbed part; the error of r_q is relative to r_i
  int subdivisions = 1;              ///< equal parts of each first panel
};

/// A function of the zenith of the reflected ray, for ColumnMoments.
struct SkyFunction {
  std::function<double(double zenith_deg)> value;
  std::vector<double> corners_deg;
};

/// Number of functions that replace (R_s + R_p) / 2 and (R_s - R_p) / (2 sin^2). Their values are in [-1, 1].
inline constexpr std::size_t kCurves = 24;
using Curves = std::function<std::array<double, kCurves>(double cos_beta)>;

/// The cosine and the sine are exact at 0 and 90 degrees.
Zenith zenith_from_deg(double theta_deg);

/// The moments of a rough surface (sigma > 0) with k_s = 1, and with a function of the sky.
/// Equation: r = cos(theta) int f cos(theta_r) sin(theta_r) dtheta_r dDelta_phi, eqs. (7), (15), (16), over theta_r
/// (outer) and delta = pi - Delta_phi (inner).
/// Domain: theta in [0, 90] degrees. At 90 degrees all four are limits: 0 for v-cavity and smith, else finite. For the
/// Cauchy distribution with q <= 3/2, which has too many vertical facets, they are infinite.
Moments hemisphere_moments(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                           const Refinement& refinement, const SkyFunction* sky = nullptr);

/// r_i and r_q, relative to the albedo, with curves instead of the reflectances. The curves bend at the cosine `bend`.
std::vector<ColumnMoments> hemisphere_responses(const Slopes& slopes, Masking masking, double theta_deg,
                                                const Curves& curves, double bend, const Refinement& refinement);

/// The moments of a mirror (sigma = 0), with its direct emission.
Moments mirror_moments(double theta_deg, const FacetOptics& constants);

/// The moments of a rough surface (sigma > 0) of symmetric V-grooves with all bounces, for k_s = 1.
///
/// Equation: r = int P t dt dphi sum_k w_k |E_k|^2 over the facets that are met first. w_k is the flux that leaves a
/// groove after k bounces, over half of its width. |E_k|^2 is the intensity then, the mean for s and p light. The
/// absorbed part is the sum over the absorption of all bounces.
/// Domain: theta in [0, 90] degrees; at 90 degrees all are 0, the limit.
/// Accuracy: the returned errors. They meet `refinement`, unless this is too much work because many steep grooves
/// reflect much: metals reach 1e-8 to 1e-4 of r_i, total reflection at q close to 1 reaches nothing. Grooves steeper
/// than the last slope followed reflect 0 to 2 times its share (test
/// ReferenceGrooves.CoarseQuadrature_StaysWithinItsErrors).
Moments groove_moments(const Slopes& slopes, double theta_deg, const FacetOptics& constants,
                       const Refinement& refinement, const SkyFunction* sky = nullptr);

/// The light that enters one groove, over both facets, per width of the aperture; so the albedo is cos(theta).
struct GrooveLight {
  double albedo = 0.0;          ///< flux that leaves if nothing is absorbed
  double reflected = 0.0;       ///< I that leaves, for unpolarised light
  double polarised = 0.0;       ///< Q: half the difference between the light that leaves for s light and for p light
  double absorbed = 0.0;        ///< absorbed by all bounces
  double lost = 0.0;            ///< I after the last followed bounce; it counts as neither reflected nor absorbed
  double once_reflected = 0.0;  ///< I that leaves after one bounce
  double once_absorbed = 0.0;   ///< absorbed by the first bounce
  double sky_reflected = 0.0;   ///< `reflected` with the function of the sky
  double sky_polarised = 0.0;   ///< `polarised` with the function of the sky
  double bounces = 0.0;         ///< number of followed bounces
};

/// Domain: t > 0; cos(theta) > 0; chi = 90 degrees - phi, with sin_chi = cos(phi).
GrooveLight light_in_groove(double t, double sin_chi, double cos_chi, const Zenith& view, const FacetOptics& constants,
                            const SkyFunction* sky = nullptr);

/// The direct emission of a rough surface (sigma > 0): direct_i, direct_q and their errors. All other members are 0.
/// Equation: cos(theta) eps = int P t dt dphi e G_1 (1 - |r|^2) in the view's frame, over all facets with e =
/// cos(theta) + sin(theta) t cos(phi) > 0. G_1 is the masking of the view.
/// Domain: masking smith or v-cavity; theta in [0, 90] degrees; at 90 degrees both are 0, the limit.
/// Accuracy: the tolerance of `refinement`, relative to direct_i.
Moments direct_emission(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                        const Refinement& refinement);

/// The direct emission with a curve instead of 1 - (R_s + R_p) / 2 and (R_p - R_s) / (2 sin^2). The accuracy is
/// relative to cos(theta). The curve bends at the cosine `bend`.
Moments direct_response(const Slopes& slopes, Masking masking, double theta_deg,
                        const std::function<double(double cos_beta)>& curve, double bend, const Refinement& refinement);

}  // namespace dolp::reference
