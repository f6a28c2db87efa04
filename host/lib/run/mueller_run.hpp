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

/// The directions, slope distribution and index of each point. Values that a point lacks come from the scene, n and k
/// at its wavelength. Errors: InputError that names file, key or line and column, and what is allowed. It refuses
/// points that check_surface() refuses, and bands with a coating, or with variable n and k that points lack.
std::vector<MuellerPoint> mueller_points(const SceneValues& scene, const Points& points);

/// Replaces kAuto by float if kScatteringErrorFloat meets the tolerance or double precision is missing, else by double.
Precision mueller_precision(const Accuracy& accuracy, bool has_double);

/// The pBRDF f of eq. (15) with k_s and the diffuse part, in the order of `points`. Accuracy: the error of each element
/// is at most kScatteringErrorFloat or kScatteringErrorDouble times m00, the first element. Domain: at 90 degrees f is
/// its limit, which exists with v-cavity or smith masking if only one of the two beams is at 90 degrees. All 16
/// elements are NaN where f has no finite value: elsewhere at 90 degrees, and in the specular direction if the surface
/// is a mirror (sigma = 0) or all bounces count. They are also NaN where uncomputed bounces contribute
/// (plan/further_bounces.cpp). In other directions f of a mirror is the diffuse part. Errors: errors of the evaluator.
std::vector<MuellerMatrix> evaluate_mueller(const SceneValues& scene, const std::vector<MuellerPoint>& points,
                                            ModelEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
