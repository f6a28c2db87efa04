// Measured data and ranges of parameters, as users give them.
#include <gtest/gtest.h>

#include <dolp/fit.hpp>

#include "error_text.hpp"

namespace dolp::fit::input_test {
namespace {

TEST(MeasuredData, Columns_AreReadAndCheckedLineByLine) {
  const MeasuredData data =
      MeasuredData::from_csv("# a comment\ntheta_deg,dolp,uncertainty,wavelength_um\n30,0.1,0.01,10\n", "f.csv");
  ASSERT_EQ(data.measurements.size(), 1U);
  EXPECT_EQ(data.measurements.front().observable, Observable::kDolp);
  EXPECT_EQ(data.measurements.front().theta_deg, 30.0);
  EXPECT_EQ(data.measurements.front().uncertainty, 0.01);
  EXPECT_EQ(data.measurements.front().wavelength_um, 10.0);
  EXPECT_TRUE(data.has_uncertainties);
  EXPECT_EQ(MeasuredData::from_csv("theta_deg,emissivity_s,emissivity_p\n1,0.8,0.9\n", "f").measurements.size(), 2U);
  for (const auto& [text, message] : {
           std::pair("", "f.csv:1: the file is empty"),
           {"# nothing\n", "f.csv:1: the file is empty"},
           {"theta_deg,dolp\n", "f.csv:1: no points"},
           {"theta_deg,dolp\n20,nan\n", "f.csv:2: dolp = nan: not a number"},
           {"theta_deg,dolp\n20\n", "f.csv:2: dolp: the value is missing"},
           {"theta_deg,dolp\n20,0.1,0.2\n", "f.csv:2: 0.2: one value too many"},
           {"theta_deg,dolp\n1,12\n", "f.csv:2: dolp = 12: out of range"},
           {"theta_deg,dolp\n1,-0.1\n",
            "f.csv:2: dolp = -0.1: must not be negative; a signed Q/I goes in a column q_over_i"},
           {"theta_deg,dolp,uncertainty\n1,0.1,0\n", "f.csv:2: uncertainty = 0: out of range"},
           {"dolp\n1\n", "f.csv:1: column \"theta_deg\" is missing"},
           {"theta_deg,dolp,std\n", "f.csv:1: column \"std\" is unknown; allowed are theta_deg"},
           {"theta_deg,unc\n", "f.csv:1: column \"unc\" is unknown; the nearest known is uncert"},
           {"theta_deg,dolp,dolp\n20,0.1,0.1\n", "f.csv:1: column \"dolp\" appears twice"},
           {"theta_deg,dolp,q_over_i\n1,0,0\n", "f.csv:1: several measured quantities"},
           {"theta_deg,dolp,emissivity_s\n20,0.1,0.9\n", "f.csv:1: several measured quantities"},
       }) {
    const std::string error = error_text([&, csv = text] { MeasuredData::from_csv(csv, "f.csv"); });
    EXPECT_TRUE(error.starts_with(message)) << error;
  }
  EXPECT_NE(error_text([] {
              MeasuredData::from_csv("theta_deg,theta_i_deg,dolp\n20,20,0.1\n", "f.csv");
            }).find("give one of them"),
            std::string::npos);
}

TEST(MeasuredData, ProbablyInAnotherUnit_IsOneRemark) {
  for (const auto& [text, remark] : {
           std::pair("theta_deg,dolp\n0.1,0.1\n1.5,0.2\n", "f: theta_deg is at most 1.5 degrees; is it in radians?"),
           {"theta_deg,dolp\n10,0.1\n60,0.93\n", "f: dolp rises to 0.93; is it in percent? 1 is fully polarised"},
           {"theta_deg,q_over_i\n10,-0.1\n60,-1\n", "f: q_over_i rises to 1; is it in percent? 1 is fully polarised"},
           {"theta_deg,dolp,wavelength_um\n10,0.1,3000\n60,0.2,5000\n",
            "f: wavelength_um is at least 3000; is it in nanometres?"},
       }) {
    EXPECT_EQ(MeasuredData::from_csv(text, "f").remarks, std::vector<std::string>{remark});
  }
  for (const char* text : {"theta_deg,dolp\n0,0.1\n", "theta_deg,dolp\n1,0.1\n1.6,0.2\n", "theta_deg,dolp\n60,0.89\n",
                           "theta_deg,emissivity_s\n60,0.99\n", "theta_deg,dolp,wavelength_um\n60,0.1,1000\n"}) {
    EXPECT_TRUE(MeasuredData::from_csv(text, "f").remarks.empty()) << text;
  }
}

TEST(FitParameter, Coordinates_AreLogarithmicOverADecade) {
  const FitRange wide = FitRange::from_text("surface.sigma=0.01:1");
  EXPECT_NEAR(wide.at(0.5), 0.1, 1e-15);
  const FitRange narrow = FitRange::from_text("surface.n=1:2:1.25");
  EXPECT_NEAR(narrow.at(0.5), 1.5, 1e-15);
  EXPECT_EQ(narrow.start, 1.25);
  for (const FitRange& one : {wide, narrow}) {
    EXPECT_NEAR(one.coordinate(one.at(0.3)), 0.3, 1e-14);
    EXPECT_NEAR(one.slope(one.at(0.3)), (one.at(0.3 + 1e-6) - one.at(0.3 - 1e-6)) / 2e-6, 1e-6);
  }
}

}  // namespace
}  // namespace dolp::fit::input_test
