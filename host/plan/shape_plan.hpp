// Which moments of a request are computed, and which are interpolated between them.
//
// The entries of one direction and one index that differ in the slope distribution alone form a slab. Its moments are
// analytic in ln(sigma) and ln(q - 1), so that a dense slab follows from its values at a few Chebyshev nodes, to a
// tolerance of its own. A slab that has few entries, or is no grid, is computed entry by entry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "plan/shape_axis.hpp"

namespace dolp {

/// A dense slab: the positions of its entries in the request.
struct Slab {
  std::vector<std::uint32_t> entries;
};

/// How a request is computed. Follows from the request alone.
struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  std::vector<std::uint32_t> sigma_of;  ///< of each shape of the request its row of sigma.cardinal
  std::vector<std::uint32_t> q_of;
  std::vector<Slab> slabs;
  MomentsRequest nodes;                       ///< slab by slab, sigma by sigma: sigma.nodes x q.nodes entries each
  MomentsRequest direct;                      ///< what is not in a slab
  std::vector<std::uint32_t> direct_entries;  ///< positions in the request

  std::size_t nodes_of_a_slab() const { return sigma.nodes.size() * q.nodes.size(); }
};

/// The plan of a request, or none where every entry is computed by itself.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// The moments of a slab's entries, in the order of its entries, from those at its nodes. Bounds are those of the
/// nodes, weighted with the interpolant's own weights, and what the last Chebyshev coefficients say of the
/// interpolation.
std::vector<Moments> interpolated(const ShapePlan& plan, const Slab& slab, const MomentsRequest& request,
                                  std::span<const Moments> nodes);

}  // namespace dolp
