#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "model/response_basis.hpp"
#include "plan/shape_plan.hpp"

namespace dolp {

/// A plan for a request with many indices, or with many points. The kernels compute a few responses, and weighted sums
/// of the responses give the moments (model/response_basis.hpp). The responses of many points are interpolated. For a
/// given basis, the result of an entry does not depend on other entries, unless the request is scattered.
struct ResponsePlan {
  /// Weights of the responses; empty if the index is computed directly.
  using Source = std::optional<ResponseWeights>;
  using Sources = std::shared_ptr<const std::vector<Source>>;  ///< one for each index of the request
  /// Where the data of a bundle are.
  struct BundleSource {
    std::uint32_t pass = 0;              ///< position of its geometry in the bundles of each pass
    std::optional<std::uint32_t> other;  ///< its position in the bundles of `others`, if it is computed directly
  };
  /// Requests for responses at the reference index, at all directions and slope distributions: for the reflected light,
  /// for the direct emission (if wanted), and for the reflected light times each function of the sky.
  std::vector<MomentsRequest> passes;
  std::optional<MomentsRequest> others;  ///< request for the bundles that are computed directly
  Sources sources;
  std::vector<BundleSource> bundles;       ///< one for each bundle of the request
  std::optional<PointPlan> interpolation;  ///< if set, the passes are for its nodes
};

std::size_t response_passes(bool wants_direct, std::size_t sky_functions);

/// Returns nullopt for scattered points to which responses save no work. `known`: the sources, if they are known.
std::optional<ResponsePlan> response_plan(const MomentsRequest& request, ResponsePlan::Sources known = {});

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others);

}  // namespace dolp
