// The hemispherical moments of V-grooves with all bounces. Follows beams and their electric vectors in space.
#pragma once

#include "model/moments.hpp"
#include "reference/hemisphere.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// The moments of a rough surface (sigma > 0) of symmetric V-grooves, all bounces included, k_s = 1.
///
/// Equation: r = int P t dt dphi sum_k w_k |E_k|^2 over the facets that are met first, w_k the flux that leaves a
///   groove after k bounces over half of its width, |E_k|^2 the intensity then, the mean for s and p light; the
///   absorbed part is the sum over the absorption of all bounces.
/// Domain: theta in [0, 90] degrees; at 90 all are 0, the limit.
/// Accuracy: the errors returned. They meet `refinement` unless many steep grooves reflect much, which is too much
/// work:
///   metals reach 1e-8 to 1e-4 of r_i, total reflection at q close to 1 reaches nothing. Grooves steeper than the last
///   slope followed reflect between nothing and twice its share (test
///   ReferenceGrooves.CoarseQuadrature_StaysWithinItsErrors).
Moments groove_moments(const Slopes& slopes, double theta_deg, const FacetOptics& constants,
                       const Refinement& refinement, const SkyFunction* sky = nullptr);

/// Balance of the light that enters one groove, over both facets. All values are per width of the aperture, so the
/// albedo is cos(theta).
struct GrooveLight {
  double albedo = 0.0;          ///< flux that leaves if nothing is absorbed
  double reflected = 0.0;       ///< I that leaves, for unpolarised light
  double polarised = 0.0;       ///< Q: half the difference of the light that leaves for s light and for p light
  double absorbed = 0.0;        ///< absorbed by all bounces
  double lost = 0.0;            ///< I after the last followed bounce; it counts as neither reflected nor absorbed
  double once_reflected = 0.0;  ///< I that leaves after one bounce
  double once_absorbed = 0.0;   ///< absorbed by the first bounce
  double sky_reflected = 0.0;   ///< `reflected` with the function of the sky
  double sky_polarised = 0.0;   ///< `polarised` with the function of the sky
  double bounces = 0.0;         ///< followed
};

/// Domain: t > 0; cos(theta) > 0; chi = 90 degrees - phi, with sin_chi = cos(phi).
GrooveLight light_in_groove(double t, double sin_chi, double cos_chi, const Zenith& view, const FacetOptics& constants,
                            const SkyFunction* sky = nullptr);

}  // namespace dolp::reference
