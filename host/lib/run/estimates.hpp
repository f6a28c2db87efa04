// Estimates of what a run leaves out or changes, from a few of its entries on the CPU.
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

/// Up to `count` of the positions below `size`, ascending: spread evenly by a fixed sequence that does not resonate
/// with the axes of a grid.
std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count);

/// All entries if there are at most `count`, else the entries at drawn positions.
SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count);

/// The entries that an estimate has looked at.
struct Looked {
  std::size_t entries = 0;
  std::size_t wavelengths = 1;  ///< wavelengths of each entry
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

/// The largest difference of DOLP between the emission 1 - rho, which counts all light that meets a second facet as
/// emitted, and the direct emission, which counts no such light. None if the scene follows all bounces, if its emission
/// is that of a smooth surface, with a masking without direct emission, in bistatic mode, and if nothing depends on the
/// moments or no entry promises its DOLP.
///
/// Accuracy: within a factor of 2 of the largest of all entries (tests Estimates_*).
std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan);

/// The largest PointResult::model_change of the entries that promise their DOLP.
double estimated_model_change(const SceneValues& scene, const SceneEntries& entries);

}  // namespace dolp
