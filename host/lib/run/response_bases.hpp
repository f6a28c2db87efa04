// The responses from which the moments of the indices of a run are combined.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "model/response_basis.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The bases of a run, one for each tolerance. They follow from the whole grid, of which the entries may be a part.
class ResponseBases {
 public:
  ResponseBases(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

  /// The basis of a level that may interpolate; null where it saves nothing: for a grid with few entries of each index,
  /// points that mostly differ in direction or slope distribution, few indices, and many bounces.
  std::shared_ptr<const ResponseBasis> of(const RefinementLevel& level);

 private:
  std::vector<FacetOptics> indices_;  ///< of the run; none where they are not combined
  std::size_t passes_;
  std::map<double, std::shared_ptr<const ResponseBasis>> of_tolerance_;
};

}  // namespace dolp
