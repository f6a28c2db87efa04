// Output of the commands of `dolp` as a user sees it.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/stat.h>

#include <fmt/format.h>

#include <chrono>
#include <regex>
#include <thread>

#include "cli_support.hpp"
#include "table/table_file.hpp"

namespace cli_test {

using namespace dolp;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kSceneEntries = 16;

TEST_F(CommandLine, TableNetcdf_OtherReader_HasAxesVariablesAndAttributes) {
  succeeded(dolp("table scene.toml -o t.nc --set surface.k=0.2"));
  const Outcome dump = succeeded(run({.arguments = {"ncdump", "-h", at("t.nc").string()}, .folder = at("")}));
  std::vector<std::string> expected = {"theta = 4 ;",
                                       "sigma = 2 ;",
                                       "q = 2 ;",
                                       "double theta(theta) ;",
                                       "theta:units = \"degree\" ;",
                                       "sigma:units = \"1\" ;",
                                       "q:units = \"1\" ;",
                                       ":Conventions = \"CF-1.8\"",
                                       "status:flag_masks = 1, 2, 4, 8, 16, 32 ;",
                                       "status:flag_meanings",
                                       ":title = \"Sixteen entries\"",
                                       ":source = \"dolp ",
                                       "table scene.toml -o t.nc --set surface.k=0.2",
                                       ":references = ",
                                       ":scene_overrides = \"surface.k=0.2\"",
                                       ":scene_hash = \"fnv1a64:",
                                       ":device = \"",
                                       ":driver = \"",
                                       ":tolerance = 0.0001",
                                       ":rule = ",
                                       ":wall_time_s = ",
                                       "stokes_i:units = \"W m-2 um-1\""};
  for (const std::string& column : kResultColumns) expected.push_back(" " + column + "(theta, sigma, q) ;");
  for (const QuantityDescription& described : kQuantities) {
    const std::string name = described.name;
    if (std::ranges::find(kResultColumns, name) == kResultColumns.end()) continue;
    expected.push_back(name + ":long_name = \"" + described.long_name);
    expected.push_back(name + ":_FillValue = NaN");
    if (*described.ancillary) expected.push_back(name + ":ancillary_variables = \"" + described.ancillary + '"');
  }
  for (const std::string& text : expected) EXPECT_TRUE(contains(dump.out, text));
  const TableValues table = read_table(at("t.nc"));
  const Attribute verbatim{"scene", kScene};
  EXPECT_NE(std::ranges::find(table.attributes, verbatim), table.attributes.end());
}

TEST_F(CommandLine, PlotTable_OfFurtherAxes_DrawsTheNearestAndNamesThoseThatThereAre) {
  succeeded(dolp("table scene.toml -o t.nc --set grid.n=[1.4,1.6] --set grid.k=[0.1]"));
  const auto plot = [&](const std::string& option, const std::string& value) {
    return run({.arguments = {"/usr/bin/python3", DOLP_HOST_DIR "/plot_table.py", "t.nc", "t.png", option, value},
                .folder = at("")});
  };
  const Outcome drawn = succeeded(plot("--n", "1.55"));
  EXPECT_EQ(drawn.err, "t.nc: has no n = 1.55; the nearest, 1.6, is drawn\n");
  EXPECT_EQ(plot("--n", "1.6").err, "");
  EXPECT_TRUE(content("t.png").starts_with("\x89PNG"));
  const Outcome refused = plot("--wavelength", "9");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err, "t.nc: has no axis wavelength; its axes are n, k, theta, sigma, q\n");
}

int an_allowed_core() {
  cpu_set_t allowed;
  EXPECT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &allowed)) return core;
  }
  return 0;
}

TEST_F(CommandLine, Table_OneCoreOrAll_SameNumbers) {
  const Command on_all = command(
      "table scene.toml -o - --quiet --tolerance 1e-2 --set grid.theta_deg={from=0,to=90,count=24} "
      "--set grid.sigma={from=0.05,to=1.0,count=16} --set grid.q={from=1.6,to=8,count=24}");
  Command on_one = on_all;
  const std::vector<std::string> pinned = {"taskset", "--cpu-list", std::to_string(an_allowed_core())};
  on_one.arguments.insert(on_one.arguments.begin(), pinned.begin(), pinned.end());
  const std::vector<std::string> lines = data_lines(succeeded(run(on_all)).out);
  EXPECT_EQ(lines.size(), 24U * 16U * 24U + 1U);
  EXPECT_EQ(data_lines(succeeded(run(on_one)).out), lines);
}

