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
  std::uint64_t seed = 1;   ///< 1: the Sobol sequence itself; other seeds shift the sequence by a random vector
  Loss loss = Loss::kSquares;
  bool has_uncertainties = true;  ///< false: the residuals at a minimum determine the standard deviation
  double scale = 1.0;  ///< how much the objective rises one standard deviation from a minimum; may be a guess
  std::function<void(std::size_t done, std::size_t total)> count = {};  ///< counts finished descents
};

/// Finds the distinct minima of the objective, the lowest first. Descents begin at the parameters' start, if they have
/// one, and at the best points of a Sobol sequence. `coarse`, with a wider tolerance, finds the minima. `fine` then
/// refines each minimum that is at most kFarAbove times the scale above the lowest. Two minima count as one if the
/// objective rises by at most the scale on a path between them. Empty if no descent converged. Errors: errors of the
/// evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const SearchOptions& options);

/// An interval of a coordinate (0 to 1 over the parameter's range) that the data do not exclude.
struct Stretch {
  double low = 0.0;
  double high = 1.0;
};

struct ProfileOptions {
  std::array<double, 2> rises{};  ///< growths at the ends of the 68 % and 95 % intervals, divided by the scale
  double from = 0.0;              ///< the growth is the objective minus this: the objective of the best minimum, or 0
  double scale = 1.0;             ///< rise of the objective one standard deviation from a minimum
  Loss loss = Loss::kSquares;
  std::function<void(std::size_t done, std::size_t total)> count;  ///< counts the finished sides of all profiles
};

struct Profiles {
  /// For each parameter and each of ProfileOptions::rises: the stretches of the parameter in which the growth is below
  /// the rise, if all other parameters minimise the objective. They are disjoint and ascending.
  std::vector<std::array<std::vector<Stretch>, 2>> stretches;
  std::vector<Minimum> points = {};  ///< computed points of the profiles
  /// A point below the best minimum, if one was found. It shows that the search missed a minimum.
  std::optional<Minimum> lower = {};
};

/// The profile likelihoods of all parameters around the given minima, the best one first. Each side of a profile
/// follows the valley of the objective from a minimum, until the growth meets the rise. A bent valley may have branches
/// beyond this end. So descents beyond each end also start from the ends of other sides. If a descent ends below the
/// rise, the profile continues from there. Errors: errors of the evaluator; Cancelled.
Profiles profiles_of(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options);

}  // namespace dolp::fit
