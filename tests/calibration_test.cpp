// The planner's error model against stored reference moments, and dolp-calibrate, which shows how it stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calibrate/calibration.hpp"
#include "plan/rule.hpp"
#include "program.hpp"
#include "scene/names.hpp"
#include "verify/stored_cases.hpp"

namespace dolp {
namespace {

std::vector<StoredCase> all_points() {
  std::vector<StoredCase> cases = hard_cases();
  for (const StoredCase& stored : read_stored_cases(DOLP_TEST_DATA_DIR "/random_points.csv")) cases.push_back(stored);
  std::erase_if(cases, [](const StoredCase& stored) { return !is_calibration_case(stored); });
  return cases;
}

// ---- The error model -----------------------------------------------------------------------------------------------

class StoredPoints : public testing::TestWithParam<double> {};

void expect_factors_suffice(const GroupCalibration& group, const std::vector<StoredCase>& cases) {
  constexpr double allowed = 1.0;  // of what DoubtModel says
  std::size_t beyond = 0;
  std::string worst;
  for (const PointCalibration& point : group.points) {
    if (std::max(point.factor, point.deficit_factor) <= allowed) continue;
    const StoredCase& c = cases[point.position];
    if (beyond++ == 0) {
      worst = c.name + " theta " + std::to_string(c.theta_deg) + " sigma " + std::to_string(c.shape.sigma) + " q " +
              std::to_string(c.shape.q) + " N " + std::to_string(c.index.n) + " + " + std::to_string(c.index.k) + "i";
    }
  }
  EXPECT_EQ(beyond, 0U) << name_of(group.distribution) << " " << name_of(group.masking) << ": " << beyond << " of "
                        << group.points.size() << " points need more than " << allowed << ", up to "
                        << group.factor.worst << " (deficit " << group.deficit_factor.worst << "), at " << worst;
}

TEST_P(StoredPoints, FactorsAndEstimates_BoundEveryError) {
  const std::vector<StoredCase> cases = all_points();
  ASSERT_GT(cases.size(), 2500U);
  const std::vector<GroupCalibration> groups = calibrate(cases, GetParam(), true);
  ASSERT_EQ(groups.size(), 8U);
  for (const GroupCalibration& group : groups) {
    expect_factors_suffice(group, cases);
    EXPECT_EQ(group.understated, 0U) << name_of(group.distribution) << " " << name_of(group.masking);
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, StoredPoints, testing::Values(1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
                         [](const testing::TestParamInfo<double>& test) {
                           return "OneEMinus" + std::to_string(std::lround(-std::log10(test.param)));
                         });

// ---- The measurement -----------------------------------------------------------------------------------------------

TEST(Spread, KnownValues_HaveTheirNearestRanks) {
  std::vector<double> values;
  for (int i = 100; i > 0; --i) values.push_back(i);
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.median, 50.0);
  EXPECT_EQ(spread.q95, 95.0);
  EXPECT_EQ(spread.q98, 98.0);
  EXPECT_EQ(spread.worst, 100.0);
  EXPECT_EQ(spread_of({7.0}).median, 7.0);
  EXPECT_EQ(spread_of({1.0, std::nan(""), 2.0}).worst, std::numeric_limits<double>::infinity());
}

StoredCase ordinary_case(Masking masking) {
  for (const StoredCase& stored : hard_cases()) {
    if (stored.name == "ordinary" && stored.masking == masking) return stored;
  }
  return {};
}

const PointCalibration& only_point(const std::vector<GroupCalibration>& groups) { return groups.at(0).points.at(0); }

// An error planted in r_q beside which that of the rules, 1e-3 of it, is nothing.
TEST(Calibration, PlantedError_NeedsTheFactorThatMakesTheEstimate) {
  constexpr double kTolerance = 1e-5;
  constexpr double kRulesShare = 0.3;  // the estimate is pessimistic by more than three at this point
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    StoredCase stored = ordinary_case(masking);
    const PointCalibration honest = only_point(calibrate({stored}, kTolerance, true));
    ASSERT_GT(honest.estimate_to_error, 1.0 / kRulesShare) << name_of(masking);
    EXPECT_FALSE(honest.is_understated);
    const double estimate = honest.estimate * stored.moments.r_i;
    stored.moments.r_q += 100.0 * estimate;
    const PointCalibration planted = only_point(calibrate({stored}, kTolerance, true));
    EXPECT_NEAR(planted.error, 100.0 * honest.estimate, kRulesShare * honest.estimate);
    EXPECT_TRUE(planted.is_understated);
    EXPECT_NEAR(planted.estimate_to_error, 0.01, 0.01 * kRulesShare);
    // Rules that alone made the estimate would need exactly a hundred times the factor; cut and rounding lower that.
    EXPECT_GT(planted.factor, 99.0);
    EXPECT_TRUE(std::isfinite(planted.factor));
    EXPECT_EQ(planted.deficit_factor, honest.deficit_factor);
  }
}

TEST(Calibration, FloatKernel_HasTheErrorsOfFloat) {
  const StoredCase stored = ordinary_case(Masking::kNone);
  const PointCalibration in_double = only_point(calibrate({stored}, 1e-9, true));
  const PointCalibration in_float = only_point(calibrate({stored}, 1e-9, false));
  EXPECT_EQ(in_float.evaluations, in_double.evaluations);
  EXPECT_GT(in_float.error, 10.0 * in_double.error);
  EXPECT_GT(in_float.estimate, 1e-6);  // twenty roundings of 6e-8
}

// ---- The program ---------------------------------------------------------------------------------------------------

Outcome calibrate_with(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {DOLP_CALIBRATE};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run({.arguments = all, .folder = folder.path()});
}

/// Writes the hard cases of one name, and returns the name of the file.
std::string write_cases(const TemporaryFolder& folder, const std::string& name, const std::string& case_name) {
  std::ofstream file(folder.path() / name);
  const std::string csv(embedded_hard_cases_csv());
  std::size_t start = 0;
  for (std::size_t end = csv.find('\n'); end != std::string::npos; end = csv.find('\n', start)) {
    const std::string line = csv.substr(start, end - start);
    const bool is_head = line.starts_with('#') || line.starts_with("distribution,");
    if (is_head || line.find("," + case_name + ",") != std::string::npos) file << line << "\n";
    start = end + 1;
  }
  return name;
}

TEST(CalibrateProgram, Json_HasEveryGroupAndField) {
  const TemporaryFolder folder;
  const std::string first = write_cases(folder, "first.csv", "ordinary");
  const std::string second = write_cases(folder, "second.csv", "vacuum");  // reflects nothing: left out
  const Outcome outcome =
      calibrate_with(folder, {first, second, "--tolerance", "1e-3", "--tolerance", "1e-5", "--worst", "3", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report.at("precision"), "double");
  EXPECT_EQ(report.at("cases"), 8);
  ASSERT_EQ(report.at("groups").size(), 16U);
  for (const nlohmann::json& group : report.at("groups")) {
    EXPECT_EQ(group.at("points"), 1);
    for (const char* spread : {"evaluations", "error_over_tolerance", "needed_factor", "needed_deficit_factor"}) {
      for (const char* part : {"median", "q95", "q98", "worst"}) EXPECT_TRUE(group.at(spread).at(part).is_number());
    }
    EXPECT_GT(group.at("evaluations").at("median"), 1.0);
    EXPECT_GE(group.at("missed_share"), 0.0);
    EXPECT_EQ(group.at("understated"), 0);
    ASSERT_EQ(group.at("worst_points").size(), 1U);
    EXPECT_EQ(group.at("worst_points").at(0).at("case"), "ordinary");
    EXPECT_EQ(group.at("worst_points").at(0).at("factor"), group.at("needed_factor").at("worst"));
  }
}

TEST(CalibrateProgram, Text_HasALineForEachGroupAndItsWorstPoints) {
  const TemporaryFolder folder;
  const std::string file = write_cases(folder, "cases.csv", "ordinary");
  const Outcome outcome = calibrate_with(folder, {file, "--tolerance", "1e-4", "--worst", "1", "--precision", "float"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("8 reference points, float\n")) << outcome.out;
  const auto count = [&](const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = outcome.out.find(word); at != std::string::npos; at = outcome.out.find(word, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("\n1e-04"), 8U);
  EXPECT_EQ(count("  ordinary\n"), 8U);
}

TEST(CalibrateProgram, BadInput_ExitsWithStatus2AndNamesIt) {
  const TemporaryFolder folder;
  const std::string file = write_cases(folder, "cases.csv", "ordinary");
  const std::string none = write_cases(folder, "none.csv", "vacuum");
  std::ofstream(folder.path() / "bad.csv") << "theta,sigma\n1,2\n";
  struct Bad {
    std::vector<std::string> arguments;
    const char* message;
  };
  for (const Bad& bad :
       {Bad{{}, "FILE is required"}, Bad{{"absent.csv"}, "absent.csv"},
        Bad{{"bad.csv"}, "bad.csv:1: the columns must be"}, Bad{{none}, "no point to calibrate with"},
        Bad{{file, "--tolerance", "0.1"}, "0.1 must be a number in [1e-10, 0.01]"},
        Bad{{file, "--tolerance", "x"}, "x must be a number"}, Bad{{file, "--precision", "half"}, "half"}}) {
    const Outcome outcome = calibrate_with(folder, bad.arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(outcome.out.empty());
    EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace dolp
