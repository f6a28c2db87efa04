// The model that turns the kernel's doubts into bounds, and the programs that calibrate it.
#include "calibrate/doubts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"
#include "program.hpp"
#include "properties_support.hpp"

namespace dolp {
namespace {

TEST(DoubtFeatures, Names_AreDistinct) {
  const auto names = doubt_feature_names();
  EXPECT_EQ(std::set<std::string_view>(names.begin(), names.end()).size(), kDoubtFeatures);
  EXPECT_TRUE(std::is_sorted(doubt_knots().begin(), doubt_knots().end()));
}

class Factors : public testing::TestWithParam<Model> {};

TEST_P(Factors, WholeRangeOfScenes_IsFiniteAndPositive) {
  const std::vector<Point> points = Random(7).points(GetParam(), 200);
  for (const double tolerance : {1e-2, 1e-4, 1e-9, 1e-15}) {
    const KernelData data = kernel_data(request_of(GetParam(), points, tolerance));
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (const double doubt : {0.0, 1e-300, 1e-6, 1.0, std::numeric_limits<double>::infinity()}) {
        for (const Doubted doubted : {Doubted::kReflected, Doubted::kDeficit}) {
          const double factor = data.doubts.factor(doubted, data.entries[i], doubt);
          EXPECT_TRUE(factor > 0.0 && std::isfinite(factor)) << text_of(points[i]);
        }
        for (const double feature : data.doubts.features(data.entries[i], doubt)) EXPECT_TRUE(std::isfinite(feature));
      }
    }
  }
}

// The coefficients are linear between the knots, so that no tolerance beside another has another bound.
TEST_P(Factors, BesideAKnot_IsTheSameOnBothSides) {
  const Point point;
  for (const double knot : doubt_knots()) {
    std::vector<double> factors;
    for (const double digits : {knot - 1e-9, knot + 1e-9}) {
      const double tolerance = std::pow(10.0, rule_model(GetParam().masking).margin_digits - digits);
      const KernelData data = kernel_data(request_of(GetParam(), {point}, tolerance));
      factors.push_back(data.doubts.factor(Doubted::kReflected, data.entries.front(), 1e-3 * tolerance));
    }
    EXPECT_NEAR(factors[0], factors[1], 1e-6 * factors[0]) << knot;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Factors, testing::ValuesIn(kModels),
                         [](const testing::TestParamInfo<Model>& test) { return name_of(test.param); });

TEST(DoubtSamples, SameSeed_IsTheSameDraw) {
  const auto first = doubt_samples(Distribution::kCauchy, Masking::kNone, 4, 11);
  const auto again = doubt_samples(Distribution::kCauchy, Masking::kNone, 4, 11);
  const auto other = doubt_samples(Distribution::kCauchy, Masking::kNone, 4, 12);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].features[0], again[i].features[0]);
  EXPECT_NE(first.front().features[0], other.front().features[0]);
}

// An error of the reference moments is an error of the kernel, beyond its doubt by as much.
TEST(DoubtSamples, PlantedError_IsTheExcess) {
  std::vector<StoredCase> cases = hard_cases();
  std::erase_if(cases, [](const StoredCase& c) { return c.name != "ordinary" || c.masking != Masking::kSmith; });
  const auto honest = doubt_samples(cases.front().distribution, Masking::kSmith, cases);
  for (StoredCase& c : cases) c.moments.r_q += 1e-3;
  const auto planted = doubt_samples(cases.front().distribution, Masking::kSmith, cases);
  for (StoredCase& c : cases) c.moments.r_q += 9e-3;
  const auto larger = doubt_samples(cases.front().distribution, Masking::kSmith, cases);
  ASSERT_EQ(honest.size(), planted.size());
  const std::size_t tightest = honest.size() - 1;  // where the rule's own error is nothing beside it
  EXPECT_NEAR(larger[tightest].excess[0] - planted[tightest].excess[0], 1.0, 1e-6);
  EXPECT_GT(planted[tightest].excess[0], honest[tightest].excess[0] + 3.0);
  EXPECT_EQ(planted[tightest].excess[1], honest[tightest].excess[1]);
}

// ---- The programs --------------------------------------------------------------------------------------------------

class Programs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const Outcome drawn =
        run({.arguments = {DOLP_DOUBTS, "samples", "--draws", "40", "--seed", "99"}, .folder = folder_->path()});
    ASSERT_EQ(drawn.status, 0) << drawn.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static Outcome fit(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"/usr/bin/python3", DOLP_FIT_DOUBTS});
    return run({.arguments = arguments, .folder = folder_->path()});
  }

  /// Entries that a check finds understated, and all that it looked at.
  static std::pair<double, double> understated(const std::string& coefficients) {
    const Outcome outcome = fit({"samples", "--check", coefficients});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream text(outcome.out);
    const std::vector<std::string> all{std::istream_iterator<std::string>(text), {}};
    std::pair<double, double> sums{0.0, 0.0};
    for (std::size_t i = 3; i < all.size(); ++i) {
      if (all[i] != "understated,") continue;  // N of M understated
      sums.first += std::stod(all[i - 3]);
      sums.second += std::stod(all[i - 1]);
    }
    return sums;
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* Programs::folder_ = nullptr;

// Draws that the coefficients have not seen.
TEST_F(Programs, ShippedCoefficients_HoldOnFreshEntries) {
  const auto [below, all] = understated(DOLP_DOUBT_COEFFICIENTS);
  EXPECT_EQ(all, 2.0 * 8.0 * (9.0 * 40.0 + 6.0 * 20.0));
  EXPECT_LE(below, 0.002 * all);
}

TEST_F(Programs, Fit_BoundsWhatItHasSeen) {
  const Outcome fitted = fit({"samples", "-o", "fitted.inc"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_EQ(understated("fitted.inc").first, 0.0);
  std::ifstream shipped(DOLP_DOUBT_COEFFICIENTS);
  std::ifstream written(folder_->path() / "fitted.inc");
  const auto lines = [](std::ifstream& file) {
    return std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
  };
  EXPECT_EQ(lines(written), lines(shipped));
}

TEST_F(Programs, CoefficientsThatAreTooSmall_AreFound) {
  std::ifstream shipped(DOLP_DOUBT_COEFFICIENTS);
  std::ofstream small(folder_->path() / "small.inc");
  for (std::string line; std::getline(shipped, line); small << line << "\n") {
    if (line.ends_with("// one")) line = "{{-9.0, -9.0, -9.0, -9.0}},  // one";
  }
  small.close();
  const auto [below, all] = understated("small.inc");
  EXPECT_GT(below, 0.3 * all);
}

TEST_F(Programs, BadInput_IsOneLine) {
  const Outcome absent = fit({"absent", "-o", "x.inc"});
  EXPECT_EQ(absent.status, 1);
  EXPECT_EQ(std::count(absent.err.begin(), absent.err.end(), '\n'), 1) << absent.err;
  EXPECT_NE(absent.err.find("absent/features.txt"), std::string::npos) << absent.err;
}

}  // namespace
}  // namespace dolp
