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
  bool has_uncertainties = true;  ///< false: the residuals of a minimum give the standard deviation
  double scale = 1.0;             ///< change of the objective by one standard deviation, or a guess of it
  std::function<void(std::size_t done, std::size_t total)> count = {};  ///< counts finished descents
};

/// Finds all distinct minima in which descents from the best points of a Sobol sequence end, the lowest first. If
/// parameters have a start, one more descent begins there. All descents advance together, in rounds of a few steps;
/// after a round, a descent ends if it has reached the path of a lower one. `coarse`, with a wider tolerance, finds the
/// minima. `fine` descends to the bottom of those that are at most kFarAbove times the scale above the lowest one. Two
/// minima count as one if the floor of a valley leads down from the higher to the lower one, or rises by less than a
/// standard deviation. Empty if no descent converged. Errors: errors of the evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const SearchOptions& options);

/// An interval of coordinates that the data do not exclude. 0 and 1 are the ends of the parameter's range.
struct Stretch {
  double low = 0.0;
  double high = 1.0;
};

struct ProfileOptions {
  std::array<double, 2> rises{};  ///< growths of the objective at the ends of both intervals, divided by the scale
  double from = 0.0;              ///< objective above which growth is counted: that of the best minimum, or 0
  double scale = 1.0;             ///< change of the objective by one standard deviation
  Loss loss = Loss::kSquares;
  std::function<void(std::size_t done, std::size_t total)> count;  ///< counts finished sides of profiles
};

struct Profiles {
  /// For each parameter and rise: the stretches in which the objective, minimised over all other parameters, is below
  /// the rise. They are disjoint and in ascending order.
  std::vector<std::array<std::vector<Stretch>, 2>> stretches;
  std::vector<Minimum> points = {};  ///< known points of the profiles
  /// A point below the best minimum. If there is one, another minimum exists, and the profiles are incomplete.
  std::optional<Minimum> lower = {};
};

/// The profiles of all parameters around the given minima, which lie below the second rise; the best one comes first.
/// Each side of a profile follows the valley from a minimum. At each coordinate, derivatives at the nearest known point
/// lead the other parameters to a start, from which they descend, until the square root of the growth meets the rise to
/// 0.5 %. A bent valley has several branches. So descents beyond each end also start from the ends of the other sides,
/// unless a straight path joins both ends. If one arrives below the rise, the profile continues from there. Errors:
/// errors of the evaluator; Cancelled.
Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options);

}  // namespace dolp::fit
