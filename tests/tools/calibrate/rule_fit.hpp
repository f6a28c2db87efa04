// Searches for the constants of quadrature rules (plan/rule.hpp) with which random entries need the fewest evaluations
// of the integrand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "plan/rule.hpp"

namespace dolp {

struct RuleFitOptions {
  std::size_t entries = 300;  ///< entries per distribution; each is computed at every tolerance
  std::uint64_t seed = 1;
  int rounds = 4;  ///< passes over all constants; each pass halves the steps
};

/// Mean of ln(work) over random entries, both distributions and tolerances from 1e-2 to 1e-8. The work of an entry is
/// its number of evaluations. Entries that miss a tolerance are computed again, and these evaluations have a larger
/// weight. `integrand` is a request without entries.
double mean_log_work(const MomentsRequest& integrand, const RuleModel& model, const RuleFitOptions& options);

/// The constants at which fit_rule() starts.
inline constexpr RuleModel kFitStart = {.margin_digits = 2.0,
                                        .t_nodes = 2.0,
                                        .t_digits = 0.0,
                                        .t_fall = 0.15,
                                        .phi_nodes = 0.5,
                                        .phi_digits = 0.0,
                                        .cluster_stretch = 5.0};

/// Searches for the constants with the least mean_log_work. Starts at kFitStart and changes one constant at a time.
/// Calls `note` after each improvement. The result is the same on every machine.
RuleModel fit_rule(const MomentsRequest& integrand, const RuleFitOptions& options,
                   const std::function<void(const RuleModel&, double)>& note);

/// The constants as text that can be pasted into plan/rule.cpp.
std::string rule_text(const RuleModel& model);

}  // namespace dolp
