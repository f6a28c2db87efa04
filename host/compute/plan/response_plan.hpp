#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "model/response_basis.hpp"

namespace dolp {

/// A plan for a request with many indices. The kernels compute a few responses, and weighted sums of the responses give
/// the moments (model/response_basis.hpp). For a given basis, the result of an entry does not depend on other entries.
struct ResponsePlan {
  struct Source {
    std::optional<ResponseWeights> weights;  ///< weights of the responses; empty if the index is computed directly
    std::size_t other = 0;                   ///< without weights: position of the index in `others`
  };
  /// Where the data of a point are: the position of the point in each pass, the position of the index in `sources` and,
  /// if the index has no weights, the position of the point in `others`.
  struct PointSource {
    std::uint32_t pass = 0;
    std::uint32_t source = 0;
    std::uint32_t other = 0;
  };
  /// Requests for responses at the reference index, at all directions and slope distributions: for the reflected light,
  /// for the direct emission (if wanted), and for the reflected light times each function of the sky.
  std::vector<MomentsRequest> passes;
  std::optional<MomentsRequest> others;                ///< request for indices, or for points, that have no weights
  std::shared_ptr<const std::vector<Source>> sources;  ///< one for each index; points with the same index share one
  std::vector<PointSource> points;

  ResponsePlan select_directions(std::span<const std::size_t> directions) const;
};

std::size_t response_passes(bool wants_direct, std::size_t sky_functions);

ResponsePlan response_plan(const MomentsRequest& request);

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others);

}  // namespace dolp
