// dolp-bench throughput as a user runs it.
#include "bench_program.hpp"

namespace {

using namespace dolp;
using nlohmann::json;

TEST_F(BenchProgram, Throughput_Json_GridsHaveTheirRows) {
  const json result = study_of("throughput --quick --entries 64 --case grids");
  EXPECT_EQ(result["study"], "throughput");
  expect_keys(result, {"context", "time_s", "grid", "scene", "results", "warnings"});
  EXPECT_EQ(result["grid"], "4 x 4 x 4");
  EXPECT_EQ(result["results"].size(), 4U * 3U * 2U);  // 4 maskings, 3 tolerances, with and without interpolation
  for (const json& row : result["results"]) {
    expect_keys(
        row, {"part", "case", "setting", "entries_per_s", "evaluations_per_s", "stated_error", "raw_kernel_times_s"});
    EXPECT_EQ(row["entries"], 64);
    EXPECT_GE(row["time_s"].get<double>(), row["kernel_time_s"].get<double>());
    EXPECT_NEAR(row["run_s"].get<double>(), 64 * row["time_s"].get<double>(), 1e-3 * row["run_s"].get<double>());
    EXPECT_LE(row["stated_error"], row["tolerance"]) << row.dump();
  }
}

}  // namespace
