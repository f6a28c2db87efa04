// The minima that a fit finds from many starts, and intervals from the profile likelihood.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fit/descent.hpp"

namespace dolp::fit {

struct SearchOptions {
  std::size_t starts = 24;  ///< largest number of descents
  std::uint64_t seed = 1;   ///< 1: the Sobol sequence itself; other seeds shift it by a random vector
  Loss loss = Loss::kSquares;
  bool has_uncertainties = true;  ///< else the residuals of a minimum give the standard deviation
  double scale = 1.0;             ///< a change of the objective by one standard deviation, or a guess of it
  std::function<void(std::size_t done, std::size_t total)> count = {};  ///< descents
};

/// Finds all distinct minima in which descents from the best points of a Sobol sequence end, the lowest first.
/// Parameters with a start add one descent from there. All descents advance together, in rounds of a few steps; after
/// each round, a descent that has reached the path of a lower one ends. `coarse` has a wider tolerance than `fine`: it
/// finds the minima, and `fine` goes to the bottom of each that lies less than 30 standard deviations of the objective
/// above the lowest. A point from which the floor of a valley leads down to a minimum, or that only a rise of less than
/// a standard deviation separates from it, is not a separate minimum. Empty when no descent converged. Errors:
/// errors of the evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const SearchOptions& options);

/// An interval of coordinates that the data do not exclude. At 0 and 1 the range ends.
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
  /// A point below the best minimum. Then there is another minimum, and the profiles are not complete.
  std::optional<Minimum> lower = {};
};

/// The profiles of all parameters around minima, the best first, that lie below the second rise.
///
/// Each side follows the valley from a minimum: at each coordinate of the parameter, the other parameters descend from
/// where the derivatives at the nearest point lead, until the root of the growth is met to 0.5 %. A bent valley has
/// several branches. Beyond each end, the ends of the other sides descend too, unless a straight way leads to them: if
/// one comes below the rise, the profile continues from there. Errors: errors of the evaluator; Cancelled.
Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options);

}  // namespace dolp::fit