TEST_F(CommandLine, Eval_StdinToStdout_ReportOnStderr) {
  const Outcome outcome = succeeded(dolp("eval scene.toml --points - -o -", kPoints));
  const std::vector<std::string> lines = split_at(outcome.out, '\n');
  ASSERT_EQ(lines.size(), 4U);
  std::string header = "theta_deg,sigma,q";
  for (const std::string& column : kResultColumns) header += "," + column;
  EXPECT_EQ(lines[0], header);
  EXPECT_TRUE(lines[2].starts_with("60.0,0.4,3.5,0.")) << lines[2];
  EXPECT_TRUE(lines[3].starts_with("80.5,0.1,2,0.")) << lines[3];
  EXPECT_TRUE(contains(outcome.err, "3 points"));
}

TEST_F(CommandLine, Eval_PointsOfATable_GivesItsNumbers) {
  const std::string settings =
      "--evaluator cpu --quiet --set emission.temperature_K=300 --set grid.temperature_K=[290,310] "
      "--set grid.theta_deg=[0,40,70] --set grid.sigma=[0.1,0.2,0.3,0.4] --set grid.q=[2,4]";
  succeeded(dolp(joined("table scene.toml -o t.csv", settings)));
  const Outcome at_points = dolp(joined("eval scene.toml --points t.csv -o -", settings));
  EXPECT_EQ(parse_csv(at_points.out), parse_csv(content("t.csv")));
}

TEST_F(CommandLine, Eval_OwnSlopesAlongAndAcross_HaveRhoU) {
  put("points.csv", "theta_deg,surface_azimuth_deg,sigma_cross\n40,30,0.2\n");
  const std::string no_masking = "--set surface.masking=none --evaluator cpu --quiet";
  const Outcome at_points = dolp(joined("eval scene.toml --points points.csv -o /dev/stdout", no_masking));
  put("points.csv", "theta_deg,surface_azimuth_deg\n40,30\n");
  const Columns of_scene = eval(joined("--set surface.sigma_cross=0.2", no_masking));
  EXPECT_EQ(parse_csv(at_points.out).at("rho_u"), of_scene.at("rho_u"));
}

TEST_F(CommandLine, Eval_SceneFromStdin_SameAsFromFile) {
  const Outcome outcome = dolp("eval - --points points.csv -o - --quiet", kScene);
  EXPECT_EQ(parse_csv(succeeded(outcome).out).at("dolp"), eval({}).at("dolp"));
}

TEST_F(CommandLine, Eval_HeaderWithoutRows_HeaderWithoutRows) {
  const Outcome outcome = succeeded(dolp("eval scene.toml --points - -o - --quiet", "q,theta_deg\n"));
  EXPECT_TRUE(outcome.out.starts_with("q,theta_deg,rho_i,")) << outcome.out;
  EXPECT_EQ(data_lines(outcome.out).size(), 1U);
}

/// The rows of the report divide the time of the run: no two overlap, and the rest is a row of its own.
void expect_times_sum_up(const json& report) {
  constexpr double kRounding = 1e-9;
  double sum_s = 0.0;
  for (const char* part :
       {"setup_s", "kernel_s", "sums_s", "spectral_rule_s", "response_basis_s", "reflectance_curves_s", "transfer_s",
        "radiometry_s", "check_s", "estimates_s", "file_s", "other_s"}) {
    EXPECT_GE(double{report[part]}, 0.0) << part;
    sum_s += double{report[part]};
  }
  EXPECT_NEAR(sum_s, report["wall_s"], kRounding * sum_s);
}

