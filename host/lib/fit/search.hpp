#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/descent.hpp"

namespace dolp::fit {

/// The items of a phase of the fit, for example descents: those that are done, and all.
struct Count {
  std::size_t done = 0;
  std::size_t total = 1;
};

/// The rise of the objective at one standard deviation from a minimum: 1 with uncertainties. Otherwise it is the mean
/// squared residual, but at least the squared tolerance.
double noise_scale(const Residuals& residuals, double minimum);

/// Finds the distinct minima of the objective, the lowest first. Descents begin at the parameters' start (if given) and
/// at the best points of a Sobol sequence. These descents use `coarse`, which has a wider tolerance. Then descents with
/// `fine` improve the lowest minimum, and each minimum that is higher by at most kFarAbove * scale. Two minima count as
/// one if the objective rises by at most the scale on a path between them. The result is empty if no descent converged.
/// With FitOptions::seed = 1 the points are the Sobol sequence itself; other seeds shift them by a random vector.
/// `scale` is a guess, see DescentOptions. `descents` counts the descents. Errors: errors of the evaluator; Cancelled.
std::vector<Minimum> find_minima(Residuals& coarse, Residuals& fine, const FitOptions& options, double scale,
                                 Count& descents);

/// Descends from all starts to the distinct minima, as defined at find_minima().
std::vector<Minimum> descend_to_minima(Residuals& residuals, const std::vector<Eigen::VectorXd>& starts, double scale);

/// An interval of a coordinate (0 to 1 over the parameter's range) that the data do not exclude.
struct CoordinateInterval {
  double low = 0.0;
  double high = 1.0;
};

/// Adds an interval to disjoint ascending intervals, and joins those that overlap.
void merge(std::vector<CoordinateInterval>& all, CoordinateInterval added);

struct ProfileOptions {
  std::array<double, 2> rises{};  ///< values of the growth at the ends of the 68 % and 95 % intervals
  double from = 0.0;   ///< lowest objective, or 0 with ModelError::kBracket; growth = (objective - from) / scale
  double scale = 1.0;  ///< rise of the objective at one standard deviation from a minimum
};

struct Profiles {
  /// For each parameter and each of ProfileOptions::rises: the intervals in which the growth is below the rise. The
  /// growth is minimised over all other parameters. The intervals are disjoint and ascending.
  std::vector<std::array<std::vector<CoordinateInterval>, 2>> intervals;
  std::vector<Minimum> points = {};  ///< computed points of the profiles
  /// A point with an objective below the best minimum, if the profiles found one. Then the search missed a minimum.
  std::optional<Minimum> lower = {};
};

/// Computes the profile likelihoods of all parameters. `minima` has the minima whose growth is below rises[1], the best
/// first. Without any, all intervals are empty. At each minimum a profile has two sides, towards smaller and larger
/// values of the parameter. A side follows the valley of the objective until the growth (see ProfileOptions) reaches
/// one of `rises`. There the interval ends. Beyond this end, a bent valley may have another branch. To find it,
/// descents begin beyond the end, near known points of the valley. If the growth where such a descent ends is below the
/// rise, the profile continues there. `sides` counts the sides of all profiles. Errors: errors of the evaluator;
/// Cancelled.
Profiles compute_profiles(Residuals& residuals, const std::vector<Minimum>& minima, const ProfileOptions& options,
                          Count& sides);

}  // namespace dolp::fit
