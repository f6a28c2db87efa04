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
  std::uint64_t seed = 1;   ///< 1 for the Sobol sequence itself; any other seed shifts it by a random vector
  Loss loss = Loss::kSquares;
  bool has_uncertainties = true;  ///< false: the standard deviation follows from the residuals at a minimum
  double scale = 1.0;             ///< rise of the objective one standard deviation from a minimum; may be a guess
  std::function<void(std::size_t done, std::size_t total)> count = {};  ///< counts finished descents
};

/// Finds the distinct minima in which descents from the best points of a Sobol sequence end, the lowest first. If
/// parameters have a start, the first descent begins there. All descents advance together, in rounds of a few steps. A
/// descent stops after a round if it has reached the path of a lower one. `coarse`, with a wider tolerance, finds
/// minima. `fine` then descends to the bottom of each that is at most kFarAbove times the scale above the lowest one.
/// Two minima count as one if a path between them rises by at most `scale`: a line, or the floor of the valley beside
/// it. Empty if no descent converged. Errors: errors of the evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const SearchOptions& options);

/// An interval of a coordinate that the data do not exclude. The range of the parameter is 0 to 1.
struct Stretch {
  double low = 0.0;
  double high = 1.0;
};

struct ProfileOptions {
  std::array<double, 2> rises{};  ///< growths at the ends of the 68 % and 95 % intervals, divided by the scale
  double from = 0.0;              ///< objective from which growth is counted: of the best minimum, or 0
  double scale = 1.0;             ///< rise of the objective one standard deviation from a minimum
  Loss loss = Loss::kSquares;
  std::function<void(std::size_t done, std::size_t total)> count;  ///< counts the finished sides of all profiles
};

struct Profiles {
  /// For each parameter and each of ProfileOptions::rises: the stretches of the parameter in which the growth of the
  /// objective, minimised over all other parameters, is below the rise. They are disjoint and in ascending order.
  std::vector<std::array<std::vector<Stretch>, 2>> stretches;
  std::vector<Minimum> points = {};  ///< computed points of the profiles
  /// A point that is lower than the best minimum. It shows that a minimum is missing and the profiles are incomplete.
  std::optional<Minimum> lower = {};
};

/// The profile likelihoods of all parameters around the given minima, which lie below the second rise, the best one
/// first. Each side of a profile follows the valley of the objective from a minimum. At each coordinate, derivatives at
/// the nearest known point predict the other parameters, and a descent from there finds their minimum. The side ends
/// where the square root of the growth meets that of the rise to 0.5 %. A bent valley has several branches. So descents
/// beyond each end also start from the ends of the other sides, unless a straight path joins both ends. If one of them
/// arrives below the rise, the profile continues from there. Errors: errors of the evaluator; Cancelled.
Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options);

}  // namespace dolp::fit
