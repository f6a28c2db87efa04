// Which moments the entries of a scene want.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "model/scene_entry.hpp"
#include "plan/attempts.hpp"

namespace dolp {

/// The entry as the moments see it: in bistatic mode they are those of the view direction.
SceneEntry seen_entry(const Scene& scene, const SceneEntry& entry);

/// What the evaluator is asked for, and where the moments of each entry are in its answer.
struct MomentsBlock {
  MomentsRequest request;
  std::vector<std::uint32_t> first_moments;  ///< meaningless for entries with closed forms
};

/// The moments of these entries at each of the scene's spectral samples, or at their own index. An entry that repeats
/// the one before it, as those do that differ in the q of a gaussian alone, shares its moments; in bistatic mode all
/// entries of one surface do, whatever the source's direction.
MomentsBlock moments_block(const Scene& scene, const std::vector<OpticalConstants>& samples,
                           std::span<const SceneEntry> entries, const Attempt& attempt);

}  // namespace dolp
