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
/// given basis, the result of an entry of a grid does not depend on other entries.
struct ResponsePlan {
  struct Source {
    std::optional<ResponseWeights> weights;  ///< weights of the responses; empty if the index is computed directly
    std::size_t other = 0;                   ///< without weights: position of the index in `others`
  };
  /// Where the data of a point are.
  struct PointSource {
    std::uint32_t pass = 0;              ///< its position in each pass, or in `interpolation`
    std::uint32_t source = 0;            ///< the position of its index in `sources`
    std::optional<std::uint32_t> other;  ///< its position in `others`, if it is computed directly
  };
  /// Requests for responses at the reference index, at all directions and slope distributions: for the reflected light,
  /// for the direct emission (if wanted), and for the reflected light times each function of the sky.
  std::vector<MomentsRequest> passes;
  std::optional<MomentsRequest> others;  ///< request for the indices, or points, that are computed directly
  std::shared_ptr<const std::vector<Source>> sources;  ///< one for each index; points with the same index share one
  std::vector<PointSource> points;
  std::optional<PointPlan> interpolation;  ///< if set, the passes are for its nodes

  ResponsePlan select_directions(std::span<const std::size_t> directions) const;
};

std::size_t response_passes(bool wants_direct, std::size_t sky_functions);

/// Returns nullopt for a list to which responses save no work.
std::optional<ResponsePlan> response_plan(const MomentsRequest& request);

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others);

}  // namespace dolp
