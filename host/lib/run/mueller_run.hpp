// The Mueller pBRDF of a scene's surface at scattered geometries.
#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "model/scattering.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One geometry and surface.
struct MuellerPoint {
  BeamAngles angles;
  SlopeShape shape;
  FacetOptics index;
};

/// Scattered geometries; values that they lack come from the scene, n and k at its wavelength.
/// Errors: InputError that names file, key or line and column, and what is allowed: a band with a material that depends
/// on the wavelength, unless the points have n and k both; q <= 3/2 with smith masking and the cauchy distribution.
std::vector<MuellerPoint> mueller_points(const SceneValues& scene, const Points& points);

/// The precision of a scene's pBRDFs. kAuto becomes float if kScatteringErrorFloat meets the tolerance or the evaluator
/// has no double, else double.
Precision mueller_precision(const Accuracy& accuracy, bool has_double);

/// f of eq. (15) with k_s and the diffuse part, in the order of `points`.
///
/// Accuracy: each element to kScatteringErrorFloat or kScatteringErrorDouble of m00.
/// Domain: at 90 degrees the limits, which v-cavity and smith have with one beam there. Where f has no finite value all
/// 16 are NaN: at 90 degrees otherwise, and for a mirror (sigma = 0) in its specular direction; in others its f is the
/// diffuse part. So they are where more bounces count than are followed (plan/further_bounces.cpp).
/// Errors: errors of the evaluator.
std::vector<MuellerMatrix> evaluate_mueller(const SceneValues& scene, const std::vector<MuellerPoint>& points,
                                            ModelEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
