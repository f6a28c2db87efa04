// Slopes that differ along and across (../../../shaders/physics/README.md, section 12): the density of the facets is a
// series of azimuthal orders, cos(2 k phi). The kernel computes slope samples of each order.
#pragma once

#include <cstddef>

#include "model/moments.hpp"

namespace dolp {

struct SlopeOrders {
  std::size_t highest = 0;  ///< largest order k; 0 if all slope distributions are isotropic
  std::size_t sectors = 1;  ///< sectors (slope_sectors()) that represent an elliptic distribution
};

/// The orders whose neglected successors change moments by less than a share of the tolerance. It depends only on the
/// most eccentric distribution of the request.
SlopeOrders slope_orders(const MomentsRequest& request);

/// Largest quotient of the widths along and across for which the orders suffice at this tolerance.
double largest_width_ratio(double tolerance);

/// Additional nodes on a half turn that resolve the highest order.
int nodes_of_orders(const SlopeOrders& orders);

/// Bound of the orders that follow the two last ones, whose parts of a moment are `last` and `before_last`.
/// Equation: the facets of order k fall like e^k, with the eccentricity e. The moments of one facet slope fall, too, so
/// the orders fall faster.
double neglected_orders(double eccentricity, double before_last, double last);

}  // namespace dolp