// A film in a band has a spectral rule, reflectance curves, responses, estimates and a check, for which no time is 0.
TEST_F(CommandLine, Json_FilmInABand_EachPartOfTheRunHasItsTime) {
  const std::string scene = std::string(DOLP_HOST_DIR "/scenes/paint_on_metal.toml");
  for (const char* evaluator : {"vulkan", "cpu"}) {
    SCOPED_TRACE(evaluator);
    const json report = this->report({"table", scene, "-o", "t.nc", "--evaluator", evaluator, "--tolerance", "1e-3",
                                      "--set", "spectrum.band_um=[9,9.1]", "--set", "grid.sigma=[0.1,0.2,0.3]"});
    expect_times_sum_up(report);
    for (const char* part : {"spectral_rule_s", "reflectance_curves_s", "response_basis_s", "check_s", "estimates_s"})
      EXPECT_GT(double{report[part]}, 0.0) << part;
  }
}

TEST_F(CommandLine, Json_EachEvaluator_HasTheContractsKeys) {
  for (const char* evaluator : {"vulkan", "cpu", "reference"}) {
    SCOPED_TRACE(evaluator);
    const Words start = "table scene.toml -o t.nc --set surface.masking=v-cavity --evaluator";
    const json report = this->report(joined(start, {evaluator}));
    for (const char* key :
         {"title", "output", "device", "driver", "dispatches", "evaluations", "wall_s", "kernel_s",
          "worst_error_estimate", "worst_rho_error_estimate", "status", "tolerance", "rule", "precision"}) {
      EXPECT_TRUE(report.contains(key)) << key;
    }
    EXPECT_EQ(report["evaluator"], evaluator);
    EXPECT_EQ(report["entries"], kSceneEntries);
    expect_times_sum_up(report);
    EXPECT_LE(report["pipelines_s"], report["setup_s"]);
    EXPECT_EQ(report["dispatches"] > 0, std::string(evaluator) == "vulkan");
    EXPECT_EQ(report["setup_s"] > report["pipelines_s"], std::string(evaluator) == "vulkan");
    EXPECT_GT(report["kernel_s"], 0.0);
    EXPECT_GT(report["radiometry_s"], 0.0);
    EXPECT_GT(report["file_s"], 0.0);
    EXPECT_NE(report["device"], "");
  }
}

TEST_F(CommandLine, Report_SettingsOfTheCall_StandBelowTheTitle) {
  const Outcome outcome = dolp(
      "table scene.toml -o t.nc --evaluator cpu --set spectrum.wavelength_um=9 --set grid.theta_deg=[30] --tolerance "
      "1e-3");
  EXPECT_TRUE(contains(outcome.out, "\n  changed    spectrum.wavelength_um=9\n"));
  EXPECT_EQ(report("plan scene.toml --set surface.n=2 --set surface.k=1")["changed"], "surface.n=2, surface.k=1");
  EXPECT_EQ(report("plan scene.toml --set grid.theta_deg=[30]")["changed"], "");
}

// Two emission models differ in the light that meets a second facet. In the model 1 - rho, all this light counts as
// emitted. In direct emission, none of it does. For a rough metal the DOLP of the two models differs much. The summary
// must report this difference.
TEST_F(CommandLine, Summary_MaskingWithADirectEmission_SaysWhatSingleScatteringLeavesOpen) {
  const Words metal = "--set surface.masking=smith --set surface.n=10 --set surface.k=60";
  for (const char* start : {"table scene.toml -o t.nc", "eval scene.toml --points points.csv -o e.csv"}) {
    EXPECT_TRUE(contains(dolp(joined(start, metal)).out, "direct emission differs by up to "));
    EXPECT_GT(report(joined(start, metal))["scattering_gap"], 0.01);
    // scene.toml has `integral` masking, for which there is no direct emission
    EXPECT_TRUE(report(start)["scattering_gap"].is_null());
    EXPECT_FALSE(contains(dolp(start).out, "  scattering "));
  }
}

TEST_F(CommandLine, Json_WallTime_CountsTheWriting) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  const std::jthread reader([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    content("pipe");
  });
  EXPECT_GT(report("eval scene.toml --points points.csv -o pipe --evaluator cpu")["wall_s"], 1.0);
}

