// dolp-calibrate: makes the numbers of plan/rule.cpp again, and shows whether the error bounds hold.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "calibrate/hold_out.hpp"
#include "calibrate/rule_fit.hpp"

namespace {

enum ExitStatus { kDone = 0, kUnderstated = 1, kUsage = 2, kInternal = 5 };

const std::map<std::string, dolp::Masking> kMaskings = {{"none", dolp::Masking::kNone},
                                                        {"v-cavity", dolp::Masking::kVCavity},
                                                        {"integral", dolp::Masking::kIntegral},
                                                        {"smith", dolp::Masking::kSmith}};
const std::map<std::string, dolp::Domain> kDomains = {{"ordinary", dolp::Domain::kOrdinary},
                                                      {"corners", dolp::Domain::kCorners}};

struct CheckArguments {
  std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-6};
  dolp::HoldOutOptions options;
};

void fit(dolp::Masking masking, const dolp::RuleFitOptions& options) {
  const auto note = [](const dolp::RuleModel& model, double work) {
    fmt::print("{:.4f}  {}\n", work, dolp::rule_text(model));
    std::fflush(stdout);
  };
  fmt::print("mean logarithm of the evaluations of an entry, numbers of plan/rule.cpp\n");
  dolp::fit_rule(masking, options, note);
}

std::string entry_text(const dolp::CheckedEntry& checked) {
  const dolp::MomentsPoint& e = checked.entry;
  return fmt::format("{:.3g} at theta {:.17g} sigma {:.17g} q {:.17g} n {:.17g} k {:.17g}", checked.ratio, e.theta_deg,
                     e.shape.sigma, e.shape.q, e.index.n, e.index.k);
}

/// A line for each tolerance, masking and distribution. Returns whether all bounds hold.
bool check(const CheckArguments& arguments) {
  std::size_t understated = 0;
  for (const double tolerance : arguments.tolerances) {
    for (const auto& [name, masking] : kMaskings) {
      for (const auto distribution : {dolp::Distribution::kCauchy, dolp::Distribution::kGaussian}) {
        dolp::HoldOutOptions options = arguments.options;
        options.tolerance = tolerance;
        const dolp::HoldOut found = dolp::hold_out(distribution, masking, options);
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
  dolp::Masking masking = dolp::Masking::kNone;
  dolp::RuleFitOptions fit_options;
  CLI::App* fit_command = app.add_subcommand("fit", "the numbers of plan/rule.cpp that take the least work");
  fit_command->add_option("MASKING", masking)->required()->transform(CLI::CheckedTransformer(kMaskings));
  fit_command->add_option("--entries", fit_options.entries, "random entries of each distribution and tolerance")
      ->capture_default_str();
  fit_command->add_option("--rounds", fit_options.rounds, "of the search, each of half the step")
      ->capture_default_str();
  fit_command->add_option("--seed", fit_options.seed)->capture_default_str();
  CheckArguments arguments;
  CLI::App* check_command =
      app.add_subcommand("check", "errors over bounds at random entries; exit 1 if one exceeds its bound");
  check_command->add_option("--domain", arguments.options.domain)
      ->transform(CLI::CheckedTransformer(kDomains))
      ->default_str("ordinary");
  check_command->add_option("--tolerance", arguments.tolerances, "repeatable")->capture_default_str();
  check_command->add_option("--entries", arguments.options.entries, "of each masking and distribution")
      ->capture_default_str();
  check_command->add_option("--climbs", arguments.options.climbs, "worst entries to climb from")->capture_default_str();
  check_command->add_option("--seed", arguments.options.seed)->capture_default_str();
  try {
    app.parse(argc, argv);
    if (*fit_command) fit(masking, fit_options);
    if (*check_command && !check(arguments)) return kUnderstated;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dolp-calibrate: %s\n", error.what());
    return kInternal;
  }
  return kDone;
}
