// A table where a command takes a scene, as a user runs it; `dolp lookup`; and what interpolation in a table costs.
#include <gtest/gtest.h>

#include <cmath>

#include "cli_support.hpp"
#include "table/table_file.hpp"

namespace lookup_test {

using namespace dolp;
using nlohmann::json;

class TableAsScene : public CommandLine {
 protected:
  void make_table(const Words& options) const {
    succeeded(dolp(joined("table scene.toml -o t.nc --quiet --evaluator cpu", options)));
  }
  /// DOLP of `dolp eval` for the scene and the points.
  std::vector<double> eval_scene(const Words& options) const {
    return eval(joined("--evaluator cpu", options)).at("dolp");
  }
  std::vector<double> lookup_dolp() const { return parse_csv(succeeded(lookup()).out).at("dolp"); }
  Outcome lookup() const { return dolp("lookup t.nc --points points.csv -o -"); }
};

TEST_F(TableAsScene, Lookup_IsEvalWithTheTablesSettings) {
  const Words settings = "--set surface.masking=v-cavity --tolerance 1e-6";
  make_table(settings);
  put("points.csv", "theta_deg,sigma,q\n33.3,0.17,2.5\n71,0.3,4\n");
  const Outcome found = succeeded(lookup());
  EXPECT_EQ(found.out, dolp("eval t.nc --points points.csv -o -").out);
  EXPECT_EQ(found.out, dolp(joined("eval scene.toml --points points.csv -o - --evaluator cpu", settings)).out);
  for (const double error : parse_csv(found.out).at("error_estimate")) EXPECT_LE(error, 1e-6);
}

TEST_F(TableAsScene, Evaluator_IsTheTables_UnlessAnOptionNamesAnother) {
  make_table({});
  EXPECT_EQ(report("lookup t.nc --points points.csv -o l.csv")["evaluator"], "cpu");
  EXPECT_EQ(report("lookup t.nc --points points.csv -o l.csv --evaluator reference")["evaluator"], "reference");
  EXPECT_EQ(report("eval t.nc --points points.csv -o l.csv --device 0")["evaluator"], "vulkan");
}

TEST_F(TableAsScene, AxisWithOneValue_IsThatOfPointsWithoutTheColumn) {
  make_table("--set grid.sigma=[0.27] --set grid.q=[2.25]");
  put("points.csv", "theta_deg\n60\n");
  const std::vector<double> few = lookup_dolp();
  put("points.csv", "theta_deg,sigma,q\n60,0.27,2.25\n");
  EXPECT_EQ(few, lookup_dolp());
}

TEST_F(TableAsScene, EveryCommand_TakesATable) {
  make_table("--set grid.theta_deg=[0,40,60] --set grid.sigma=[0.2,0.3] --set grid.q=[3]");
  succeeded(dolp("table t.nc -o again.nc --quiet"));
  put("points.csv", "theta_deg,sigma,q\n40,0.2,3\n");
  const std::string values = lookup().out;
  EXPECT_EQ(dolp("lookup again.nc --points points.csv -o -").out, values);
  EXPECT_EQ(report("plan t.nc")["entries"], 6);
  succeeded(dolp("response t.nc -o r.nc --quiet"));
  put("geometries.csv", "theta_i_deg,theta_r_deg,delta_phi_deg\n30,30,180\n");
  EXPECT_EQ(dolp("mueller t.nc --points geometries.csv -o -").out,
            dolp("mueller scene.toml --points geometries.csv -o -").out);
  expect_refused(dolp("eval r.nc --points points.csv -o -"), "r.nc: is a response table, which has no material");
  succeeded(dolp("response r.nc -o again.nc --quiet"));
  expect_refused(dolp("table t.nc -o t.nc"), "t.nc: the output would overwrite an input");
  EXPECT_EQ(lookup().out, values);
}

TEST_F(TableAsScene, AxisOfNames_NeedsItsColumn) {
  make_table("--set surface.n=none --set surface.k=none --set grid.material=[\"iron\",\"water\"]");
  expect_refused(lookup(), "t.nc: grid.material has 2 values; add the column \"material\" to points.csv");
}

// The table stores n and k of the file, so the file may go. At another wavelength only the file would know them.
TEST_F(TableAsScene, DataOfFiles_ComeFromTheTable) {
  put("glass.csv", "wavelength_um,n,k\n8,1.5,0.1\n12,1.9,0.3\n");
  const Words glass = "--set surface.material_file=glass.csv --set grid.sigma=[0.2]";
  make_table(glass);
  put("points.csv", "theta_deg,sigma,q\n60,0.2,3\n");
  const std::vector<double> expected = eval_scene(glass);
  std::filesystem::remove(at("glass.csv"));
  EXPECT_EQ(lookup_dolp(), expected);
  expect_refused(dolp("eval t.nc --points points.csv -o - --set spectrum.wavelength_um=9"),
                 "\"glass.csv\" are known at ");
  put("points.csv", "theta_deg,wavelength_um\n60,9\n");
  expect_refused(lookup(), "points.csv:2: wavelength_um = 9: ");
}

TEST_F(TableAsScene, OtherMaterialByName_IsBuiltIn) {
  make_table("--set surface.material=iron --set grid.sigma=[0.2]");
  put("points.csv", "theta_deg,sigma,q,wavelength_um\n60,0.2,3,9\n");
  const auto eval_of = [&](const char* source, const char* material) {
    const Words end = "--points points.csv -o - --evaluator cpu --set grid.sigma=[0.2] --set";
    return parse_csv(dolp(joined(joined({"eval", source}, end), {std::string("surface.material=") + material})).out);
  };
  for (const char* material : {"iron", "gold (Ordal)"})
    EXPECT_EQ(eval_of("t.nc", material).at("dolp"), eval_of("scene.toml", material).at("dolp")) << material;
}

// The table stores the scene together with the rows of the sky. This text is long for an attribute.
TEST_F(TableAsScene, LongProfile_ComesFromTheTable) {
  std::string rows = "wavelength_um,zenith_deg,temperature_K\n";
  for (int wavelength = 8; wavelength <= 12; ++wavelength) {
    for (int i = 0; i < 1000; ++i) rows += fmt::format("{},{},{}\n", wavelength, i / 999.0 * 90.0, 220 + wavelength);
  }
  put("sky.csv", rows);
  const Words settings = "--set surroundings={profile=\"sky.csv\"} --set grid={theta_deg=[0,30,60],sigma=[0.2]}";
  make_table(settings);
  EXPECT_LT(std::filesystem::file_size(at("t.nc")), rows.size() + 100'000);
  put("points.csv", "theta_deg,sigma\n30,0.2\n");
  const std::vector<double> expected = eval_scene(settings);
  std::filesystem::remove(at("sky.csv"));
  EXPECT_EQ(lookup_dolp(), expected);
}

TEST_F(TableAsScene, NoTable_IsRefusedInOneLine) {
  expect_refused(lookup(), "t.nc: there is no such file");
  put("t.nc", "title = 1\n");
  expect_refused(lookup(), "t.nc: is not a NetCDF table of dolp");
  succeeded(dolp("table scene.toml -o t.csv --quiet"));
  expect_refused(dolp("plan t.csv"), "t.csv: only a table written as .nc holds its scene");
  expect_refused(dolp("lookup scene.toml --points points.csv -o -"), "scene.toml: is a scene and no table");
}

// Along theta a parabola through the entries would be exact for a quantity a + b theta^2; here the right values come
// from `eval` at the point that the report names.
TEST_F(TableAsScene, VerifyBetween_ReportsWhatInterpolationCosts) {
  make_table("--set grid.theta_deg={from=0,to=80,count=17} --set grid.sigma=[0.2] --set grid.q=[3] --tolerance 1e-7");
  const json found = report("verify t.nc --between 200 --quantities dolp,rho_i")["between"];
  ASSERT_EQ(found.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found[i]["quantity"], i < 2 ? "dolp" : "rho_i");
    EXPECT_EQ(found[i]["method"], i % 2 == 0 ? "linear" : "cubic");
    EXPECT_EQ(found[i]["compared"], 200);
    EXPECT_LE(found[i]["median"], found[i]["p95"]);
    EXPECT_LE(found[i]["p95"], found[i]["largest"]);
  }
  EXPECT_LT(found[1]["median"], found[0]["median"].get<double>() / 10.0);
  const double theta_deg = found[0]["at"]["theta_deg"], below = std::floor(theta_deg / 5.0) * 5.0;
  put("points.csv", fmt::format("theta_deg\n{:.17g}\n{}\n{}\n", theta_deg, below, below + 5.0));
  const std::vector<double> right = lookup_dolp();
  const double linear = std::lerp(right[1], right[2], (theta_deg - below) / 5.0);
  constexpr double kTwoTolerances = 2e-7;
  EXPECT_NEAR(found[0]["largest"], std::abs(linear - right[0]), kTwoTolerances);
  expect_refused(dolp("verify t.nc --between 9 --quantities dolps"), "t.nc: has no quantity \"dolps\"; it has dolp, ");
}

// The angle 179 differs from 1 by 2. Slopes along and across turn it through 0.
TEST_F(TableAsScene, VerifyBetween_AnglesDifferByAtMostARightAngle) {
  make_table(
      "--set surface.masking=v-cavity --set surface.sigma_cross=0.4 --set grid.theta_deg=[40] --set "
      "grid.surface_azimuth_deg={from=-60,to=60,count=5} --set grid.sigma=[0.2] --set grid.q=[3] --set "
      "surroundings.temperature_K=400");
  const auto [least, most] = std::ranges::minmax(dolp::read_table(at("t.nc"))[dolp::Quantity::kAolp]);
  ASSERT_GT(most - least, 90.0);
  const json found = report("verify t.nc --between 50 --quantities aolp_deg")["between"];
  EXPECT_GT(found[0]["largest"], 1.0);
  EXPECT_LE(found[0]["largest"], 90.0);
}

// On an axis with logarithmic spacing the interpolation is linear in the logarithm, so two more values in each decade
// than a linear axis would need suffice. The advice of plan makes both kinds of table good enough.
TEST_F(TableAsScene, PlansNumbersOfValues_AreAboutEnough_AndHalfOfThemAreTooFew) {
  const Words common = "--set grid.q=[3] --tolerance 1e-4";
  const auto grid = [&](int thetas, int sigmas) {
    const std::string theta = fmt::format("--set grid.theta_deg={{from=0,to=80,count={}}}", thetas);
    const std::string sigma = fmt::format(" --set grid.sigma={{from=0.05,to=0.5,count={},spacing=\"log\"}}", sigmas);
    return joined(common, theta + sigma);
  };
  const json advice = report(joined("plan scene.toml", grid(20, 10)))["between"];
  ASSERT_EQ(advice.size(), 2U);
  const int thetas = advice[0]["needed_values"], sigmas = advice[1]["needed_values"];
  const auto typical_error = [&](int of_theta, int of_sigma) {
    make_table(grid(of_theta, of_sigma));
    return report("verify t.nc --between 300")["between"][0]["p95"].get<double>();
  };
  EXPECT_LT(typical_error(thetas, sigmas), 1e-4);
  EXPECT_GT(typical_error(thetas / 3, sigmas / 3), 1e-4);
}

TEST_F(TableAsScene, PlansNumberOfValues_WhereTheGridHasIt_IsThatOfTheGrid) {
  const json advice =
      report("plan scene.toml --tolerance 0.01 --set grid.theta_deg=[10,20] --set grid.sigma=[0.2] --set grid.q=[3]")
          ["between"];
  EXPECT_EQ(advice[0]["needed_values"], 2);
}

// At a temperature between the values, the polarisation of the emission and of the reflected sky cancel, and DOLP is 0.
// There linear interpolation errs in proportion to the spacing, not to its square.
TEST_F(TableAsScene, PlansNumberOfValues_AtAKinkOfDolp_IsAboveOneThatDoesNotSuffice) {
  for (const int count : {8, 20}) {
    const Words scene = "plan scene.toml --tolerance 1e-4 --set surroundings.temperature_K=285.3";
    const Words grid = fmt::format(
        "--set grid.theta_deg=[60] --set grid.sigma=[0.2] --set grid.q=[3] --set "
        "grid.temperature_K={{from=270,to=300,count={}}}",
        count);
    const json advice = report(joined(scene, grid))["between"];
    ASSERT_EQ(advice.size(), 1U);
    EXPECT_GT(advice[0]["largest"], 1e-4);
    EXPECT_GT(advice[0]["needed_values"], 4 * count);
  }
}

}  // namespace lookup_test
