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

/// The directions, slope distribution and index of each point. Values that a point lacks come from the scene. Errors:
/// InputError if check_surface() refuses a point, if the scene has measured reflectances, if it has a band and a
/// coating, or if it has a band and a material that depends on the wavelength while the points lack column n or k.
std::vector<MuellerPoint> mueller_points(const SceneValues& scene, const Points& points);

/// Bound of the error of each element of a matrix, relative to its first element.
double mueller_error(const SceneValues& scene);

/// The Mueller matrix of the pBRDF at each point: the specular part times k_s, plus the diffuse part. Accuracy:
/// mueller_error(). All 16 elements are NaN where the pBRDF has no finite value, and where more bounces contribute than
/// are computed.
std::vector<MuellerMatrix> evaluate_mueller(const SceneValues& scene, const std::vector<MuellerPoint>& points,
                                            ModelEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
