// `dolp plan` as a user runs it, and the effects (parts of the radiation) that a run leaves out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli_support.hpp"
#include "table/table_file.hpp"

namespace plan_test {

using namespace dolp;
using nlohmann::json;

const Words kIsothermal = "--set surroundings.temperature_K=300";
const Words kBistatic = "--set geometry.mode=bistatic --set source.relative_irradiance=0.5";
// The surface is as warm as its surroundings, so emitted and reflected polarisation cancel. Only the source polarises
// the radiation. So the run does not need the moments, which are integrals of the pBRDF over all directions.
const Words kBeamAlone =
    "--set surroundings.temperature_K=300 --set geometry.mode=bistatic --set source.relative_irradiance=0.5";
// Relative error of the predicted number of evaluations. The number of quadrature nodes of an integral is a
// rounded real number. A device computes it in float and may so get another integer than the CPU.
constexpr double kOrderRounding = 0.05;

std::vector<std::string> names_in(const json& rows) {
  std::vector<std::string> names;
  for (const json& row : rows) names.push_back(row["name"]);
  return names;
}

bool has(const json& rows, const std::string& name) {
  const std::vector<std::string> names = names_in(rows);
  return std::ranges::find(names, name) != names.end();
}

class Plan : public CommandLine {
 protected:
  json plan(const Words& options = {}) const { return report(joined("plan scene.toml", options)); }
  json table(const Words& options = {}) const { return report(joined("table scene.toml -o t.nc", options)); }
};

// A masking table belongs to one pair of sigma and q. A run computes a few entries again as a check. For this it may
// make masking tables only for the pairs of these entries: a million tables would need more than two gigabytes.
TEST_F(Plan, MillionValuesOfAnAxis_FitIntoTwoGigabytes) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer takes terabytes of addresses";
#endif
  for (const std::string axis :
       {"grid.q={from=1.6,to=6,count=1000000}", "grid.sigma={from=0.05,to=0.8,count=1000000}"}) {
    Command wanted =
        command("plan scene.toml --set grid.theta_deg=[30] --set grid.sigma=[0.1] --set grid.q=[2] --set " + axis);
    wanted.arguments.insert(wanted.arguments.begin(), {"bash", "-c", "ulimit -v 2000000; exec \"$@\"", "bash"});
    wanted.environment = kNoDriver;
    succeeded(run(wanted));
  }
}

TEST_F(Plan, IsothermalSurroundings_NothingRunsAndDolpIsZero) {
  const json report = printed_json(without_device(joined("table scene.toml -o t.nc --json", kIsothermal)));
  EXPECT_EQ(report["dispatches"], 0);
  EXPECT_EQ(report["evaluations"], 0.0);
  EXPECT_EQ(report["device"], "none");
  EXPECT_TRUE(has(report["effects"]["dropped"], "specular"));
  EXPECT_TRUE(has(report["effects"]["not_needed"], "masking"));
  const TableValues made = read_table(at("t.nc"));
  EXPECT_TRUE(made[Quantity::kRhoI].empty() && made[Quantity::kRhoQ].empty() && made[Quantity::kAlbedo].empty() &&
              made[Quantity::kRhoErrorEstimate].empty());
  ASSERT_EQ(made[Quantity::kDolp].size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(made[Quantity::kDolp][i], 0.0);
    EXPECT_EQ(made.status[i], 0U);
    EXPECT_EQ(made[Quantity::kStokesI][i], made[Quantity::kStokesI][0]);
  }
  succeeded(dolp("verify t.nc --samples 2"));
}

