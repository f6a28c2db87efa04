// Intervals from the profile likelihood.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "fit/descent.hpp"

namespace dolp::fit {

/// Coordinates that the data do not exclude. At 0 and 1 the range ends before they do.
struct Stretch {
  double low = 0.0;
  double high = 1.0;
};

struct ProfileOptions {
  std::array<double, 2> rises{};  ///< growth of the objective at the ends, ascending
  double from = 0.0;              ///< the objective that rises count from: the least, or 0
  double scale = 1.0;             ///< change of the objective by one standard deviation
  Loss loss = Loss::kSquares;
  std::function<void(std::size_t done, std::size_t total)> count;  ///< counts sides
};

struct Profiles {
  /// For each parameter and rise, where the objective, least over all others, lies below. Apart, ascending.
  std::vector<std::array<std::vector<Stretch>, 2>> stretches;
  std::vector<Minimum> points = {};  ///< known points of the profiles
  /// A point below the best minimum: there is another one, and the rest is not complete.
  std::optional<Minimum> lower = {};
};

/// The profiles of all parameters around minima, the best first, that lie below the second rise.
///
/// Each side follows the valley from a minimum: at each coordinate of the parameter, the other parameters descend from
/// where the derivatives at the nearest point lead, until the root of the growth is met to 0.5 %. A bent valley has
/// several branches. Beyond each end, the ends of the other sides descend too, unless a straight way leads to them: if
/// one comes below the rise, the profile goes on from there. Errors: errors of the evaluator; Cancelled.
Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options);

}  // namespace dolp::fit
