// dolp-calibrate: fits the constants of the quadrature rules in plan/rule.cpp, and tests the error bounds.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "calibrate/hold_out.hpp"
#include "calibrate/rule_fit.hpp"
#include "model/direction.hpp"

namespace {

enum ExitStatus { kDone = 0, kUnderstated = 1, kUsage = 2, kInternal = 5 };

dolp::MomentsRequest integrand(dolp::Masking masking, dolp::Scattering scattering = dolp::Scattering::kSingle) {
  dolp::MomentsRequest request;
  request.masking = masking;
  request.scattering = scattering;
  request.wants_direct = scattering == dolp::Scattering::kSingle && dolp::keeps_projected_area(masking);
  return request;
}

/// The integrands for which plan/rule.cpp has constants: one for each masking, one for all bounces in V-grooves.
const std::map<std::string, dolp::MomentsRequest> kIntegrands = {
    {"none", integrand(dolp::Masking::kNone)},
    {"v-cavity", integrand(dolp::Masking::kVCavity)},
    {"integral", integrand(dolp::Masking::kIntegral)},
    {"smith", integrand(dolp::Masking::kSmith)},
    {"multiple", integrand(dolp::Masking::kVCavity, dolp::Scattering::kMultiple)}};
const std::map<std::string, dolp::Domain> kDomains = {{"ordinary", dolp::Domain::kOrdinary},
                                                      {"corners", dolp::Domain::kCorners}};

struct CheckArguments {
  std::vector<std::string> integrands;  // empty means all
  std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-6};
  dolp::HoldOutOptions options;
};

void fit(const std::string& name, const dolp::RuleFitOptions& options) {
  const auto note = [](const dolp::RuleModel& model, double work) {
    fmt::print("{:.4f}  {}\n", work, dolp::rule_text(model));
    std::fflush(stdout);
  };
  fmt::print("mean logarithm of the evaluations of an entry, numbers of plan/rule.cpp\n");
  dolp::MomentsRequest request = kIntegrands.at(name);
  request.wants_direct = false;
  dolp::fit_rule(request, options, note);
}

std::string entry_text(const dolp::CheckedEntry& checked) {
  const dolp::MomentsPoint& e = checked.entry;
  return fmt::format("{:.3g} at theta {:.17g} sigma {:.17g} q {:.17g} n {:.17g} k {:.17g}", checked.ratio, e.theta_deg,
                     e.shape.sigma, e.shape.q, e.index.index.n, e.index.index.k);
}

/// Prints a line for each combination of tolerance, integrand and distribution. True if no error exceeds its bound.
bool check(const CheckArguments& arguments) {
  std::size_t understated = 0;
  for (const double tolerance : arguments.tolerances) {
    for (const auto& [name, of_masking] : kIntegrands) {
      const std::vector<std::string>& chosen = arguments.integrands;
      if (!chosen.empty() && std::ranges::find(chosen, name) == chosen.end()) continue;
      for (const auto distribution : {dolp::Distribution::kCauchy, dolp::Distribution::kGaussian}) {
        dolp::MomentsRequest model = of_masking;
        model.distribution = distribution;
        dolp::HoldOutOptions options = arguments.options;
        options.tolerance = tolerance;
        const dolp::HoldOut found = dolp::hold_out(model, options);
        understated += found.understated + (found.climbed.ratio > 1.0 ? 1 : 0);
        fmt::print(
            "{:.0e} {:<8} {:<8} understated {} of {}, {:.1f} % miss at the first level, evaluations {:.0f}, worst {}\n",
            tolerance, name, distribution == dolp::Distribution::kCauchy ? "cauchy" : "gaussian", found.understated,
            found.entries, 100.0 * found.flagged_share, found.mean_evaluations, entry_text(found.worst));
        if (options.climbs > 0) fmt::print("    climbed to {}\n", entry_text(found.climbed));
        std::fflush(stdout);
      }
    }
  }
  return understated == 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes the numbers of the quadrature rules again, and checks that error bounds hold.");
  app.require_subcommand(1);
  std::string name;
  dolp::RuleFitOptions fit_options;
  CLI::App* fit_command = app.add_subcommand("fit", "the numbers of plan/rule.cpp that take the least work");
  fit_command->add_option("INTEGRAND", name, "a masking, or multiple: all bounces in grooves")
      ->required()
      ->check(CLI::IsMember(kIntegrands));
  fit_command->add_option("--entries", fit_options.entries, "random entries of each distribution and tolerance")
      ->capture_default_str();
  fit_command->add_option("--rounds", fit_options.rounds, "of the search, each of half the step")
      ->capture_default_str();
  fit_command->add_option("--seed", fit_options.seed)->capture_default_str();
  CheckArguments arguments;
  CLI::App* check_command =
      app.add_subcommand("check", "errors over bounds at random entries; exit 1 if one exceeds its bound");
  check_command->add_option("INTEGRAND", arguments.integrands, "all by default")->check(CLI::IsMember(kIntegrands));
  check_command->add_option("--domain", arguments.options.domain)
      ->transform(CLI::CheckedTransformer(kDomains))
      ->default_str("ordinary");
  check_command->add_option("--tolerance", arguments.tolerances, "repeatable")->capture_default_str();
  check_command->add_option("--entries", arguments.options.entries, "of each integrand and distribution")
      ->capture_default_str();
  check_command->add_flag(
      "--reference", arguments.options.against_reference,
      "against the independent reference instead of finer rules: a second of a core for each entry");
  check_command->add_option("--climbs", arguments.options.climbs, "worst entries to climb from")->capture_default_str();
  check_command->add_option("--seed", arguments.options.seed)->capture_default_str();
  try {
    app.parse(argc, argv);
    if (*fit_command) fit(name, fit_options);
    if (*check_command && !check(arguments)) return kUnderstated;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dolp-calibrate: %s\n", error.what());
    return kInternal;
  }
  return kDone;
}
