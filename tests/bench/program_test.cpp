// dolp-bench and its plot script as a user runs them: options, JSON, table and figure.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "cli_support.hpp"

namespace program_test {

using namespace dolp;
using nlohmann::json;
namespace fs = std::filesystem;

const std::string kAccuracy = "accuracy --quick --entries 16 ";
constexpr double kMostSeconds = 1.0;  // after this time the study accuracy repeats no call

class BenchProgram : public CommandLine {
 protected:
  Outcome bench(Words arguments, std::vector<std::pair<std::string, std::string>> environment = {}) const {
    arguments.insert(arguments.begin(), DOLP_BENCH_PROGRAM);
    return run({.arguments = std::move(arguments), .folder = at(""), .environment = std::move(environment)});
  }
  Outcome plot(const Words& arguments) const {
    return run({.arguments = joined({"/usr/bin/python3", DOLP_BENCH_PLOT}, arguments), .folder = at("")});
  }
  /// The JSON result of a study that must succeed.
  nlohmann::json study_of(const Words& arguments) const { return printed_json(bench(joined(arguments, "--json -"))); }
  /// Expects that the plot script makes a figure of the study in r.json, and a Markdown table that contains `row`.
  void expect_plots(const std::string& study, const std::string& row) const {
    succeeded(plot({study, "r.json", "-o", "r.png"}));
    EXPECT_TRUE(content("r.png").starts_with("\x89PNG"));
    EXPECT_TRUE(contains(succeeded(plot({study, "r.json", "--markdown"})).out, row));
  }
  static void expect_keys(const nlohmann::json& object, const std::set<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object.dump();
  }
};

TEST_F(BenchProgram, Accuracy_Json_Context_SaysWhereAndHowToRunAgain) {
  const json study = study_of(kAccuracy + "--case easy --method gauss --method vulkan-float");
  EXPECT_EQ(study["study"], "accuracy");
  const json& context = study["context"];
  expect_keys(context, {"program", "command", "date", "machine", "device", "compiler", "libraries", "validation"});
  expect_keys(context["machine"], {"processor", "vector_instructions", "cores", "load", "system"});
  expect_keys(context["device"], {"name", "driver"});
  expect_keys(context["compiler"], {"name", "flags", "build_type"});
  EXPECT_EQ(context["command"], DOLP_BENCH_PROGRAM
            " accuracy --quick --entries 16 --case easy --method gauss --method vulkan-float --json -");
  EXPECT_EQ(context["program"], "dolp-bench " DOLP_VERSION);
}

TEST_F(BenchProgram, Accuracy_Json_Results_HaveErrorAndTimesForEverySetting_AndPlots) {
  const json study = study_of(kAccuracy + "--case easy --case median --method gauss --method vulkan-float");
  put("r.json", study.dump());
  expect_plots("accuracy", "| Gauss-Legendre rule |");
  ASSERT_EQ(study["methods"].size(), 2U);
  ASSERT_EQ(study["cases"].size(), 2U);
  EXPECT_EQ(study["results"].size(), 2U * (3U + 2U));
  for (const json& method : study["methods"])
    expect_keys(method, {"name", "label", "what", "cores", "setting", "where"});
  for (const json& one : study["cases"]) {
    expect_keys(one, {"name", "what", "masking", "theta_deg", "sigma", "q", "n", "k", "reference"});
    EXPECT_LE(one["reference"]["bound"].get<double>(), 1e-12);
  }
  for (const json& row : study["results"]) {
    expect_keys(row, {"method", "case", "setting", "error", "time_s", "time_min_s", "raw_times_s", "entries",
                      "evaluations", "r_i", "r_q"});
    const bool on_device = row["method"] == "vulkan-float";
    EXPECT_EQ(row["entries"], on_device ? 16 : 1);
    EXPECT_EQ(row.contains("kernel_time_s"), on_device);
    const auto raw_s = row["raw_times_s"].get<std::vector<double>>();
    const double total_s = row["entries"].get<double>() * std::accumulate(raw_s.begin(), raw_s.end(), 0.0);
    EXPECT_TRUE(raw_s.size() >= 3 || total_s >= kMostSeconds);  // a busy machine may take this long for one call
    EXPECT_GT(row["time_min_s"], 0.0);
    EXPECT_LE(row["time_min_s"], row["time_s"]);
    EXPECT_LT(row["error"], 1e-3);
  }
}

TEST_F(BenchProgram, NoVulkanDevice_OtherMethodsRunAndTheReasonIsNamed) {
  const json study =
      printed_json(bench("accuracy --quick --case easy --method gauss --method vulkan-double --json -", kNoDriver));
  ASSERT_EQ(study["results"].size(), 3U + 3U);
  for (const json& row : study["results"]) {
    EXPECT_EQ(row.contains("not_run"), row["method"] == "vulkan-double") << row.dump();
    EXPECT_EQ(row.contains("error"), row["method"] == "gauss") << row.dump();
  }
  EXPECT_TRUE(study["context"]["device"].contains("none"));
}

TEST_F(BenchProgram, Throughput_Json_GridsHaveTheirRows_AndPlots) {
  succeeded(bench("throughput --quick --entries 64 --case grids --json r.json"));
  const json result = json::parse(content("r.json"));
  expect_plots("throughput", "| v-cavity | 4 × 4 × 4 |");
  EXPECT_EQ(plot("throughput r.json -o none/r.png").status, 4);
  EXPECT_EQ(plot("accuracy r.json --markdown").status, 2);  // it is the result of another study
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

TEST_F(BenchProgram, BadUsage_OneLineThatSaysWhatIsAllowed) {
  for (const auto& [line, status, message] :
       {std::tuple("", 2, "subcommand"),
        {"speed", 2, "see dolp-bench --help"},
        {"accuracy --fast", 2, "--fast"},
        {"accuracy --entries 0", 2, "--entries"},
        {"accuracy --case simple", 2, "--case simple: there is none of this name; choose among easy, median, "},
        {"accuracy --method simpson", 2, "choose among midpoint, gauss, "},
        {"accuracy --json no/such/folder/r.json", 4, "there is no folder no/such/folder"},
        {"accuracy --device nosuch", 3, "nosuch"},
        {"throughput --case smell", 2, "--case smell: there is none of this name; choose among grids, materials"},
        {"throughput --entries 0", 2, "--entries"},
        {"throughput --json no/such/folder/r.json", 4, "there is no folder no/such/folder"}})
    expect_refused(bench(line), message, status, "dolp-bench");
}

TEST_F(BenchProgram, StudiesOfTheDevice_WithoutOne_AreExit3) {
  const Outcome outcome = bench("throughput --quick", kNoDriver);
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

TEST_F(BenchProgram, Plot_OfNoFile_IsRefused) {
  const Outcome missing = plot("accuracy none.json -o r.png");
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(contains(missing.err, "none.json"));
  EXPECT_FALSE(fs::exists(at("r.png")));
}

}  // namespace program_test
