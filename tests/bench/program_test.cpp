// dolp-bench and its plot script as a user runs them: options, JSON, table and figure.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bench_program.hpp"

namespace {

using namespace dolp;
using nlohmann::json;
namespace fs = std::filesystem;

const std::string kAccuracy = "accuracy --quick --entries 16 ";
const std::string kEffects = "effects --quick --entries 9 ";

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

TEST_F(BenchProgram, Accuracy_Json_Results_HaveErrorAndTimesForEverySetting) {
  const json study = study_of(kAccuracy + "--case easy --case median --method gauss --method vulkan-float");
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
    EXPECT_GE(row["raw_times_s"].size(), 3U);
    EXPECT_GT(row["time_min_s"], 0.0);
    EXPECT_LE(row["time_min_s"], row["time_s"]);
    EXPECT_LT(row["error"], 1e-3);
  }
}

TEST_F(BenchProgram, Json_File_IsWrittenBesideTheTable) {
  const Outcome outcome = bench(split_at("accuracy --quick --case rough --method gauss --json r.json", ' '));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("rough: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("  gauss                64  "), std::string::npos) << outcome.out;
  EXPECT_EQ(json::parse(read_file(at("r.json")))["results"].size(), 3U);
}

TEST_F(BenchProgram, NoVulkanDevice_OtherMethodsRunAndTheReasonIsNamed) {
  const Outcome outcome =
      bench(split_at("accuracy --quick --case easy --method gauss --method vulkan-double --json -", ' '), kNoDriver);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json study = json::parse(outcome.out);
  ASSERT_EQ(study["results"].size(), 3U + 3U);
  for (const json& row : study["results"]) {
    EXPECT_EQ(row.contains("not_run"), row["method"] == "vulkan-double") << row.dump();
    EXPECT_EQ(row.contains("error"), row["method"] == "gauss") << row.dump();
  }
  EXPECT_TRUE(study["context"]["device"].contains("none"));
}

TEST_F(BenchProgram, Effects_Json_EveryEffect_HasTimesAndRatio) {
  const json result = study_of("effects --quick --entries 9");
  EXPECT_EQ(result["study"], "effects");
  expect_keys(result, {"context", "error", "time_s", "tolerance", "grid", "results", "warnings"});
  EXPECT_NE(result["context"]["command"].get<std::string>().find(" effects --quick "), std::string::npos);
  std::set<std::string> effects;
  for (const json& row : result["results"]) {
    expect_keys(row, {"effect", "case", "setting", "error", "time_s", "ratio", "entries", "raw_times_s"});
    EXPECT_GT(row["time_s"].get<double>(), 0.0) << row.dump();
    EXPECT_GT(row["ratio"].get<double>(), 0.0) << row.dump();
    EXPECT_EQ(row["entries"], row["setting"] == "20 n x 20 k" ? 3600 : 9) << row.dump();
    EXPECT_EQ(row["raw_times_s"].size(), 3U);
    effects.insert(row["effect"].get<std::string>());
    expect_keys(row, {"base", "kernel_time_s", "left_out", "bound", "compared"});
    EXPECT_GT(row["compared"], 0) << row.dump();
    EXPECT_LE(row["error"], row["tolerance"]) << row.dump();
    if (row["setting"] == row["base"]) {
      EXPECT_EQ(row["ratio"], 1.0) << row.dump();
    }
  }
  EXPECT_EQ(effects,
            (std::set<std::string>{"specular", "diffuse", "distribution", "masking", "complex index", "axes of index",
                                   "scattering", "direct emission", "bracket", "emission", "source", "surroundings",
                                   "path", "band", "sun at 10.6 um", "emission at 0.55 um", "profile"}));
}

TEST_F(BenchProgram, Effects_Json_RadiationBesideAStrongerOne_IsLeftOut) {
  for (const auto& [name, left_out] :
       {std::pair("sun at 10.6 um", json({"source"})), {"emission at 0.55 um", json({"emission", "surroundings"})}}) {
    const json result = study_of(joined(split_at(kEffects + "--case", ' '), {name}));
    EXPECT_EQ(result["results"][1]["left_out"], left_out);
  }
}

TEST_F(BenchProgram, Effects_Json_WhatThePlanDrops_TakesNoKernelAndSaysWhatEverythingTakes) {
  const json result = study_of(kEffects + "--case surroundings");
  ASSERT_EQ(result["results"].size(), 3U);
  const json& cool = result["results"][1];
  const json& isothermal = result["results"][2];
  EXPECT_GT(cool["kernel_time_s"].get<double>(), 0.0);
  EXPECT_FALSE(cool.contains("keep_all_time_s")) << cool.dump();
  EXPECT_EQ(isothermal["kernel_time_s"], 0.0);
  EXPECT_GT(isothermal["keep_all_kernel_time_s"].get<double>(), 0.0) << isothermal.dump();
  EXPECT_GT(isothermal["keep_all_time_s"].get<double>(), 0.0) << isothermal.dump();
  EXPECT_EQ(isothermal["left_out"], json({"specular", "distribution", "masking"}));
}

struct BadUsage {
  std::string line;
  int status;
  std::string message;
};

TEST_F(BenchProgram, BadUsage_OneLineThatSaysWhatIsAllowed) {
  const std::vector<BadUsage> list = {
      {"", 2, "subcommand"},
      {"speed", 2, "see dolp-bench --help"},
      {"accuracy --fast", 2, "--fast"},
      {"accuracy --entries 0", 2, "--entries"},
      {"accuracy --case simple", 2, "--case simple: there is none of this name; choose among easy, median, "},
      {"accuracy --method simpson", 2, "choose among midpoint, gauss, "},
      {"accuracy --json no/such/folder/r.json", 4, "there is no folder no/such/folder"},
      {"accuracy --device nosuch", 3, "nosuch"},
      {"effects --case smell", 2, "--case smell: there is none of this name; choose among specular, "},
      {"effects --method gauss", 2, "--method"},
      {"effects --json no/such/folder/r.json", 4, "there is no folder no/such/folder"},
      {"throughput --case smell", 2,
       "--case smell: there is none of this name; choose among grids, materials, arithmetic, "},
      {"throughput --entries 0", 2, "--entries"},
      {"throughput --json no/such/folder/r.json", 4, "there is no folder no/such/folder"},
      {"peers --case easy", 2, "--case easy: there is none of this name; choose among none, v-cavity, "},
      {"peers --method simpson", 2, "choose among midpoint, gauss, "},
      {"peers --device nosuch", 3, "nosuch"}};
  for (const BadUsage& bad : list) {
    const Outcome outcome = bench(split_at(bad.line, ' '));
    EXPECT_EQ(outcome.status, bad.status) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("dolp-bench: ")) << outcome.err;
    EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(BenchProgram, StudiesOfTheDevice_WithoutOne_AreExit3) {
  for (const char* study : {"effects", "throughput"}) {
    const Outcome outcome = bench({study, "--quick"}, kNoDriver);
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

struct Plotted {
  std::string study;
  std::string row;  ///< text that the Markdown table of the study must contain
};

TEST_F(BenchProgram, Plot_OfEveryStudy_GivesFigureAndTable) {
  const std::vector<Plotted> list = {
      {"accuracy --quick --entries 16 --case easy --method gauss --method cpu-double", "| Gauss-Legendre rule |"},
      {"effects --quick --entries 9 --case surroundings", "| surroundings | hemispherical | 250 K |"},
      {"throughput --quick --entries 64 --case grids --case arithmetic", "| v-cavity | 4 × 4 × 4 |"},
      {"peers --quick --case integral --method gauss --method hcubature --method vulkan-float --method vulkan-table",
       "| libcubature -O2, one core | integral | 100 |"}};
  for (const Plotted& plotted : list) {
    SCOPED_TRACE(plotted.study);
    const Outcome made = bench(split_at(plotted.study + " --json r.json", ' '));
    ASSERT_EQ(made.status, 0) << made.err;
    const std::string study = plotted.study.substr(0, plotted.study.find(' '));
    const Outcome figure = plot({study, "r.json", "-o", study + ".png"});
    ASSERT_EQ(figure.status, 0) << figure.err;
    EXPECT_TRUE(read_file(at(study + ".png")).starts_with("\x89PNG"));
    const Outcome table = plot({study, "r.json", "--markdown"});
    ASSERT_EQ(table.status, 0) << table.err;
    EXPECT_NE(table.out.find(plotted.row), std::string::npos) << table.out;
    EXPECT_EQ(plot({study, "r.json", "-o", "none/r.png"}).status, 4);
  }
  EXPECT_EQ(plot({"accuracy", "r.json", "--markdown"}).status, 2);  // r.json has results of the study `peers`
  const Outcome missing = plot({"accuracy", "none.json", "-o", "r.png"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.err.find("none.json"), std::string::npos) << missing.err;
  EXPECT_FALSE(fs::exists(at("r.png")));
}

}  // namespace
