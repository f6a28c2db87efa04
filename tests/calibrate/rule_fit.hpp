// Search for the numbers of plan/rule.hpp: those with which random entries take the least work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "plan/rule.hpp"

namespace dolp {

struct RuleFitOptions {
  std::size_t entries = 300;  ///< of each distribution and tolerance
  std::uint64_t seed = 1;
  int rounds = 4;  ///< of the search, each with steps half as wide as the one before
};

/// Mean of the logarithm of the integrand evaluations that an entry takes, over both distributions and tolerances from
/// 1e-2 to 1e-8: entries that miss their tolerance are computed again, as a run would.
/// `integrand` is a request without entries.
double mean_log_work(const MomentsRequest& integrand, const RuleModel& model, const RuleFitOptions& options);

/// The starting point of every search.
inline constexpr RuleModel kFitStart = {.margin_digits = 2.0,
                                        .t_nodes = 2.0,
                                        .t_digits = 0.0,
                                        .t_fall = 0.15,
                                        .phi_nodes = 0.5,
                                        .phi_digits = 0.0,
                                        .cluster_stretch = 5.0};

/// The model with the least work, searched from kFitStart one number at a time. `note` is told of each step that gains.
/// The same arguments give the same result on every machine.
RuleModel fit_rule(const MomentsRequest& integrand, const RuleFitOptions& options,
                   const std::function<void(const RuleModel&, double)>& note);

/// A model as it stands in plan/rule.cpp.
std::string rule_text(const RuleModel& model);

}  // namespace dolp
