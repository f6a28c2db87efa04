// The commands that draw the paper's figures, and what section 5 of shaders/physics/README.md states about the curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cli_support.hpp"

namespace paper_figure_test {

using namespace dolp;
using nlohmann::json;
namespace fs = std::filesystem;

// The manual rounds DOLP to 0.01 percentage points, angles to 0.1 degrees and G to 0.001. The computed curves have
// errors, too: they have a point every 0.1 degrees, and their tolerance is 0.01 percentage points of DOLP.
constexpr double kPointTolerance = 0.02;
constexpr double kAngleToleranceDeg = 0.2;
constexpr double kAttenuationTolerance = 6e-4;
constexpr double kSlopeTolerancePerRad = 6e-3;
constexpr std::size_t kLargestPictureBytes = 120'000;

class PaperFigure : public InFolder {
 protected:
  Outcome figure(const Words& options, const std::string& program = DOLP_PROGRAM) const {
    Words arguments = joined({"/usr/bin/python3", DOLP_PAPER_FIGURE}, options);
    if (!program.empty()) arguments.insert(arguments.end(), {"--program", program});
    return run({.arguments = std::move(arguments), .folder = folder()});
  }
  json numbers(const std::string& number, const Words& options = {}) const {
    return printed_json(figure(joined(number + " --json --evaluator cpu", options)));
  }
  json numbers_and_picture(const std::string& number) const {
    json report = numbers(number, "-o f.png");
    const std::string picture = content("f.png");
    EXPECT_TRUE(picture.starts_with("\x89PNG"));
    EXPECT_LT(picture.size(), kLargestPictureBytes);
    return report;
  }
};

/// The only element of `list` that has all members of `wanted` with equal values.
const json& one_of(const json& list, const json& wanted) {
  const auto matches = [&](const json& entry) {
    return std::ranges::all_of(wanted.items(), [&](const auto& item) { return entry.at(item.key()) == item.value(); });
  };
  EXPECT_EQ(std::ranges::count_if(list, matches), 1) << wanted.dump();
  return *std::ranges::find_if(list, matches);
}

json curve_of(const json& report, const std::string& sample, const std::string& reading, const std::string& mode,
              const std::string& distribution) {
  return one_of(report["curves"],
                {{"sample", sample}, {"reading", reading}, {"mode", mode}, {"distribution", distribution}});
}

double percent_at(const json& curve, double theta_deg) {
  const json& angles = curve["theta_deg"];
  const auto place = std::ranges::find(angles, json(theta_deg));
  return curve["dolp_percent"].at(static_cast<std::size_t>(place - angles.begin())).get<double>();
}

struct Peak {
  std::string sample, reading, distribution;
  double theta_deg, dolp_percent;
};

const std::vector<Peak> kPeaks = {{"steel", "integral", "cauchy", 70.5, 14.00},
                                  {"steel", "integral", "gaussian", 72.4, 14.31},
                                  {"aluminium", "integral", "cauchy", 79.1, 2.47},
                                  {"aluminium", "integral", "gaussian", 79.7, 2.45},
                                  {"steel", "smith", "cauchy", 73.8, 15.24},
                                  {"steel", "smith", "gaussian", 76.2, 17.23},
                                  {"aluminium", "smith", "cauchy", 74.6, 2.23},
                                  {"aluminium", "smith", "gaussian", 75.7, 2.69},
                                  {"steel with sigma of aluminium", "integral", "cauchy", 77.5, 3.27},
                                  {"steel with sigma of aluminium", "smith", "cauchy", 73.9, 3.03}};

void expect_peaks_between_70_and_80(const json& report) {
  for (const Peak& peak : kPeaks) {
    SCOPED_TRACE(peak.sample + ", " + peak.reading + ", " + peak.distribution);
    const json curve = curve_of(report, peak.sample, peak.reading, "bistatic", peak.distribution);
    ASSERT_FALSE(curve["peak"].is_null());
    EXPECT_NEAR(curve["peak"]["theta_deg"], peak.theta_deg, kAngleToleranceDeg);
    EXPECT_NEAR(curve["peak"]["dolp_percent"], peak.dolp_percent, kPointTolerance);
    EXPECT_TRUE(curve["model_fails_from_deg"].is_null());
    EXPECT_LT(percent_at(curve, 90.0), 0.9 * peak.dolp_percent);
    EXPECT_LT(percent_at(curve, 0.0), peak.dolp_percent);
  }
}

void expect_rougher_is_lower(const json& report) {
  const auto above = [&](const std::string& reading, const std::string& mode, const std::string& distribution) {
    return one_of(report["rougher"],
                  {{"reading", reading}, {"mode", mode}, {"distribution", distribution}})["aluminium_above_steel_deg"];
  };
  for (const std::string distribution : {"cauchy", "gaussian"}) {
    SCOPED_TRACE(distribution);
    const json near_zero = above("integral", "bistatic", distribution);
    ASSERT_EQ(near_zero.size(), 1U);
    EXPECT_GT(near_zero[0][0], 27.0);
    EXPECT_LT(near_zero[0][1], 29.5);
    for (const json& range : above("smith", "bistatic", distribution))
      EXPECT_TRUE(range[1] < 6.0 || range[0] > 89.0) << range.dump();
    for (const std::string reading : {"integral", "smith"})
      EXPECT_EQ(above(reading, "hemispherical", distribution).size(), 0U) << reading;
  }
}

void expect_hemispherical_rises(const json& report) {
  int seen = 0;
  for (const json& curve : report["curves"]) {
    if (curve["mode"] != "hemispherical") continue;
    ++seen;
    EXPECT_TRUE(curve["peak"].is_null()) << curve.dump();
    EXPECT_GT(curve["model_fails_from_deg"], 87.5);
    EXPECT_LT(curve["model_fails_from_deg"], 89.0);
    EXPECT_LT(percent_at(curve, 75.0), percent_at(curve, 87.0));
  }
  EXPECT_EQ(seen, 10);
}

struct Difference {
  std::string sample, reading;
  double below_60, from_70_to_80, at_peak;
};

void expect_differences(const json& report) {
  const std::vector<Difference> list = {{"steel", "integral", -0.31, -0.90, -0.25},
                                        {"aluminium", "integral", 0.09, 0.06, 0.02},
                                        {"steel", "smith", -0.56, -2.59, -1.83},
                                        {"aluminium", "smith", -0.27, -0.48, -0.45}};
  for (const Difference& expected : list) {
    SCOPED_TRACE(expected.sample + ", " + expected.reading);
    const json found = one_of(report["cauchy_minus_gaussian"],
                              {{"sample", expected.sample}, {"reading", expected.reading}, {"mode", "bistatic"}});
    EXPECT_NEAR(found["below_60"]["points"], expected.below_60, kPointTolerance);
    EXPECT_NEAR(found["from_70_to_80"]["points"], expected.from_70_to_80, kPointTolerance);
    EXPECT_NEAR(found["at_cauchy_peak"], expected.at_peak, kPointTolerance);
  }
}

TEST_F(PaperFigure, Figure7_HasTheCurvesThatTheModelsReadmeStates) {
  const json report = numbers_and_picture("7");
  expect_peaks_between_70_and_80(report);
  expect_rougher_is_lower(report);
  expect_hemispherical_rises(report);
  expect_differences(report);
}

TEST_F(PaperFigure, Table_DefaultEvaluator_PrintsAttenuation) {
  EXPECT_TRUE(contains(succeeded(figure("4 --table")).out,
                       "| v-cavity | cauchy | 30° | 1.000 | 1.000 | 1.000 | 1.000 | 0.786 | 0.000 | −2.33/rad"));
}

TEST_F(PaperFigure, Table_Sample_PrintsPeaksAndThePapersAngles) {
  const Outcome outcome = succeeded(figure("5 --table --evaluator cpu"));
  EXPECT_TRUE(contains(outcome.out, "| integral | bistatic | steel | cauchy | 14.00 at 70."));
  for (const char* angle : {"\n| 0° |", "\n| 54° |", "\n| 63° |", "\n| 90° |"})
    EXPECT_TRUE(contains(outcome.out, angle));
}

TEST_F(PaperFigure, Set_UnprintedValue_ChangesTheCurves) {
  // Without reflection the surface is black, and its emission is unpolarised.
  const json black = numbers("5", "--set surface.diffuse=0 --set surface.specular=0");
  for (const json& curve : black["curves"])
    for (const json& value : curve["dolp_percent"]) EXPECT_LT(value.get<double>(), 1e-9) << curve.dump();
  const json sunlit = numbers("5", "--set source.relative_irradiance=0.006");
  const json curve = curve_of(sunlit, "steel", "integral", "bistatic", "cauchy");
  EXPECT_TRUE(curve["peak"].is_null());
  for (const json& value : curve["dolp_percent"]) EXPECT_TRUE(value > 4.4 - kPointTolerance && value < 4.7) << value;
}

TEST_F(PaperFigure, BadUsage_OneLineThatSaysWhatIsWrong) {
  for (const auto& [line, status, message] :
       {std::tuple("", 2, "figure"),
        {"8 --table", 2, "choose from 4, 5, 6, 7"},
        {"5", 2, "-o FIGURE.png, --table or --json"},
        {"5 -o f.jpg", 2, "f.jpg: the name of the picture must end in .png"},
        {"5 -o none/f.png", 4, "none/f.png: there is no folder none"},
        {"5 --table --set surface.sigma=1", 2, "surface.sigma=1: the key must be one of surface.q, "},
        {"5 --table --set surface.q=wide", 2, "surface.q=wide: the value must be a number"},
        {"5 --table --evaluator cpu --set surface.q=0.5", 2, "0.5 is out of range"},
        {"4 --table --set surface.q=3", 2, "--set is for figures 5, 6 and 7"}})
    expect_refused(figure(line), message, status, "paper_figure.py");
}

TEST_F(PaperFigure, ProgramThatFails_OneLineAndNotZero) {
  for (const auto& [program, status, message] : {std::tuple("/no/such/dolp", 2, "/no/such/dolp: No such file"),
                                                 {"/bin/false", 1, "has failed"},
                                                 {"/bin/true", 5, "/bin/true: wrote 0 rows for 901 points"}})
    expect_refused(figure("6 --json", program), message, status, "paper_figure.py");
}

struct Values {
  std::string masking, distribution;
  double theta_i_deg;
  std::vector<double> g;  ///< masking G at theta_r = 30, 60, 75 and 90 degrees
  double corner_deg, jump_per_rad;
};

TEST_F(PaperFigure, Figure4_Attenuation_IntegralHasNoKinkAsVCavityHas) {
  const json report = numbers_and_picture("4");
  ASSERT_EQ(report["curves"].size(), 4U);
  const std::vector<Values> list = {{"integral", "cauchy", 30.0, {0.997, 0.965, 0.902, 0.739}, 30.0, -0.016},
                                    {"v-cavity", "cauchy", 30.0, {1.0, 1.0, 0.786, 0.0}, 70.0, -2.33},
                                    {"integral", "gaussian", 30.0, {1.0, 0.997, 0.958, 0.782}, NAN, 0.0},
                                    {"integral", "cauchy", 85.0, {}, 85.0, -1.04}};
  for (const Values& expected : list) {
    SCOPED_TRACE(expected.masking + ", " + expected.distribution);
    const json curve = one_of(report["curves"], {{"masking", expected.masking},
                                                 {"distribution", expected.distribution},
                                                 {"theta_i_deg", expected.theta_i_deg}});
    ASSERT_EQ(curve["theta_r_deg"], json({0, 30, 60, 70, 75, 90}));
    constexpr std::size_t kPlaces[] = {1, 2, 4, 5};
    for (std::size_t i = 0; i < expected.g.size(); ++i)
      EXPECT_NEAR(curve["g"][kPlaces[i]], expected.g[i], kAttenuationTolerance);
    EXPECT_NEAR(curve["corner"]["slope_jump_per_rad"], expected.jump_per_rad, kSlopeTolerancePerRad);
    if (std::isfinite(expected.corner_deg)) {
      EXPECT_NEAR(curve["corner"]["theta_deg"], expected.corner_deg, kAngleToleranceDeg);
    }
  }
}

}  // namespace paper_figure_test
