// Entries that need no evaluator: mirrors, and the limits at 90 degrees of moments that diverge there.
#pragma once

#include <vector>

#include "model/moments.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// A surface so smooth that its slopes' density overflows a float.
bool is_mirror(const SlopeShape& shape);

/// Whether the evaluator has to compute an entry; the others have closed forms.
bool needs_evaluator(const Scene& scene, const SceneEntry& entry);

/// The cosine that the closed form of an entry is for.
double closed_form_cosine(const SceneEntry& entry);

/// Moments of an entry that has closed forms, for each index.
std::vector<Moments> closed_forms(const Scene& scene, const SceneEntry& entry,
                                  const std::vector<OpticalConstants>& indices);

}  // namespace dolp
