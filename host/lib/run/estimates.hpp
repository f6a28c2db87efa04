// Estimates how much effects of a scene change DOLP, and how wrong the model may be. For this, the CPU computes a few
// entries that are spread over the axes. For a wide band, it computes them at a few wavelengths only.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "run/run_summary.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Up to `count` positions below `size`, in ascending order. A fixed sequence spreads them evenly.
std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count);

SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count);

struct Looked {
  std::size_t entries = 0;
  std::size_t wavelengths = 1;  ///< number of wavelengths per entry
  std::string text() const;     ///< "32 entries and 8 wavelengths of the band"
};

struct Influences {
  Looked looked;
  ModelChange model_change;  ///< of the entries
  double evaluations = 0.0;  ///< integrand evaluations that the influences took
};

/// Sets Effect::influence of each effect that the plan keeps: the largest change of the vector (Q/I, U/I) if a few
/// entries are computed without the effect. If the accuracy of DOLP is unknown for all of these entries, the influence
/// stays empty. Accuracy: within a factor of 2 of the largest change in all entries (tests Estimates_*).
Influences add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries,
                          const EffectPlan& plan);

struct ScatteringGap {
  double dolp = 0.0;
  Looked looked;
};

/// The largest difference of DOLP between two emission models. In the model 1 - rho, all light that meets a second
/// facet counts as emitted. In direct emission, none of this light does. Empty if the models do not apply to the scene,
/// for example in bistatic mode or if the scene follows all bounces. Accuracy: within a factor of 2.
std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan);

}  // namespace dolp