TEST_F(CommandLine, Json_StatusCounts_AreThoseOfTheEntries) {
  const json counts = report("table scene.toml -o t.nc --set grid.theta_deg=[0,89.9,90]")["status"];
  const TableValues table = read_table(at("t.nc"));
  ASSERT_EQ(counts.size(), 6U);
  std::size_t all = 0;
  for (const json& count : counts) {
    const auto bit = count["bit"].get<std::uint32_t>();
    const auto with_bit = std::ranges::count_if(table.status, [bit](std::uint32_t s) { return (s & bit) != 0; });
    EXPECT_EQ(count["count"], with_bit) << bit;
    all += count["count"].get<std::size_t>();
  }
  EXPECT_GT(all, 0U) << "at 90 degrees rho diverges, so some entry must have a status";
}

TEST_F(CommandLine, Summary_NoTerminal_OnStdoutWithoutProgress) {
  const Outcome outcome = succeeded(dolp("table scene.toml -o t.nc"));
  EXPECT_EQ(outcome.err, "");
  for (const char* text : {"Sixteen entries\n", "4 x 2 x 2", "device", "time", "error", "status", "albedo", "t.nc\n"})
    EXPECT_TRUE(contains(outcome.out, text));
}

TEST_F(CommandLine, Progress_OnATerminal_ShownAndCleared) {
  const Outcome shown = succeeded(TerminalProcess(command("table scene.toml -o t.nc --evaluator cpu")).finish());
  EXPECT_TRUE(contains(shown.err, "/16 entries, "));
  EXPECT_TRUE(contains(shown.err, " s left"));
  EXPECT_TRUE(shown.err.ends_with("\r\033[K")) << shown.err;
}

TEST_F(CommandLine, Progress_QuietOnATerminal_Nothing) {
  TerminalProcess process(command("table scene.toml -o t.nc --evaluator cpu --quiet"));
  EXPECT_EQ(succeeded(process.finish()).err, "");
}

TEST_F(CommandLine, Folders_RelativePathsFromElsewhere_AreTheCallers) {
  fs::create_directory(at("elsewhere"));
  Command wanted = command("table ../scene.toml -o sub.nc");
  wanted.folder = at("elsewhere");
  succeeded(run(wanted));
  EXPECT_EQ(read_table(at("elsewhere/sub.nc")).size(), kSceneEntries);
  EXPECT_EQ(names(), (std::vector<std::string>{"elsewhere", "points.csv", "scene.toml"}));
}

TEST_F(CommandLine, Eval_OwnOutputAsPoints_GivesTheSameAgain) {
  put("p.csv", "theta_deg,sigma\n30,0.1\n60,0.2\n");
  succeeded(dolp("eval scene.toml --points p.csv -o a.csv"));
  const Outcome again = succeeded(dolp("eval scene.toml --points a.csv -o b.csv"));
  EXPECT_EQ(read_file(at("a.csv")), read_file(at("b.csv")));
  EXPECT_TRUE(contains(again.out, "left out   rho_i"));
}

TEST_F(CommandLine, Eval_MoreThanAPart_RowsAreThoseOfEachPoint) {
  constexpr int kRows = 140'000;
  std::string points = "theta_deg,sigma\n";
  for (int i = 0; i < kRows; ++i) points += fmt::format("{},0\n", i * 6e-4);
  put("p.csv", points);
  succeeded(dolp("eval scene.toml --points p.csv -o all.csv"));
  const std::vector<std::string> all = data_lines(read_file(at("all.csv")));
  ASSERT_EQ(all.size(), kRows + 1U);
  for (const int row : {0, 65'535, 65'536, 131'071, 131'072, kRows - 1}) {
    put("one.csv", fmt::format("theta_deg,sigma\n{},0\n", row * 6e-4));
    succeeded(dolp("eval scene.toml --points one.csv -o r.csv"));
    EXPECT_EQ(all[static_cast<std::size_t>(row) + 1], data_lines(read_file(at("r.csv")))[1]);
  }
}

