// Dense tables, in which the program interpolates most entries: their values and errors, and the reports about them.
#include <gtest/gtest.h>

#include "cli_support.hpp"
#include "table/table_file.hpp"

namespace {

using namespace dolp;
using nlohmann::json;

const std::vector<std::string> kDense = split_at(
    "--set grid.theta_deg=[75,20] --set grid.sigma={from=0.05,to=1,count=40} --set grid.q={from=1.75,to=8,count=36}",
    ' ');
constexpr std::size_t kDenseEntries = std::size_t{2} * 40 * 36;
const std::vector<std::string> kOff = {"--set", "accuracy.interpolation=off"};
// Relative error of the predicted number of evaluations. `dolp plan` counts the evaluations at only some zeniths.
constexpr double kSampling = 0.2;

class DenseTable : public CommandLine {
 protected:
  json table(const std::vector<std::string>& options = {}) const {
    return report(joined({"table", "scene.toml", "-o", "t.nc"}, options));
  }
};

TEST_F(DenseTable, Interpolated_SaysSo_AndAgreesWithTheReference) {
  const Outcome made = dolp(joined({"table", "scene.toml", "-o", "t.nc"}, kDense));
  EXPECT_NE(made.out.find(" moments interpolated or combined, from "), std::string::npos) << made.out;
  const TableValues a = read_table(at("t.nc"));
  ASSERT_EQ(a.size(), kDenseEntries);
  const auto rule = std::ranges::find(a.attributes, "rule", &Attribute::name);
  ASSERT_NE(rule, a.attributes.end());
  EXPECT_NE(std::get<std::string>(rule->value).find("interpolated in ln(sigma) and ln(q - q0)"), std::string::npos);
  const Outcome checked = dolp({"verify", "t.nc", "--samples", "40"});
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

TEST_F(DenseTable, SmallTable_IsIntegratedEntryByEntry) { EXPECT_EQ(table()["interpolated_moments"], 0); }

TEST_F(DenseTable, Bistatic_OneSlabServesAllDirections) {
  const json report = table(joined(
      kDense, {"--set", "geometry.mode=bistatic", "--set", "source.relative_irradiance=0.5", "--tolerance", "1e-3"}));
  EXPECT_GE(report["interpolated_moments"], kDenseEntries / 2);
  const Outcome outcome = dolp({"verify", "t.nc", "--samples", "20"});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

TEST_F(DenseTable, Plan_SaysWhatTheRunInterpolates) {
  const std::vector<std::string> options =
      joined(kDense, {"--set", "grid.theta_deg={from=5,to=80,count=12}", "--set", "surface.masking=none"});
  const json predicted = report(joined({"plan", "scene.toml"}, options));
  const json spent = table(joined(options, {"--evaluator", "cpu"}));
  EXPECT_EQ(predicted["interpolated_moments"], 12U * 40U * 36U);
  EXPECT_LE(predicted["moments"], spent["interpolation_nodes"]);
  const double evaluations = spent["evaluations"];
  EXPECT_NEAR(predicted["evaluations"], evaluations, kSampling * evaluations);
  const json off = report(joined({"plan", "scene.toml"}, joined(options, kOff)));
  EXPECT_EQ(off["interpolated_moments"], 0);
  EXPECT_EQ(off["moments"], 12U * 40U * 36U);
}

}  // namespace
