#include "run/beams.hpp"

#include <limits>

#include "model/grazing.hpp"
#include "run/closed_forms.hpp"
#include "run/distinct.hpp"

namespace dolp {
namespace {

BeamAngles angles_of(const Scene& scene, const SceneEntry& entry) {
  const Geometry& geometry = scene.geometry;
  return {entry.theta_deg, zenith_before_limit_deg(scene.surface.masking, geometry.view_zenith_deg),
          geometry.relative_azimuth_deg};
}

/// The first column of a pBRDF.
Scattered scattered(const ScatteringMatrix& f) { return {f.m[0], f.m[4], f.m[8], f.m[12], f.error}; }

Scattered without_evaluator(const BeamAngles& angles) {
  const bool is_undefined = !has_facet(angles) || is_specular(angles);
  const double glare = is_undefined ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  return {.i = glare, .q = glare};
}

}  // namespace

bool needs_scattering(const Scene& scene, const SceneEntry& entry) {
  return !is_mirror(entry.shape) && has_facet(angles_of(scene, entry));
}

ScatteringRequest beams_request(const Scene& scene, const std::vector<OpticalConstants>& samples,
                                std::span<const SceneEntry> entries, Precision precision) {
  ScatteringRequest request;
  request.distribution = scene.surface.distribution;
  request.masking = scene.surface.masking;
  request.precision = precision;
  Distinct<BeamAngles> angles(request.angles);
  Distinct<SlopeShape> shapes(request.shapes);
  Distinct<OpticalConstants> indices(request.indices);
  for (const SceneEntry& entry : entries) {
    if (!needs_scattering(scene, entry)) continue;
    ScatteringEntry wanted;
    wanted.angles = angles.position({entry.theta_deg, 0.0}, angles_of(scene, entry));
    wanted.shape = shapes.position({entry.shape.sigma, entry.shape.q}, entry.shape);
    for (const OpticalConstants& sample : samples) {
      const OpticalConstants index = entry.index.value_or(sample);
      wanted.index = indices.position({index.n, index.k}, index);
      request.entries.push_back(wanted);
    }
  }
  return request;
}

std::vector<Scattered> entry_beams(const Scene& scene, std::size_t sample_count, std::span<const SceneEntry> entries,
                                   std::span<const ScatteringMatrix> matrices) {
  std::vector<Scattered> beams;
  beams.reserve(entries.size() * sample_count);
  auto next = matrices.begin();
  for (const SceneEntry& entry : entries) {
    const bool is_evaluated = needs_scattering(scene, entry);
    for (std::size_t j = 0; j < sample_count; ++j) {
      beams.push_back(is_evaluated ? scattered(*next++) : without_evaluator(angles_of(scene, entry)));
    }
  }
  return beams;
}

}  // namespace dolp
