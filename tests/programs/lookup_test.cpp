// `dolp lookup` as a user runs it: its results and error estimates, compared with `dolp eval`, and its messages.
#include <gtest/gtest.h>

#include <random>

#include <dolp/status.hpp>
#include "cli_support.hpp"

namespace {

using namespace dolp;
using nlohmann::json;

std::string random_points(std::size_t count) {
  std::mt19937_64 engine(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(engine);
  };
  std::ostringstream text;
  text.precision(17);
  text << "theta_deg,sigma,q\n";
  for (std::size_t i = 0; i < count; ++i) {
    text << uniform(0.0, 85.0) << ',' << uniform(0.1, 0.8) << ',' << uniform(2.0, 5.0) << '\n';
  }
  return text.str();
}

class Lookup : public CommandLine {
 protected:
  void make_table(const std::vector<std::string>& options) const {
    const Outcome outcome = dolp(joined({"table", "scene.toml", "-o", "t.nc", "--quiet"}, options));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  /// 18 x 12 x 7 entries.
  void make_fine_table(const std::string& masking = "integral") const {
    make_table({"--set", "grid.theta_deg={from=0,to=85,count=18}", "--set",
                "grid.sigma={from=0.1,to=0.8,count=12,spacing=\"log\"}", "--set", "grid.q={from=2,to=5,count=7}",
                "--set", "surface.masking=" + masking});
  }
  Outcome lookup(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"lookup", "t.nc", "--points", "points.csv", "-o", "-"});
    return dolp(options);
  }
  Columns looked_up(const std::vector<std::string>& options = {}) const {
    const Outcome outcome = lookup(options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return parse_csv(outcome.out);
  }
};

TEST_F(Lookup, RandomPoints_AgreeWithEvalWithinTheStatedErrors) {
  put("points.csv", random_points(200));
  for (const char* masking : {"v-cavity", "integral"}) {
    SCOPED_TRACE(masking);
    make_fine_table(masking);
    const Columns found = looked_up();
    const Columns exact = eval({"--tolerance", "1e-6", "--set", "surface.masking=" + std::string(masking)});
    ASSERT_EQ(found.at("dolp").size(), 200U);
    std::vector<double> errors;
    for (std::size_t i = 0; i < 200; ++i) {
      if (!promises_dolp(static_cast<std::uint32_t>(exact.at("status")[i]))) continue;
      const double dolp_error = found.at("error_estimate")[i] + exact.at("error_estimate")[i];
      EXPECT_NEAR(found.at("dolp")[i], exact.at("dolp")[i], dolp_error) << i;
      const double rho = exact.at("rho_i")[i];
      const double rho_error = (found.at("rho_error_estimate")[i] + exact.at("rho_error_estimate")[i]) * rho;
      EXPECT_NEAR(found.at("rho_i")[i], rho, rho_error) << i;
      EXPECT_NEAR(found.at("rho_q")[i], exact.at("rho_q")[i], rho_error) << i;
      errors.push_back(found.at("error_estimate")[i]);
    }
    std::ranges::sort(errors);
    EXPECT_LT(errors.at(errors.size() / 2), 2e-4);
  }
}

TEST_F(Lookup, AbsentColumns_ComeFromTheScene) {
  make_fine_table();
  put("points.csv", "theta_deg\n60\n");
  const Columns few = looked_up();
  put("points.csv", "theta_deg,sigma,q\n60,0.3,3\n");
  EXPECT_EQ(few.at("dolp"), looked_up().at("dolp"));
}

// The table stores the scene together with the rows of the sky. This text is too long for an attribute of NetCDF.
TEST_F(Lookup, TableWithALongProfile_HasItsScene) {
  std::ostringstream text;
  text << "wavelength_um,zenith_deg,temperature_K\n";
  for (int wavelength = 8; wavelength <= 12; ++wavelength) {
    for (int i = 0; i < 1000; ++i) text << wavelength << ',' << i / 999.0 * 90.0 << ',' << 220 + wavelength << '\n';
  }
  const std::string rows = text.str();
  put("sky.csv", rows);
  make_table({"--set", "surroundings={profile=\"sky.csv\"}", "--evaluator", "cpu", "--set",
              "grid={theta_deg=[0,30,60],sigma=[0.2]}"});
  EXPECT_LT(std::filesystem::file_size(at("t.nc")), rows.size() + 100'000);
  put("points.csv", "theta_deg\n30\n");
  const Columns found = looked_up();
  EXPECT_EQ(found.at("dolp"),
            eval({"--set", "surroundings={profile=\"sky.csv\"}", "--set", "surface.sigma=0.2"}).at("dolp"));
}

TEST_F(Lookup, CoarseTable_SaysThatItMissesTheTolerance) {
  make_table({});
  put("points.csv", "theta_deg,sigma,q\n70,0.2,2.5\n");
  const Columns found = looked_up();
  // Status bits. 2: DOLP misses the tolerance. 16: rho misses it. 32: single scattering is not enough.
  EXPECT_EQ(found.at("status")[0], 2.0 + 16.0 + 32.0);
  EXPECT_GT(found.at("error_estimate")[0], 1e-3);
  EXPECT_EQ(lookup({"--strict"}).status, 1);
  const Columns exact = eval({});
  EXPECT_NEAR(found.at("dolp")[0], exact.at("dolp")[0], found.at("error_estimate")[0]);
}

TEST_F(Lookup, Json_NamesTableAndErrors) {
  make_table({});
  const json report = this->report({"lookup", "t.nc", "--points", "points.csv", "-o", "out.csv"});
  EXPECT_EQ(report["table"], "t.nc");
  EXPECT_EQ(report["points"], 3);
  EXPECT_EQ(report["tolerance"], 1e-4);
  EXPECT_LE(report["worst_error_estimate"], 1e-4);
  EXPECT_EQ(parse_csv(content("out.csv")).at("dolp").size(), 3U);
}

TEST_F(Lookup, WindsOutsideTheTable_AreNamedAsWinds) {
  make_table({"--set", "surface.distribution=gaussian", "--set", "grid.wind_m_s=[5,10]"});
  put("points.csv", "theta_deg,wind_m_s\n30,12\n");
  expect_refused(lookup(), "points.csv:2: wind_m_s = 12: outside the table, which has [5, 10]");
}

TEST_F(Lookup, BadPoints_NameLineColumnAndRange) {
  make_table({});
  put("points.csv", "theta_deg,sigma,q\n30,0.2,2\n81,0.2,2\n");
  expect_refused(lookup(), "points.csv:3: theta_deg = 81: outside the table, which has [0, 80.5]");
  put("points.csv", "theta_deg,sigma\n30,0.5\n");
  expect_refused(lookup(), "points.csv:2: sigma = 0.5: outside the table, which has [0.1, 0.4]");
  put("points.csv", "sigma,q\n0.2,2\n");
  expect_refused(lookup(), "points.csv:1: column \"theta_deg\" is missing, a number in [0, 80.5]");
  put("points.csv", "theta_deg,n\n30,1.6\n");
  expect_refused(lookup(), "points.csv:2: n = 1.6: the table is of n = 1.5; dolp eval computes other values");
  put("points.csv", "theta_deg,n,k\n30,1.5,0.1\n");
  EXPECT_EQ(lookup().status, 0);
}

TEST_F(Lookup, BadTable_IsRefused) {
  expect_refused(lookup(), "t.nc: there is no such file");
  ASSERT_EQ(dolp({"table", "scene.toml", "-o", "t.csv", "--quiet"}).status, 0);
  expect_refused(dolp({"lookup", "t.csv", "--points", "points.csv", "-o", "-"}), "t.csv: only a table written as .nc");
}

TEST_F(Lookup, OutputOverAnInput_IsRefused) {
  make_table({});
  const std::string before = content("t.nc");
  expect_refused(dolp({"lookup", "t.nc", "--points", "points.csv", "-o", "t.nc"}), "would overwrite an input");
  EXPECT_EQ(content("t.nc"), before);
}

}  // namespace
