// Which pBRDFs the entries of a bistatic scene want: what the source sends toward the view.
#pragma once

#include <span>
#include <vector>

#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "radiometry/radiometry.hpp"

namespace dolp {

/// Whether the evaluator has to compute the beam of an entry: not of a mirror, nor with source and view both at 90
/// degrees.
bool needs_scattering(const Scene& scene, const SceneEntry& entry);

/// The pBRDFs of these entries that the evaluator has to compute, at each of the scene's spectral samples or at their
/// own index.
ScatteringRequest beams_request(const Scene& scene, const std::vector<OpticalConstants>& samples,
                                std::span<const SceneEntry> entries, Precision precision);

/// The beam of each entry and sample, from the answer to beams_request. A mirror sends nothing but toward its specular
/// direction, where the radiance is not defined, as it is not with source and view both at 90 degrees.
std::vector<Scattered> entry_beams(const Scene& scene, std::size_t sample_count, std::span<const SceneEntry> entries,
                                   std::span<const ScatteringMatrix> matrices);

}  // namespace dolp