TEST_F(CommandLine, Keys_OneOrATable_SayWhatIsAllowed) {
  EXPECT_TRUE(contains(succeeded(dolp("keys surface.sigma")).out, "a number in [0, 10]; required"));
  EXPECT_GT(report("keys surface")["keys"].size(), 5U);
}

TEST_F(CommandLine, Help_OfEveryCommand_HasTwoExamples) {
  const std::string help = dolp("--help").out;
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  for (std::string name; std::getline(lines, line) && std::istringstream(line) >> name;) {
    const std::string own = dolp({name, "--help"}).out;
    const std::size_t examples = own.find("Examples:\n  dolp " + name);
    ASSERT_NE(examples, std::string::npos) << own;
    EXPECT_NE(own.find("\n  dolp " + name, examples + 12), std::string::npos) << own;
  }
}

TEST_F(CommandLine, Materials_List_HasNameRangeAndSource) {
  const Outcome text = succeeded(dolp("materials"));
  const json materials = report("materials")["materials"];
  EXPECT_EQ(materials.size(), 41U);
  EXPECT_EQ(std::ranges::count(text.out, '\n'), 41);
  const std::string one = dolp("materials iron").out;
  EXPECT_EQ(one, text.out.substr(0, one.size()));
  EXPECT_EQ(std::ranges::count(one, '\n'), 1);
  EXPECT_EQ(materials.at(0), json({{"name", "iron"},
                                   {"from_um", 2.0},
                                   {"to_um", 20.0},
                                   {"kind", "metal"},
                                   {"source", "Ordal et al. 1988, Appl. Opt. 27, 1203 (Al,Fe,Ti,Ta,W,Mo)"}}));
  const auto mirror = std::ranges::find(materials, "oxidised Al mirror", [](const json& m) { return m["name"]; });
  ASSERT_NE(mirror, materials.end());
  EXPECT_EQ((*mirror)["to_um"], 12.5);
  const std::size_t line = text.out.find("oxidised Al mirror ");
  ASSERT_NE(line, std::string::npos);
  EXPECT_LT(text.out.find("2 to 12.5 ", line), text.out.find("mirror with its oxide film\n", line)) << text.out;
}

TEST_F(CommandLine, Materials_OneAtAWavelength_HasNAndKOfItsTable) {
  // Values of host/data/materials.csv. The first words of a material's name suffice, in upper or lower case.
  constexpr double kWaterN = 1.218;
  constexpr double kWaterK = 0.0508;
  EXPECT_TRUE(succeeded(dolp("materials WATER --at 10")).out.starts_with("water 25C at 10 um: n = "));
  const json one = report({"materials", "water 25C", "--at", "10"});
  EXPECT_EQ(one["n"], kWaterN);
  EXPECT_EQ(one["k"], kWaterK);
  EXPECT_EQ(one["wavelength_um"], 10.0);
  EXPECT_FALSE(std::regex_search(dolp("materials iron --at 8:14").out, std::regex("\\.[0-9]{10}")));
  const json range = report({"materials", "water 25C", "--at", "8:10:3"});
  EXPECT_EQ(range["wavelength_um"], json({8.0, 9.0, 10.0}));
  EXPECT_EQ(range["n"][2], kWaterN);
  EXPECT_EQ(range["k"][2], kWaterK);
}

TEST_F(CommandLine, Device_ByPositionAndName_ReportedAsTheDevice) {
  const Words start = "table scene.toml -o t.nc --device";
  const std::string name = report(joined(start, "0"))["device"];
  EXPECT_EQ(report(joined(start, {name.substr(0, 6)}))["device"], name);
}

TEST_F(CommandLine, HelpAndVersion_OnStdout_Exit0) {
  for (const char* line : {"--help", "table --help", "eval --help", "materials --help", "devices --help", ""}) {
    const Outcome outcome = succeeded(dolp(line));
    EXPECT_TRUE(contains(outcome.out, "Usage: dolp"));
    EXPECT_EQ(outcome.err, "");
  }
  const Outcome version = succeeded(dolp("--version"));
  EXPECT_TRUE(std::regex_match(version.out, std::regex("dolp " DOLP_VERSION " \\([-0-9a-z]+\\)\n"))) << version.out;
}

}  // namespace cli_test
