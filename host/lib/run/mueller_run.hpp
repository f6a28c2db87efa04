#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "model/scattering.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

struct MuellerPoint {
  BeamAngles angles;
  SlopeShape shape;
  FacetOptics index;
};

/// The geometries and surfaces of scattered points. Missing values come from the scene, with n and k at its wavelength.
/// Errors: InputError that names file, key or line and column, and what is allowed. It refuses a band if the material
/// depends on the wavelength, unless the points have n and k; and points that check_surface() refuses.
std::vector<MuellerPoint> mueller_points(const SceneValues& scene, const Points& points);

/// kAuto becomes float if kScatteringErrorFloat meets the tolerance or double precision is missing, otherwise double.
Precision mueller_precision(const Accuracy& accuracy, bool has_double);

/// The pBRDF f of eq. (15) with k_s and the diffuse part, in the order of `points`. Accuracy: the error of each element
/// is at most kScatteringErrorFloat or kScatteringErrorDouble times m00.
/// Domain: at 90 degrees f is its limit, which v-cavity and smith have if only one of the two beams is at 90 degrees.
/// All 16 elements are NaN where f has no finite value: elsewhere at 90 degrees, and in the specular direction for a
/// mirror (sigma = 0) and for all bounces. They are also NaN where bounces contribute that are not computed
/// (plan/further_bounces.cpp). In other directions f of a mirror is the diffuse part. Errors: errors of the evaluator.
std::vector<MuellerMatrix> evaluate_mueller(const SceneValues& scene, const std::vector<MuellerPoint>& points,
                                            ModelEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
