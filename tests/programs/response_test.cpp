// `dolp response` as a user runs it: its file, its requirements on a scene, and its error messages.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli_support.hpp"
#include "table/table_file.hpp"
#include "table/table_reader.hpp"

namespace response_test {

using namespace dolp;

constexpr const char* kSurface = R"(title = "A surface"
[surface]
sigma = 0.3
masking = "smith"
[grid]
theta_deg = [0, 60, 89]
sigma = [0.1, 0.4]
q = [2, 3.5]
)";

class Response : public CommandLine {
 protected:
  Outcome response(const Words& options, const std::string& output = "r.nc") const {
    return dolp(joined("response surface.toml --evaluator cpu -o " + output, options));
  }
  void SetUp() override {
    CommandLine::SetUp();
    put("surface.toml", kSurface);
  }
};

TEST_F(Response, SceneWithoutAMaterial_HasOneForEachMasking) {
  for (const std::string masking : {"none", "v-cavity", "integral", "smith"}) {
    const Outcome outcome = succeeded(response("--quiet --strict --set surface.masking=" + masking));
    EXPECT_EQ(outcome.out + outcome.err, "");
    const TableReader reader(at("r.nc"));
    const GridBox all{{}, reader.head().counts()};
    const TableValues table = reader.read(all);
    reader.check_hash(reader.value_sums(table, all));
    ASSERT_EQ(table.size(), 12U);
    ASSERT_EQ(table.beta_deg.size(), 24U);
    const bool has_emission = masking == "smith" || masking == "v-cavity";
    for (const ResponseVariable variable : kAllResponseVariables) {
      const bool is_emission = variable == ResponseVariable::kEmissionI || variable == ResponseVariable::kEmissionQ;
      EXPECT_EQ(table.responses[variable].size(),
                is_emission && !has_emission ? 0 : table.size() * table.values_per_entry(variable))
          << masking << " " << describe(variable).name;
    }
    EXPECT_TRUE(table.index_n.used.empty());
  }
}

TEST_F(Response, WhatItDoesNotDependOn_ChangesNoWeight) {
  succeeded(response("--quiet"));
  // The settings name files that do not exist. The command must not open them.
  succeeded(
      dolp("response scene.toml -o same.nc --evaluator cpu --quiet --set surface.masking=smith --set "
           "grid.theta_deg=[0,60,89] --set surface.material_file=missing.csv --set source.file=missing.csv"));
  const TableReader a(at("r.nc")), b(at("same.nc"));
  EXPECT_EQ(a.read({{}, a.head().counts()}).responses, b.read({{}, b.head().counts()}).responses);
}

TEST_F(Response, Report_SaysHowLargeTheErrorIs) {
  const nlohmann::json json = report("response surface.toml -o r.nc --evaluator cpu --tolerance 1e-3");
  EXPECT_EQ(json["entries"], 12);
  EXPECT_EQ(json["angles"], 24);
  EXPECT_EQ(json["missed_tolerance"], 0);
  EXPECT_LE(json["worst_error_estimate"], 1e-3);
}

TEST_F(Response, ToleranceOutOfReach_FailsStrictAlone) {
  const Words hard = "--set accuracy.precision=float --tolerance 1e-8 --quiet";
  succeeded(response(hard));
  const Outcome strict = response(joined(hard, "--strict"));
  EXPECT_EQ(strict.status, 1);
  expect_one_line(strict.err, "--strict: the tolerance is not met everywhere");
}

TEST_F(Response, WhatIsWrong_IsRefusedInOneLine) {
  for (const auto& [options, output, message] :
       {std::tuple("", "r.csv", "r.csv: the name of a response table must end in .nc"),
        {"", "-", "-: the name of a response table must end in .nc"},
        {"--set surface.masking=v-cavity --set surface.scattering=multiple", "r.nc",
         "surface.scattering = \"multiple\": must be \"single\" for a response table"},
        {"--set surface.sigmas=1", "r.nc", "surface.sigmas"},
        {"--shard 1/2", "r.nc", "--shard"}}) {
    expect_refused(response(options, output), message);
    EXPECT_FALSE(std::filesystem::exists(at(output)));
  }
  succeeded(response("--quiet"));
  expect_refused(dolp("response r.nc -o r.nc --evaluator cpu"), "would overwrite an input");
}

TEST_F(Response, AsATable_IsRefused) {
  succeeded(response("--quiet"));
  expect_refused(dolp("verify r.nc --between 9"), "r.nc: has no quantity \"dolp\"");
  expect_refused(dolp("merge r.nc -o m.nc"), "r.nc: ");
}

TEST_F(Response, Verify_ComparesWithTheReference) {
  for (const std::string masking : {"none", "smith"}) {
    succeeded(response("--set grid.q=2 --quiet --set surface.masking=" + masking));
    const nlohmann::json json = report("verify r.nc --samples 1");
    EXPECT_EQ(json["checked"], 1);
    EXPECT_EQ(json["quantities"].size(), masking == "smith" ? 4U : 2U);
    for (const auto& quantity : json["quantities"]) {
      EXPECT_EQ(quantity["compared"], 1);
      EXPECT_LE(quantity["worst"]["error"], quantity["worst"]["stated"]);
    }
  }
}

TEST_F(Response, Verify_FindsWrongWeights) {
  succeeded(response("--set grid.q=2 --set surface.masking=none --quiet"));
  TableValues table = read_table(at("r.nc"));
  // each entry has 24 weights, so weight 30 belongs to the second entry
  table.responses[ResponseVariable::kResponseQ][30] += 1e-3;
  write_table(table, at("r.nc"));
  const Outcome outcome = dolp("verify r.nc");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "response_q at theta 0, sigma 0.4, q 2 is too far"));
}

}  // namespace response_test
