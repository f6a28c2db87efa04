// Selects which moments of a request with many indices the kernels compute, and combines the other moments from these
// (model/response_basis.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "model/response_basis.hpp"

namespace dolp {

/// The plan of a request that has a basis. The result of an entry does not depend on the other entries.
struct ResponsePlan {
  /// Source of the moments of one index.
  struct Source {
    std::optional<ResponseWeights> weights;  ///< weights of the responses; empty if the index is computed directly
    std::size_t other = 0;                   ///< position in the indices of `others`, if there are no weights
  };
  /// Positions of a point in three lists: the points of each pass, which differ from each other in direction or slope
  /// distribution; `sources`; and the points of `others`, if the source has no weights.
  struct PointSource {
    std::uint32_t pass = 0;
    std::uint32_t source = 0;
    std::uint32_t other = 0;
  };
  /// Each pass has the request's directions and slope distributions at the reference index. The first has responses of
  /// the reflected light. If they are wanted, further passes have responses of the direct emission, and of the
  /// reflected light weighted with each function of the sky.
  std::vector<MomentsRequest> passes;
  std::optional<MomentsRequest> others;                ///< the indices, or points, that have no weights
  std::shared_ptr<const std::vector<Source>> sources;  ///< one per index of a grid, or per distinct index of points
  std::vector<PointSource> points;                     ///< one for each point

  /// The plan for some directions of a grid.
  ResponsePlan of_directions(std::span<const std::size_t> directions) const;
};

/// The number of passes for a request.
std::size_t response_passes(bool wants_direct, std::size_t sky_functions);

/// The plan of a request that has a basis.
ResponsePlan response_plan(const MomentsRequest& request);

/// Combines the moments of a request from the moments of its passes and of its others.
std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others);

}  // namespace dolp
