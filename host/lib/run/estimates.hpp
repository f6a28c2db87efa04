// Estimates of how much the effects of a scene change, and of how wrong its model may be. The CPU computes a few
// entries, which are spread over the axes and include their ends. In a band with many spectral samples, it computes
// only a few wavelengths.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Up to `count` positions below `size`, which a fixed sequence spreads evenly, in ascending order.
std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count);

/// All entries if there are at most `count`, otherwise the entries at drawn_positions().
SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count);

/// How many entries and wavelengths an estimate has computed.
struct Looked {
  std::size_t entries = 0;
  std::size_t wavelengths = 1;  ///< number of wavelengths per entry
  std::string text() const;     ///< "32 entries and 8 wavelengths of the band"
};

/// Sets Effect::influence of the kept effects: the largest difference of (Q/I, U/I) between the scene with everything
/// and without the effect. It stays empty if no entry promises its DOLP with and without the effect. Accuracy: within a
/// factor of 2 of the largest difference at all entries (tests Estimates_*).
Looked add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries);

/// How wrong the DOLP of single scattering may be.
struct ScatteringGap {
  double dolp = 0.0;
  Looked looked;
};

/// The largest difference of DOLP between the emission 1 - rho, which counts all light that meets a second facet as
/// emitted, and the direct emission, which counts no such light. Empty if the scene follows all bounces, is in bistatic
/// mode, has no emission or that of a smooth surface, or has a masking without direct emission; if nothing depends on
/// the moments; or if no entry promises its DOLP. Accuracy: as for add_influences().
std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan);

/// The largest PointResult::model_change of the computed entries that promise their DOLP.
double estimated_model_change(const SceneValues& scene, const SceneEntries& entries);

}  // namespace dolp
