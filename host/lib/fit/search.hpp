// The starting points of a fit, and the minima that it finds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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
/// a standard deviation separates from it, is not a minimum of its own. Empty when no descent converged. Errors: those
/// of the evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const SearchOptions& options);

}  // namespace dolp::fit
