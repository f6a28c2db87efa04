// Selects the indices of a grid to compute, and combines the moments of the other indices from them
// (model/index_basis.hpp).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/index_basis.hpp"
#include "model/moments.hpp"

namespace dolp {

/// Plan for a grid with a basis. Each entry's part of it follows from the basis and the entry alone.
struct IndexPlan {
  /// Source of the moments of one index of the request.
  struct Source {
    std::optional<IndexWeights> weights;  ///< of the basis; none: the index is computed by itself,
    std::size_t node = 0;                 ///< as this one of the nodes
  };
  MomentsRequest nodes;  ///< the request's grid at the indices of the basis, then at those beyond its reach
  std::vector<Source> sources;
};

/// The plan of a request that has a basis.
IndexPlan index_plan(const MomentsRequest& request);

/// The moments of all shapes at one direction, whose cosine it gets, and one index, from those of the direction at all
/// nodes. Bounds are those of the basis, weighted, and the distance of the combined curve from that of the index.
void combine(const IndexPlan& plan, const IndexPlan::Source& source, double cosine, std::span<const Moments> nodes,
             std::span<Moments> moments);

}  // namespace dolp
