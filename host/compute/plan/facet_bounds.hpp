// Bounds of the moments and of the beam that hold without integrating anything: microseconds on the host.
#pragma once

#include <span>

#include "model/slopes.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// How close bounds of the reflectance are: coarse ones know the masking alone, middle ones few shells of slopes, at a
/// sixth of the time of fine ones.
enum class Detail { kCoarse, kMiddle, kFine };

/// Bounds of the specular reflectance in one direction, k_s = 1; infinite where there is none.
struct ReflectanceBounds {
  double most_i = 0.0;   ///< of rho_s, hence of rho_I and rho_p
  double most_q = 0.0;   ///< of |rho_Q|
  double least_i = 0.0;  ///< of rho_I, from below
};

/// Bounds that hold for each of the indices, so for every mean over them.
///
/// Derivation, with the notation of shaders/physics/facet.glsl: rho c = integral of P t dt over the slopes of
/// 2 * integral of e G M over the azimuths whose ray leaves, G <= 1, and e <= max(c + s t cos(phi), 0), whose azimuthal
/// mean g(t) is c up to s t = c and (c acos(-z) + s t sqrt(1 - z^2)) / pi, z = c / (s t), beyond, and grows with t. On
/// a shell of slopes [t0, t1] the integral with M = 1 is so at most (its share of the facets) * g(t1). No ray leaves
/// beyond the horizon t = (1 + s) / c. There M00 + M01 <= R_s and |M01| <= R_s / 2, because 0 <= R_p <= R_s, and R_s
/// falls with cos(beta), which is at least cos(theta + alpha1), and more than c sqrt(1 + t0^2) / 2 for a ray that
/// leaves (0 < cos(theta_r) = 2 cos(alpha) cos(beta) - c). v-cavity and smith keep A <= 1: the shells are then filled
/// from the best reflecting one down to a sum of 1, and e G <= 2 c with v-cavity. none and `integral` have no such end.
///
/// From below: facets up to a slope T below c / (1 + s) send every ray up, e averages to c over their azimuths, and
/// M00 >= R_s / 2 >= R(normal) / 2. G is 1 (none), at least 1/2 (`integral`), e G >= min(c - s T, 2 c, 2 cos(theta_r))
/// (v-cavity), G >= 1 / (1 + L + L_r) with L(theta) = E[(t_x - mu)+] / mu <= E|t_x| / (2 mu), mu = cot(theta) (smith).
/// Domain: theta in [0, 90] degrees, sigma >= 0; 90 degrees is infinite for none and `integral`.
ReflectanceBounds reflectance_bounds(const Surface& surface, double theta_deg, const SlopeShape& shape,
                                     std::span<const OpticalConstants> indices, Detail detail = Detail::kFine);

/// The same in a few operations, as if every facet reflected all: 1 where A <= 1, else 1 + tan(theta) E|t_x| / 2,
/// because g(t) <= c + s t / pi and the mean of t is pi/2 E|t_x|. Nothing from below.
ReflectanceBounds coarse_reflectance_bounds(const Surface& surface, double theta_deg, const SlopeShape& shape);

/// Bounds of f cos(theta_i) cos(theta_r) for k_s = 1, in 1/sr.
struct BeamBounds {
  double most_i = 0.0;   ///< of f_00
  double least_i = 0.0;  ///< of f_00, from below
  double most_qu = 0.0;  ///< of the length of (f_10, f_20)
};

/// The closed form D G M / 4 but for G: exact for none and v-cavity, in [1/2, 1] for `integral`, in [1 / (1 + L + L_r),
/// 1] for smith with L as above. For each of the indices. Infinite where f is not defined: of a mirror toward its
/// specular direction, and between beams at 90 degrees both.
BeamBounds beam_bounds(const Surface& surface, double theta_i_deg, double theta_r_deg, double delta_phi_deg,
                       const SlopeShape& shape, std::span<const OpticalConstants> indices);

}  // namespace dolp
