// Estimates of what a run leaves out or would change, from a few of its entries on the CPU.
//
// The entries are spread over the axes, the ends of each included; a band of many spectral samples is looked at in a
// few wavelengths.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// What an estimate has looked at.
struct Looked {
  std::size_t entries = 0;
  std::size_t wavelengths = 1;  ///< of each entry
  std::string text() const;     ///< "32 entries and 8 wavelengths of the band"
};

/// Estimates what each kept part changes: the largest difference of (Q/I, U/I) between the scene with everything and
/// without the part. None where no entry promises its DOLP both ways.
///
/// Accuracy: within a factor of 2 of the largest of all entries (tests Estimates_*).
Looked add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries);

/// How far single scattering may be off.
struct ScatteringGap {
  double dolp = 0.0;
  Looked looked;
};

/// The largest difference of DOLP between the emission 1 - rho, which counts all that meets a second facet as emitted,
/// and the direct one, which counts none of it. None where the scene follows all bounces, where its emission is not
/// that of its facets, with a masking without direct emission, in bistatic mode, and where nothing depends on the
/// moments or no entry promises its DOLP.
///
/// Accuracy: as above.
std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan);

/// The largest PointResult::model_change of the entries that promise their DOLP.
double estimated_model_change(const SceneValues& scene, const SceneEntries& entries);

}  // namespace dolp
