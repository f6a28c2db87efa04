// Intervals from the profile likelihood.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "fit/descent.hpp"

namespace dolp::fit {

/// An end of an interval: none where the parameter's range ends before the data exclude a value.
using IntervalEnd = std::optional<double>;

/// The points on one side of a minimum at which the objective, least over all other parameters, has grown by `rises`.
struct ProfileSide {
  std::array<IntervalEnd, 2> ends;  ///< coordinates, one for each rise; of one below zero none
  std::optional<Minimum> lower;     ///< a point below the minimum: there is another one
};

/// One side of a parameter's profile.
///
/// Follows the valley from the minimum: at each coordinate of the parameter the others descend from where derivatives
/// of the nearest point lead, until the root of the growth is met to 0.5 %. Arguments: `direction` -1 or 1; `deviation`
/// of the parameter, in coordinates, where the search begins; `rises` of the objective, ascending; `scale` as
/// SearchOptions::scale. Errors: those of the evaluator; Cancelled.
ProfileSide profile_side(Residuals& residuals, const Minimum& minimum, std::size_t parameter, int direction,
                         double deviation, const std::array<double, 2>& rises, double scale, Loss loss);

}  // namespace dolp::fit
