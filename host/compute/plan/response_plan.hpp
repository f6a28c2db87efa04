// Selects which moments of a request with many indices to compute, and combines the others from them
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

/// Plan for a request with a basis. An entry's result does not depend on the other entries.
struct ResponsePlan {
  /// Source of the moments of one index.
  struct Source {
    std::optional<ResponseWeights> weights;  ///< weights of the responses; empty if the index is computed directly
    std::size_t other = 0;                   ///< position in the indices of `others`, if there are no weights
  };
  /// Positions of a point in three lists: the points of the passes, which all differ in direction or slope
  /// distribution; the sources; and the points of `others`, if its source has no weights.
  struct PointSource {
    std::uint32_t pass = 0;
    std::uint32_t source = 0;
    std::uint32_t other = 0;
  };
  /// The request's directions and slope distributions at the reference index, with responses of the reflected light;
  /// then, if they are wanted, of the direct emission, and of the reflected light with each function of the sky.
  std::vector<MomentsRequest> passes;
  std::optional<MomentsRequest> others;                ///< the indices, or points, that have no weights
  std::shared_ptr<const std::vector<Source>> sources;  ///< one per index of a grid, or per different index of points
  std::vector<PointSource> points;                     ///< one for each point

  /// The plan of some directions of a grid.
  ResponsePlan of_directions(std::span<const std::size_t> directions) const;
};

/// Number of passes of a request.
std::size_t response_passes(bool wants_direct, std::size_t sky_functions);

/// The plan of a request that has a basis.
ResponsePlan response_plan(const MomentsRequest& request);

/// The moments of a request, from the moments of the passes and of the others.
std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others);

}  // namespace dolp
