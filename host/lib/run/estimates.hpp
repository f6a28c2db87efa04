// Estimates how much effects of a scene change DOLP, and how wrong the model may be. The CPU computes a few entries,
// spread over the axes with their ends and, in a band with many spectral samples, at only a few wavelengths.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Up to `count` positions below `size`, in ascending order. A fixed sequence spreads them evenly.
std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count);

/// All entries if there are at most `count`, otherwise the entries at drawn_positions().
SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count);

/// The numbers of entries and wavelengths that an estimate has computed.
struct Looked {
  std::size_t entries = 0;
  std::size_t wavelengths = 1;  ///< number of wavelengths per entry
  std::string text() const;     ///< "32 entries and 8 wavelengths of the band"
};

/// Sets Effect::influence of each kept effect: the largest difference of (Q/I, U/I) between the scene with all effects
/// and the scene without this effect. It stays empty if promises_dolp() holds for no entry in both. Accuracy: within a
/// factor of 2 of the largest difference at all entries (tests Estimates_*).
Looked add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries);

/// An estimate of how wrong DOLP may be because the model follows only one reflection.
struct ScatteringGap {
  double dolp = 0.0;
  Looked looked;
};

/// The largest difference of DOLP between two emission models: 1 - rho, where all light that meets a second facet
/// counts as emitted, and direct emission, where no such light counts. The result is empty in bistatic mode; if the
/// scene follows all bounces; without emission or with the emission of a smooth surface; if the masking has no direct
/// emission; if nothing depends on the moments; or if promises_dolp() holds for no entry. Accuracy: as for
/// add_influences().
std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan);

/// The largest PointResult::model_change of a few computed entries, of those for which promises_dolp() holds.
double estimated_model_change(const SceneValues& scene, const SceneEntries& entries);

}  // namespace dolp
