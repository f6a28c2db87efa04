// The two parts of dolp-calibrate: the fit of the quadrature rules' constants, and the test of the error bounds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "calibrate/hold_out.hpp"
#include "calibrate/rule_fit.hpp"
#include "cli_support.hpp"

namespace dolp::calibrate_test {
namespace {

constexpr std::uint64_t kSeed = 3;

MomentsRequest unmasked() {
  MomentsRequest request;
  request.masking = Masking::kNone;
  return request;
}

HoldOut held_out(const HoldOutOptions& options) { return hold_out(unmasked(), options); }

HoldOutOptions few_entries() {
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  HoldOutOptions options;
  options.entries = 50;
  options.seed = kSeed;
  return options;
}

// A typical error is a tenth of its bound. If all bounds are divided by a thousand, most errors exceed their bounds,
// and the largest ratio of error to bound grows by a factor of about a thousand.
TEST(HoldOut, PlantedUnderstatement_IsFound) {
  HoldOutOptions options = few_entries();
  const HoldOut honest = held_out(options);
  EXPECT_EQ(honest.entries, options.entries);
  EXPECT_EQ(honest.understated, 0U);
  EXPECT_GT(honest.worst.ratio, 0.0);
  EXPECT_LE(honest.worst.ratio, 1.0);
  EXPECT_GT(honest.mean_evaluations, 0.0);
  options.bound_share = 1e-3;
  const HoldOut planted = held_out(options);
  EXPECT_GT(planted.understated, options.entries / 2);
  EXPECT_LE(planted.understated, options.entries);
  EXPECT_GT(planted.worst.ratio, 100.0 * honest.worst.ratio);
  // Now the bound of the worst entry is too small, but the bounds of other entries may still hold. hold_out() must find
  // the worst entry.
  options.bound_share = 0.9 * honest.worst.ratio;
  const HoldOut lowered = held_out(options);
  EXPECT_GE(lowered.understated, 1U);
  EXPECT_EQ(lowered.worst.entry.theta_deg, honest.worst.entry.theta_deg);
}

// ---- The program ---------------------------------------------------------------------------------------------------

Outcome calibrate(Words arguments) {
  arguments.insert(arguments.begin(), DOLP_CALIBRATE);
  const TemporaryFolder folder;
  return run({.arguments = arguments, .folder = folder.path()});
}

std::ptrdiff_t line_count(const std::string& text) { return std::ranges::count(text, '\n'); }

TEST(Calibrate, CheckOfOrdinaryEntries_SaysALinePerModelAndExitsWith0) {
  const Outcome outcome = succeeded(calibrate("check --entries 20 --tolerance 1e-4 --seed 3"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(line_count(outcome.out), 10) << outcome.out;
  for (const char* masking : {"none", "v-cavity", "integral", "smith", "multiple"}) {
    for (const char* distribution : {"cauchy", "gaussian"})
      EXPECT_TRUE(contains(outcome.out, fmt::format("{:9}{}", masking, distribution)));
  }
}

TEST(Calibrate, CheckAgainstTheReference_ExitsWith0) {
  const Outcome outcome = succeeded(calibrate("check v-cavity --reference --entries 1 --tolerance 1e-2"));
  EXPECT_EQ(line_count(outcome.out), 2) << outcome.out;
}

TEST(Calibrate, Fit_SaysItsStepsAndExitsWith0) {
  const Outcome outcome = succeeded(calibrate("fit none --entries 1 --rounds 1"));
  EXPECT_GE(line_count(outcome.out), 2);
  EXPECT_TRUE(contains(outcome.out, rule_text(kFitStart)));
}

TEST(Calibrate, BadArguments_ExitWith2) {
  for (const char* arguments : {"", "fit", "fit glass", "check --domain all", "check --entries x"})
    EXPECT_EQ(calibrate(arguments).status, 2) << arguments;
}

}  // namespace
}  // namespace dolp::calibrate_test