TEST_F(Plan, Memory_IsAboutThatOfTheTable) {
  const std::string peak =
      "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
      "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)";
  // Largest ratio of the measured to the predicted memory. The ratio depends on the driver, and on whether the run
  // still writes one part of the table while it computes the next.
  constexpr double kAbout = 1.7;
  // These tables have one, three and two parts. With more parts the memory stays constant.
  for (const auto& [thetas, sigmas] : {std::pair(200, 1000), {3000, 1000}, {135'000, 2}}) {
    const Words grid = fmt::format(
        "scene.toml --tolerance 1e-2 --set surface.masking=none --set surface.distribution=gaussian --set "
        "grid={{theta_deg={{from=0,to=80,count={}}},sigma={{from=0.01,to=0.02,count={}}},q=[2]}}",
        thetas, sigmas);
    const Words table = {"/usr/bin/python3", "-c", peak, DOLP_PROGRAM, "table", "-o", "t.nc", "--quiet"};
    const double said = report(joined("plan", grid))["host_bytes"];
    const Outcome outcome = succeeded(run({.arguments = joined(table, grid), .folder = at("")}));
    const double taken = 1024.0 * std::stod(outcome.out);
    EXPECT_GT(said, taken / kAbout) << thetas;
    EXPECT_LT(said, taken * kAbout) << thetas;
  }
}

TEST_F(Plan, EffectsAttribute_SaysWhatWasDroppedAndWhy) {
  table(kIsothermal);
  const auto text_in = [&](const char* name) {
    for (const Attribute& attribute : read_table(at("t.nc")).attributes) {
      if (attribute.name == name) return std::get<std::string>(attribute.value);
    }
    return std::string();
  };
  EXPECT_TRUE(text_in("effects").starts_with("kept: emission, surroundings; dropped: specular ("))
      << text_in("effects");
  table();
  EXPECT_TRUE(text_in("effects").ends_with("dropped: nothing")) << text_in("effects");
}

TEST_F(Plan, Eval_QuantitiesNotNeeded_AreNan) {
  const Columns columns = eval(kIsothermal);
  ASSERT_EQ(columns.at("dolp").size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    for (const char* name : {"rho_i", "rho_q", "albedo", "rho_error_estimate"})
      EXPECT_TRUE(std::isnan(columns.at(name)[i])) << name;
    EXPECT_EQ(columns.at("dolp")[i], 0.0);
    EXPECT_EQ(columns.at("status")[i], 0.0);
  }
  const Columns all = eval(joined(kIsothermal, "--keep-all"));
  for (const double rho : all.at("rho_i")) EXPECT_GT(rho, 0.0);
}

TEST_F(Plan, BeamAlone_IsComputedInDouble) {
  for (const char* tolerance : {"1e-3", "1e-8"}) {
    const json report = this->table(joined(kBeamAlone, {"--tolerance", tolerance}));
    EXPECT_EQ(report["precision"], "double");
    EXPECT_LE(report["worst_error_estimate"], std::strtod(tolerance, nullptr));
  }
}

TEST_F(Plan, Mirrors_NeedNoDeviceAndNoPlan) {
  for (const char* mode : {"hemispherical", "bistatic"}) {
    const Words mirrors = "table scene.toml -o t.nc --json --set grid.sigma=0 --set source.relative_irradiance=0.5";
    const Words with_mode = joined(mirrors, {"--set", std::string("geometry.mode=") + mode});
    EXPECT_EQ(printed_json(without_device(with_mode))["device"], "none");
    EXPECT_EQ(read_table(at("t.nc"))[Quantity::kRhoI].size(), 8U);
    EXPECT_EQ(plan("--set grid.sigma=0")["moments"], 0);
  }
}

TEST_F(Plan, BeamWithoutADevice_IsNoSilentSwitchToTheCpu) {
  EXPECT_EQ(without_device(joined("table scene.toml -o t.nc", kBeamAlone)).status, 3);
}

TEST_F(Plan, FewEntries_PredictsTheCpuRunExactly) {
  for (const char* tolerance : {"1e-2", "1e-4", "1e-7"}) {
    const json predicted = plan({"--tolerance", tolerance});
    const json spent = table({"--tolerance", tolerance, "--evaluator", "cpu"});
    EXPECT_TRUE(predicted["first_attempt"]["is_exact"]);
    EXPECT_EQ(predicted["evaluations"], spent["evaluations"]) << tolerance;
  }
}

TEST_F(Plan, Bistatic_PredictsMomentsAndBeams) {
  const json predicted = plan(kBistatic);
  EXPECT_EQ(predicted["moments"], 4);  // one view direction, four pairs of sigma and q
  EXPECT_EQ(predicted["beams"], 16);
  EXPECT_TRUE(predicted["first_attempt"]["is_exact"]);
  EXPECT_EQ(predicted["evaluations"], table(joined(kBistatic, "--evaluator cpu"))["evaluations"]);
  EXPECT_EQ(predicted["pipelines"].size(), 2U);  // the host computes the beams
  ASSERT_EQ(predicted["further_attempts"]["share"], 0.0);
  EXPECT_EQ(predicted["first_attempt"]["dispatches"], table(kBistatic)["dispatches"]);
  const json alone = plan(joined(kBeamAlone, "--tolerance 1e-5"));
  EXPECT_EQ(alone["moments"], 0);
  EXPECT_EQ(alone["beams"], 16);
  EXPECT_TRUE(alone["rule"].is_null());
  EXPECT_GT(alone["estimated_cpu_s"], 0.0);
}

TEST_F(Plan, Device_PredictsEvaluationsAndDispatches) {
  // Every entry of these grids meets its tolerance in the first computation.
  for (const char* masking : {"none", "v-cavity", "smith"}) {
    const Words easy = fmt::format(
        "--tolerance 1e-4 --set surface.masking={} --set grid.theta_deg=[65,40,10] --set grid.sigma=0.4 "
        "--set grid.q=3 --set surface.n=1.5 --set surface.diffuse=0.5",
        masking);
    const json predicted = plan(easy);
    const json spent = table(easy);
    const double evaluations = spent["evaluations"];
    ASSERT_EQ(predicted["further_attempts"]["evaluations"], 0.0) << masking;
    EXPECT_NEAR(predicted["evaluations"], evaluations, kOrderRounding * evaluations);
    EXPECT_EQ(predicted["first_attempt"]["dispatches"], spent["dispatches"]);
  }
}

// A plan counts the work of a run in a small part of it: in the sample and in the forecast of lookups. Each may take
// kFreeEvaluations in any case, and the influences of effects take a few entries with little accuracy.
TEST_F(Plan, FilmInABand_TakesASmallPartOfTheRun) {
  constexpr double kFree = 2.0 * 1e6;
  constexpr double kInfluences = 0.05;
  const std::string scene = std::string(DOLP_HOST_DIR "/scenes/paint_on_metal.toml");
  const json predicted = report({"plan", scene, "--tolerance", "1e-5", "--set", "surface.coating.1.thickness_um=40"});
  const double evaluations = predicted["evaluations"];
  EXPECT_GT(evaluations, 10.0 * kFree);
  EXPECT_LE(predicted["plan_evaluations"], kFree + (2.0 / 25.0 + kInfluences) * evaluations);
  EXPECT_GT(predicted["plan_evaluations"], 0.0);
}

TEST_F(Plan, NoDevice_PlansAllTheSame) {
  const json report = printed_json(without_device("plan scene.toml --json"));
  EXPECT_TRUE(report["device"].is_null());
  EXPECT_NE(report["why_no_device"], "");
  EXPECT_GT(report["first_attempt"]["dispatches"], 0);
  EXPECT_EQ(report["evaluations"], plan()["evaluations"]);
  EXPECT_EQ(without_device("plan scene.toml --device nosuch").status, 3);
}

TEST_F(Plan, ShippedScenes_NameEachEffectOnceAndReadWell) {
  for (const char* name : {"aviation_aluminium", "bare_aluminium", "day", "far", "glint", "mwir_glint", "night_paint",
                           "overcast", "rough_metal", "sea_wind", "stainless_steel", "water"}) {
    const std::string scene = std::string(DOLP_HOST_DIR "/scenes/") + name + ".toml";
    const json json_plan = printed_json(without_device({"plan", scene, "--json"}));
    EXPECT_EQ(names_in(json_plan["rows"]),
              (std::vector<std::string>{"specular", "diffuse", "distribution", "masking", "scattering", "complex index",
                                        "emission", "source", "surroundings", "profile", "path", "band"}));
    const Outcome outcome = succeeded(without_device({"plan", scene}));
    for (const json& row : json_plan["rows"]) {
      EXPECT_NE(row["reason"], "") << name << " " << row["name"];
      EXPECT_TRUE(contains(outcome.out, row["reason"].get<std::string>())) << name;
    }
    for (const char* text : {"dropped", "attempts", "dispatches", "memory", "estimate"})
      EXPECT_TRUE(contains(outcome.out, text)) << name;
  }
}

TEST_F(Plan, AllBounces_TakeMoreEvaluationsAndAPipelineOfTheirOwn) {
  const Words single = "--set surface.masking=v-cavity";
  const json all = plan(joined(single, "--set surface.scattering=multiple"));
  const json once = plan(single);
  EXPECT_GT(all["evaluations"].get<double>(), 2.0 * once["evaluations"].get<double>());
  EXPECT_EQ(all["pipelines"], json({"slopes, float: distribution cauchy, masking v-cavity, all bounces"}));
  EXPECT_EQ(once["pipelines"], json({"slopes, float: distribution cauchy, masking v-cavity"}));
}

TEST_F(Plan, DirectEmission_PipelineAndOutputSaySo) {
  const Words direct = "--set surface.masking=v-cavity --set emission.bracket=true";
  EXPECT_EQ(plan(direct)["pipelines"], json({"slopes, float: distribution cauchy, masking v-cavity, direct emission"}));
  const auto output = [&](const Words& options) {
    const std::string text = dolp(joined("plan scene.toml", options)).out;
    const std::size_t start = text.find("  output");
    return text.substr(start, text.find('\n', start) - start);
  };
  EXPECT_TRUE(output(direct).ends_with(" Stokes parameters, DOLP, its bracket, emissivity, rho, albedo"));
  EXPECT_TRUE(output("--set emission.model=fresnel --set surroundings=none")
                  .ends_with(" Stokes parameters, DOLP, emissivity; without rho_i, rho_q and albedo"));
  EXPECT_TRUE(output(kIsothermal).ends_with(" Stokes parameters, DOLP; without rho_i, rho_q and albedo"));
  EXPECT_TRUE(plan()["gives_emissivity"]);
  EXPECT_FALSE(plan(kIsothermal)["gives_emissivity"]);
}

TEST_F(Plan, DaySceneAtOnePercent_DropsTheSun) {
  const auto effects = [&](const Words& options) {
    return report(joined("plan " DOLP_HOST_DIR "/scenes/day.toml", options))["effects"];
  };
  const json rows = effects("--tolerance 1e-2");
  ASSERT_TRUE(has(rows["dropped"], "source"));
  EXPECT_LE(rows["dolp_bound"], 1e-3);
  EXPECT_FALSE(has(effects("--tolerance 1e-2 --keep-all")["dropped"], "source"));
  EXPECT_FALSE(has(effects({})["dropped"], "source"));
}

// ---- Dense tables, in which the program interpolates most entries ---------------------------------------------------

const Words kDense =
    "--set grid.theta_deg=[75,20] --set grid.sigma={from=0.05,to=1,count=40} --set grid.q={from=1.75,to=8,count=36}";
constexpr std::size_t kDenseEntries = std::size_t{2} * 40 * 36;
// Relative error of the predicted number of evaluations. `dolp plan` counts the evaluations at only some zeniths.
constexpr double kSampling = 0.2;

class DenseTable : public Plan {};

TEST_F(DenseTable, Interpolated_SaysSo_AndAgreesWithTheReference) {
  const Outcome made = dolp(joined("table scene.toml -o t.nc", kDense));
  EXPECT_TRUE(contains(made.out, " moments interpolated or combined, from "));
  const TableValues a = read_table(at("t.nc"));
  ASSERT_EQ(a.size(), kDenseEntries);
  const auto rule = std::ranges::find(a.attributes, "rule", &Attribute::name);
  ASSERT_NE(rule, a.attributes.end());
  EXPECT_TRUE(contains(std::get<std::string>(rule->value), "interpolated in ln(sigma) and ln(q - q0)"));
  succeeded(dolp("verify t.nc --samples 40"));
}

TEST_F(DenseTable, SmallTable_IsIntegratedEntryByEntry) { EXPECT_EQ(table()["interpolated_moments"], 0); }

TEST_F(DenseTable, Bistatic_OneSlabServesAllDirections) {
  const json report =
      table(joined(kDense, "--set geometry.mode=bistatic --set source.relative_irradiance=0.5 --tolerance 1e-3"));
  EXPECT_GE(report["interpolated_moments"], kDenseEntries / 2);
  succeeded(dolp("verify t.nc --samples 20"));
}

TEST_F(DenseTable, Plan_SaysWhatTheRunInterpolates) {
  const Words options = joined(kDense, "--set grid.theta_deg={from=5,to=80,count=12} --set surface.masking=none");
  const json predicted = plan(options);
  const json spent = table(joined(options, "--evaluator cpu"));
  EXPECT_EQ(predicted["interpolated_moments"], 12U * 40U * 36U);
  EXPECT_LE(predicted["moments"], spent["interpolation_nodes"]);
  const double evaluations = spent["evaluations"];
  EXPECT_NEAR(predicted["evaluations"], evaluations, kSampling * evaluations);
  const json off = plan(joined(options, "--set accuracy.interpolation=off"));
  EXPECT_EQ(off["interpolated_moments"], 0);
  EXPECT_EQ(off["moments"], 12U * 40U * 36U);
}

}  // namespace plan_test
