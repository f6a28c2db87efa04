// dolp-bench throughput and dolp-bench peers as a user runs them: options, JSON, table, figures.
#include <algorithm>

#include "bench_program.hpp"

namespace {

using namespace dolp;
using nlohmann::json;

const std::string kTiny = "throughput --quick --entries 64 ";

class BenchThroughput : public BenchProgram {
 protected:
  static std::vector<json> part(const json& result, const std::string& name) {
    std::vector<json> rows;
    std::ranges::copy_if(result["results"], std::back_inserter(rows),
                         [&](const json& row) { return row["part"] == name; });
    return rows;
  }
};

TEST_F(BenchThroughput, Json_GridsAndArithmetic_HaveTheirRows) {
  const json result = study_of(kTiny + "--case grids --case arithmetic");
  EXPECT_EQ(result["study"], "throughput");
  expect_keys(result, {"context", "time_s", "grid", "scene", "peak", "results", "warnings"});
  EXPECT_EQ(result["grid"], "4 x 4 x 4");
  EXPECT_GT(result["peak"]["flops_per_s"].get<double>(), 0.0);
  for (const json& row : result["results"]) expect_keys(row, {"part", "case", "setting"});
  const std::vector<json> grids = part(result, "grids");
  EXPECT_EQ(grids.size(), 4U * 3U * 2U);  // 4 maskings, 3 tolerances on one grid, with and without interpolation
  for (const json& row : grids) {
    expect_keys(row, {"entries_per_s", "evaluations_per_s", "stated_error", "raw_kernel_times_s"});
    EXPECT_EQ(row["entries"], 64);
    EXPECT_GE(row["time_s"].get<double>(), row["kernel_time_s"].get<double>());
    EXPECT_NEAR(row["run_s"].get<double>(), 64 * row["time_s"].get<double>(), 1e-3 * row["run_s"].get<double>());
    EXPECT_LE(row["stated_error"], row["tolerance"]) << row.dump();
  }
  const std::vector<json> arithmetic = part(result, "arithmetic");
  EXPECT_EQ(arithmetic.size(), 2U);
  for (const json& row : arithmetic) {
    const json& operations = row["operations"];
    const double sum = operations["add"].get<double>() + operations["multiply"].get<double>() +
                       operations["divide"].get<double>() + operations["square_root"].get<double>();
    EXPECT_NEAR(row["flops"].get<double>(), sum, 2.0) << row.dump();
    EXPECT_GT(row["share_of_peak"].get<double>(), 0.0);
    EXPECT_LE(row["busy_lanes"].get<double>(), 1.0);
  }
}

/// Checks a part of the study that starts a process for each value of an environment variable of lavapipe. For other
/// devices the result must state why the part did not run.
void expect_processes(const json& result) {
  constexpr std::size_t kMaskings = 2;  // the quick study has two maskings
  const json& rows = result["results"];
  if (!result["context"]["device"]["name"].get<std::string>().starts_with("llvmpipe")) {
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_TRUE(rows[0].contains("not_run")) << rows[0].dump();
    return;
  }
  ASSERT_GE(rows.size(), kMaskings);
  EXPECT_EQ(rows.size() % kMaskings, 0U);
  for (std::size_t i = 0; i < kMaskings; ++i) EXPECT_EQ(rows[i]["speedup"], 1.0) << rows[i].dump();
  for (const json& row : rows) EXPECT_GT(row["time_s"].get<double>(), 0.0) << row.dump();
}

TEST_F(BenchThroughput, Json_Cores_RunInProcessesOfTheirOwn_OrSayWhyNot) {
  expect_processes(study_of(kTiny + "--case cores"));
}

TEST_F(BenchThroughput, Json_VectorWidths_RunInProcessesOfTheirOwn_OrSayWhyNot) {
  expect_processes(study_of(kTiny + "--case vector-width"));
}

TEST_F(BenchProgram, Json_Rows_ReachTheToleranceAndCompareWithTheKernels) {
  const json result = study_of(
      "peers --quick --case integral --method gauss --method hcubature --method monte-carlo --method vulkan-gauss "
      "--method vulkan-float --method vulkan-table --method native-float");
  EXPECT_EQ(result["study"], "peers");
  expect_keys(result, {"context", "error", "time_s", "methods", "cases", "targets", "results", "warnings"});
  ASSERT_EQ(result["cases"].size(), 1U);
  EXPECT_EQ(result["cases"][0]["sample"].size(), 3U);
  ASSERT_EQ(result["results"].size(), 7U);
  for (const json& row : result["results"]) {
    expect_keys(row, {"method", "case", "tolerance"});
    EXPECT_EQ(row["case"], "integral");
    if (row["method"] == "monte-carlo") {
      // The largest setting, 1e6 samples, has an error of about 1e-3, above the tolerance.
      EXPECT_TRUE(row.contains("not_run")) << row.dump();
      continue;
    }
    expect_keys(row, {"setting", "error", "time_s", "time_min_s", "raw_times_s", "entries", "ratio", "table_ratio"});
    EXPECT_LE(row["error"], row["tolerance"]) << row.dump();
    EXPECT_GT(row["ratio"].get<double>(), 0.0);
    if (row["method"] == "vulkan-float") {
      EXPECT_EQ(row["ratio"], 1.0);
    }
    if (row["method"] == "vulkan-table") {
      EXPECT_EQ(row["table_ratio"], 1.0);
    }
    const bool is_single = row["method"] == "gauss" || row["method"] == "hcubature";
    EXPECT_EQ(row.contains("hindsight_time_s"), is_single) << row.dump();
    if (is_single) {
      EXPECT_EQ(row["entries"], 3);
    } else {
      EXPECT_GE(row["entries"], 512);
    }
  }
  ASSERT_EQ(result["targets"].size(), 3U);  // ratios to libcubature, to the product rule and to the native build
  for (const json& target : result["targets"]) {
    EXPECT_EQ(target["met"], target["ratio"].get<double>() >= target["wanted"].get<double>()) << target.dump();
  }
}

TEST_F(BenchProgram, Peers_WithoutADevice_OthersRunWithoutRatio) {
  const Outcome outcome = bench(
      split_at("peers --quick --case none --method gauss --method vulkan-gauss --method vulkan-float --json -", ' '),
      kNoDriver);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  for (const json& row : result["results"]) {
    EXPECT_EQ(row.contains("not_run"), row["method"] != "gauss") << row.dump();
    EXPECT_FALSE(row.contains("ratio")) << row.dump();
  }
  EXPECT_TRUE(result["targets"].empty());
}

}  // namespace
