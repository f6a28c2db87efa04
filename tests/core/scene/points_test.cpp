// The reader of points files: accepted notations, every error, and numbers that do not change when written and read.
#include "scene/points.hpp"
#include "error_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "base/text.hpp"

namespace dolp::points_test {
namespace {

Points directions(const std::string& text) { return parse_points(text, "p.csv", PointsKind::kDirections); }

std::string error_of(const std::string& text, PointsKind kind = PointsKind::kDirections) {
  return error_text([&] { parse_points(text, "p.csv", kind); });
}

TEST(Points_Directions, HaveTheColumnsOfTheHeader) {
  const Points points = directions("q,theta_deg\n2,0\n1.5,90\n");
  EXPECT_EQ(points.size(), 2U);
  EXPECT_EQ(*points[Axis::kTheta], (std::vector<double>{0.0, 90.0}));
  EXPECT_EQ(*points[Axis::kQ], (std::vector<double>{2.0, 1.5}));
  EXPECT_FALSE(points[Axis::kSigma] || points[Axis::kN] || points[Axis::kK]);
}

TEST(Points_Geometries, HaveThreeAnglesAndAnyOfTheRest) {
  const Points points = parse_points("theta_i_deg,theta_r_deg,delta_phi_deg,sigma,n,k\n1,2,-180,0,1.5,0\n", "p.csv",
                                     PointsKind::kGeometries);
  EXPECT_EQ(*points[Axis::kTheta], std::vector<double>{1.0});
  EXPECT_EQ(*points[Axis::kViewZenith], std::vector<double>{2.0});
  EXPECT_EQ(*points[Axis::kRelativeAzimuth], std::vector<double>{-180.0});
  EXPECT_EQ(*points[Axis::kSigma], std::vector<double>{0.0});
  EXPECT_EQ(*points[Axis::kN], std::vector<double>{1.5});
  EXPECT_EQ(*points[Axis::kK], std::vector<double>{0.0});
  EXPECT_FALSE(points[Axis::kQ]);
}

TEST(Points_Winds, GiveSigma) {
  const Points points = directions("theta_deg,wind_m_s\n60,5\n");
  EXPECT_TRUE(points.has_winds);
  EXPECT_EQ(points[Axis::kSigma], std::vector<double>{std::sqrt(0.0286 / 2)});
  EXPECT_EQ(points.header, "theta_deg,wind_m_s");
  for (const char* both : {"sigma,wind_m_s", "wind_m_s,sigma"})
    EXPECT_EQ(error_of(std::string(both) + "\n1,1\n"),
              "p.csv:1: columns \"sigma\" and \"wind_m_s\" cannot be combined");
}

TEST(Points_Cells, KeepTheirSpelling) {
  const Points points = directions("\xEF\xBB\xBF theta_deg , sigma\r\n 3.00e1 ,\t+0.10\r\n030,1E-1\r\n\r\n");
  EXPECT_EQ(points.header, "theta_deg,sigma");
  EXPECT_EQ(points.rows, (std::vector<std::string>{"3.00e1,+0.10", "030,1E-1"}));
  EXPECT_EQ(*points[Axis::kTheta], (std::vector<double>{30.0, 30.0}));
  EXPECT_EQ(*points[Axis::kSigma], (std::vector<double>{0.1, 0.1}));
}

TEST(Points_Results, AreLeftOut_AndNamed) {
  const Points points = parse_points("# written by a run\ntheta_deg,dolp,sigma,status\n30,\"0.1\",\"0.2\",0\n", "p.csv",
                                     PointsKind::kDirections, {"dolp", "stokes_i", "status"});
  EXPECT_EQ(points.left_out, (std::vector<std::string>{"dolp", "status"}));
  EXPECT_EQ(points.header, "theta_deg,sigma");
  EXPECT_EQ(points.rows, std::vector<std::string>{"30,0.2"});
  EXPECT_EQ(*points[Axis::kSigma], std::vector<double>{0.2});
}

TEST(Points_UpperCase_AndRowsWithoutValuesAtBothEnds, AreTaken) {
  const Points points = directions("\n \nTheta_deg,N\n60,1.5\n,\n , \n\n");
  EXPECT_EQ(points.size(), 1U);
  EXPECT_EQ(*points[Axis::kN], std::vector<double>{1.5});
  EXPECT_EQ(points.header, "Theta_deg,N");
}

TEST(Points_HeaderAlone, IsAnEmptyList) {
  for (const char* text : {"theta_deg", "theta_deg\n", "theta_deg\r\n\r\n"}) {
    const Points points = directions(text);
    EXPECT_EQ(points.size(), 0U);
    ASSERT_TRUE(points[Axis::kTheta]);
    EXPECT_TRUE(points[Axis::kTheta]->empty());
  }
}

TEST(Points_EndsOfTheRanges, AreAcceptedWhereClosed) {
  EXPECT_EQ(directions("theta_deg,sigma,q,n,k\n0,0,1.0001,1e-300,0\n90,10,1e4,1e6,1e6\n").size(), 2U);
}

TEST(PointsError_EveryOne, NamesFileLineColumnValueAndRange) {
  for (const auto& [text, expected] :
       {std::pair("", "p.csv:1: the file is empty"),
        {"\n\n", "p.csv:1: the file is empty"},
        {"teta_deg\n1\n", "p.csv:1: column \"teta_deg\" is unknown; the nearest known is theta_deg"},
        {"theta\n1\n", "p.csv:1: column \"theta\" is unknown; the nearest known is theta_deg"},
        {"theta_deg,\n1\n", "p.csv:1: column \"\" is unknown"},
        {"theta_i_deg\n1\n", "p.csv:1: column \"theta_i_deg\" is unknown; the nearest known is theta_deg"},
        {"1,2\n", "p.csv:1: the columns must be named first: theta_deg, sigma"},
        {"id\n1\n", "p.csv:1: column \"id\" is unknown; allowed are theta_deg"},
        {"k\n1 2\n", "p.csv:2: 2: one value too many after column k"},
        {"theta_deg,material\n1\n", "p.csv:2: material: the value is missing"},
        {"theta_deg,sigma\n1;0.1\n", "p.csv:2: 1;0.1: cells must be separated by commas, not semicolons; numbers must"},
        {"theta_deg,sigma\n1,5,0,1\n", "p.csv:2: 0: one value too many after column sigma, the last; numbers "},
        {"theta_deg,sigma\n\"1,5\",0.1\n",
         "p.csv:2: theta_deg = 1,5: not a number; must be a number in [0, 90]; numbers must have a decimal point"},
        {"q,q\n2,2\n", "p.csv:1: column \"q\" appears twice"},
        {"theta_deg,sigma\n1,0.1\n2\n", "p.csv:3: sigma: the value is missing; must be a number in [0, 10]"},
        {"theta_deg,sigma\n1,\n", "p.csv:2: sigma: the value is missing"},
        {"theta_deg,sigma\n ,1\n", "p.csv:2: theta_deg: the value is missing; must be a number in [0, 90]"},
        {"theta_deg\n1\n\n2\n", "p.csv:3: theta_deg: the value is missing"},
        {"theta_deg,q\n1,2\n,\n1,2\n", "p.csv:3: theta_deg: the value is missing"},
        {"theta_deg\n1,2\n", "p.csv:2: 2: one value too many after column theta_deg"},
        {"theta_deg\n1,\n", "p.csv:2: the row goes on after column theta_deg, the last; no separator may follow"},
        {"theta_deg\n91\n", "p.csv:2: theta_deg = 91: out of range; must be a number in [0, 90]"},
        {"theta_deg\n-1e-9\n", "p.csv:2: theta_deg = -1e-9: out of range; must be a number in [0, 90]"},
        {"sigma\n10.1\n", "p.csv:2: sigma = 10.1: out of range; must be a number in [0, 10]"},
        {"q\n1\n", "p.csv:2: q = 1: out of range; must be a number in (1, 1e4]"},
        {"n\n0\n", "p.csv:2: n = 0: out of range; must be a number in (0, 1e6]"},
        {"k\n-0.1\n", "p.csv:2: k = -0.1: out of range; must be a number in [0, 1e6]"},
        {"# comment\nteta_deg\n", "p.csv:2: column \"teta_deg\" is unknown"},
        {"theta_deg\n# comment\n91\n", "p.csv:3: theta_deg = 91: out of range"},
        {"theta_deg,dolp\n1,2\n", "p.csv:1: column \"dolp\" is unknown"}})
    EXPECT_TRUE(error_of(text).starts_with(expected)) << error_of(text);
}

TEST(PointsError_NotANumber, IsRefusedWhateverItsForm) {
  for (const char* cell :
       {"1e", "nan", "NaN", "inf", "-inf", "1.5x", "x", "0x10", "--1", "+-1", "+", "1e999", "1d3", "1_0"}) {
    const std::string expected = std::string("p.csv:2: k = ") + cell + ": not a number; must be a number in [0, 1e6]";
    EXPECT_EQ(error_of(std::string("k\n") + cell + "\n"), expected);
  }
}

TEST(PointsError_MissingAngle, IsNamed) {
  EXPECT_TRUE(error_of("theta_i_deg,theta_r_deg\n1,1\n", PointsKind::kGeometries)
                  .starts_with("p.csv:1: column \"delta_phi_deg\" is missing, a number in [-360, 360]"));
  EXPECT_EQ(
      error_of("theta_i_deg\n1\n", PointsKind::kGeometries),
      "p.csv:1: column \"theta_r_deg\" is missing, a number in [0, 90]; column \"delta_phi_deg\" is missing, a number "
      "in [-360, 360]");
  EXPECT_TRUE(
      error_of("theta_deg\n1\n", PointsKind::kGeometries).starts_with("p.csv:1: column \"theta_deg\" is unknown"));
}

TEST(Points_RandomNumbers, ArriveBitForBit) {
  constexpr std::uint64_t kSeed = 46;
  constexpr std::size_t kRows = 10000;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> exponent(-300.0, 6.0);
  std::vector<double> values;
  std::string text = "k\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    values.push_back(std::pow(10.0, exponent(random)));
    text += format_number(values.back()) + '\n';
  }
  EXPECT_EQ(*directions(text)[Axis::kK], values);
}

}  // namespace
}  // namespace dolp::points_test
