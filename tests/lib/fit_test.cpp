// Fits: they find known truths, and intervals agree with closed forms and with synthetic measurements.
#include "fit/fit.hpp"
#include "error_text.hpp"
#include "scene/scene_reader.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <dolp/errors.hpp>
#include <random>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "fit/contours.hpp"
#include "fit/descent.hpp"
#include "fit/residuals.hpp"

namespace {

using namespace dolp;
using namespace dolp::fit;

const std::string kScene = R"([surface]
n = 1.6
k = 0.5
sigma = 0.2
q = 3
masking = "smith"
[emission]
temperature_K = 300
[surroundings]
temperature_K = 200
[spectrum]
wavelength_um = 10
)";

constexpr double kNoise = 0.002;
constexpr double kQuantile68 = 22.436339987;  // quantile of chi^2 with 20 degrees of freedom
constexpr double kQuantile95 = 31.410432844;

FitRange number(const std::string& key, double low, double high) { return {key, low, high, {}}; }

/// Q/I of the scene at zeniths up to 80 degrees, exact except for `noise` times random deviates of a seed.
class FitTest : public testing::Test {
 protected:
  MeasuredData measured(double noise, const std::vector<std::string>& overrides = {}, bool has_uncertainties = true,
                        int points = 20, std::uint64_t seed = 7) {
    MeasuredData data;
    data.name = "synthetic";
    data.zenith_column = "theta_deg";
    data.has_uncertainties = has_uncertainties;
    for (int i = 0; i < points; ++i) {
      data.measurements.push_back({.observable = Observable::kQOverI, .theta_deg = 80.0 * (i + 1) / points});
      if (has_uncertainties) data.measurements.back().uncertainty = kNoise;
    }
    const Model model(parse_scene(kScene, "scene", settings_from_text(overrides)), {data},
                      {number("surface.n", 1.6, 2.0)});
    const Eigen::VectorXd truth = Eigen::VectorXd::Constant(1, 1.6);
    const Prediction exact = model.predict({truth}, 1e-8, evaluator_, {}).front();
    std::mt19937_64 engine(seed);
    for (std::size_t i = 0; i < data.measurements.size(); ++i) {
      double deviate = -6.0;  // the sum of twelve uniform numbers is close enough to normal
      for (int j = 0; j < 12; ++j) deviate += static_cast<double>(engine() >> 11U) * 0x1p-53;
      data.measurements[i].value = exact.components(static_cast<Eigen::Index>(i), 0) + noise * deviate;
    }
    return data;
  }
  FitResult fitted(const MeasuredData& data, const std::vector<FitRange>& parameters, const FitOptions& options = {},
                   const std::vector<std::string>& overrides = {}) {
    const Model model(parse_scene(kScene, "scene", settings_from_text(overrides)), {data}, parameters);
    const std::optional<FitResult> result = fit::fit(model, evaluator_, options);
    EXPECT_TRUE(result.has_value());
    return result.value_or(FitResult{});
  }

  CpuEvaluator evaluator_;
};

// If a step takes parameters out of the bounds, they go half the way, and the other parameters are solved again for
// least squares. A tiny scale damps no step.
TEST(PredictStep, ParametersLeaveTheBounds_OthersAreSolvedAgain) {
  constexpr double kScale = 1e-14;
  constexpr double kRounding = 1e-6;  // rounding of normal equations whose columns agree to a tenth
  std::mt19937_64 engine(5);
  const auto uniform = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  int checked = 0;
  for (int i = 0; i < 500; ++i) {
    Minimum near;
    near.where.at = Eigen::Vector3d(uniform(), uniform(), uniform());
    const Eigen::VectorXd common = Eigen::VectorXd::NullaryExpr(12, [&] { return uniform(); });
    near.where.jacobian = Eigen::MatrixXd::NullaryExpr(12, 3, [&] { return 0.1 * uniform(); }).colwise() + common;
    near.where.residuals = Eigen::VectorXd::NullaryExpr(12, [&] { return 0.1 * (uniform() - 0.5); });
    Eigen::VectorXd step = predict_step({&near, {}, near.where.at}, kScale).first - near.where.at;
    std::vector<Eigen::Index> inside;
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double end = near.where.at[j] + 2.0 * step[j];
      if (std::abs(end) < 1e-9 || std::abs(end - 1.0) < 1e-9) {
        step[j] *= 2.0;
      } else {
        inside.push_back(j);
      }
    }
    if (inside.empty() || inside.size() == 3) continue;
    ++checked;
    const Eigen::VectorXd gradient =
        near.where.jacobian.transpose() * (near.where.residuals + near.where.jacobian * step);
    for (const Eigen::Index j : inside) EXPECT_NEAR(gradient[j], 0.0, kRounding) << i << " parameter " << j;
  }
  EXPECT_GT(checked, 100);
}

bool contains(const FitInterval& one, double value) {
  return !one.is_empty && (!one.low || *one.low <= value) && (!one.high || value <= *one.high);
}

// Data between both ends, at some points nearer to the other one. The residual is the distance from the nearer end, for
// Q/I and for DOLP, and 0 inside.
TEST_F(FitTest, ModelErrorOfTheBracket_ResidualIsTheDistanceFromTheInterval) {
  const SceneValues scene = parse_scene(kScene, "scene");
  const std::vector<FitRange> n = {number("surface.n", 1.1, 4.0)};
  const Eigen::VectorXd truth = Eigen::VectorXd::Constant(1, 1.6);
  MeasuredData data = measured(0.0);
  const MeasuredData direct = measured(0.0, {"emission.model=direct"});
  constexpr double kOutside = 3.0;  // uncertainties
  for (const Observable observable : {Observable::kQOverI, Observable::kDolp}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < data.measurements.size(); ++i) {
      const double one = measured(0.0).measurements[i].value, other = direct.measurements[i].value;
      const double beyond = i % 3 == 0 || std::max(one, other) > -kOutside * kNoise ? 0.0 : kOutside * kNoise;
      double value = i % 3 == 1 ? std::max(one, other) + beyond : std::min(one, other) - beyond;
      if (beyond == 0.0) value = std::lerp(one, other, 0.4);
      sum += beyond * beyond;
      data.measurements[i].observable = observable;
      data.measurements[i].value = observable == Observable::kDolp ? -value : value;
    }
    const Model model(scene, {data}, n, ModelError::kBracket);
    Residuals residuals(model, 1e-8, Differences::kCentral, evaluator_, {});
    const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, n[0].coordinate(truth[0]));
    const double expected = sum / (kNoise * kNoise);
    EXPECT_GT(expected, 50.0);
    EXPECT_NEAR(objective(residuals.at({at}).front().residuals, Loss::kSquares), expected, 1e-3 * expected);
  }
}

// An end of n lies where chi^2, minimised over sigma, is the quantile for 20 degrees of freedom.
TEST_F(FitTest, ModelErrorOfTheBracket_IntervalsEndAtTheQuantileOfChiSquared) {
  const SceneValues scene = parse_scene(kScene, "scene");
  const FitRange sigma = number("surface.sigma", 0.05, 0.5);
  const MeasuredData data = measured(kNoise, {"emission.model=direct"});
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), sigma};
  EXPECT_FALSE(contains(fitted(data, parameters).parameters[0].interval_95, 1.6));
  const FitResult result = fit::fit(Model(scene, {data}, parameters, ModelError::kBracket), evaluator_, {}).value();
  ASSERT_EQ(result.parameters.size(), 2U);
  EXPECT_EQ(result.degrees_of_freedom, 20U);
  EXPECT_EQ(result.parameters[0].why_no_error, "with a model error the value is one of many that fit as well");
  EXPECT_TRUE(contains(result.parameters[0].interval_95, 1.6));
  EXPECT_TRUE(contains(result.parameters[1].interval_95, 0.2));
  int ends = 0;
  for (const auto& [interval, quantile] :
       {std::pair(result.parameters[0].interval_68, kQuantile68), {result.parameters[0].interval_95, kQuantile95}}) {
    for (const std::optional<double>& end : {interval.low, interval.high}) {
      if (!end) continue;
      const SceneValues held = parse_scene(kScene, "scene", settings_from_text({"surface.n=" + std::to_string(*end)}));
      const FitResult least = fit::fit(Model(held, {data}, {sigma}, ModelError::kBracket), evaluator_, {}).value();
      EXPECT_NEAR(least.chi_square, quantile, 0.015 * quantile) << *end;
      ++ends;
    }
  }
  EXPECT_GE(ends, 2);

  EXPECT_THROW(Model(scene, {measured(kNoise, {}, false)}, parameters, ModelError::kBracket), InputError);
  EXPECT_THROW(Model(parse_scene(kScene, "scene", settings_from_text({"surface.masking=integral"})), {data}, parameters,
                     ModelError::kBracket),
               InputError);
}

// Data far from both ends exclude all values; with larger uncertainties some values remain.
TEST_F(FitTest, ModelErrorOfTheBracket_ThatExplainsNothing_LeavesEmptyIntervals) {
  MeasuredData data = measured(0.0);
  for (std::size_t i = 0; i < 20; i += 2) data.measurements[i].value += 20.0 * kNoise;
  const Model model(parse_scene(kScene, "scene"), {data}, {number("surface.n", 1.1, 4.0)}, ModelError::kBracket);
  const FitParameter n = fit::fit(model, evaluator_, {}).value().parameters.front();
  EXPECT_TRUE(n.interval_68.is_empty && n.interval_95.is_empty);
  ASSERT_TRUE(n.scaled_68 && n.scaled_95);
  EXPECT_TRUE(contains(*n.scaled_68, n.value) && contains(*n.scaled_95, n.value));
}

TEST(FitQuality, IsAWordForTheP_Value) {
  for (const auto& [p, word] : {std::pair<std::optional<double>, const char*>(1.0, "good"),
                                {0.05, "good"},
                                {0.049, "doubtful"},
                                {0.001, "doubtful"},
                                {0.00099, "bad"},
                                {0.0, "bad"},
                                {std::nullopt, ""}}) {
    EXPECT_EQ(fit_quality(p), word) << p.value_or(-1.0);
  }
}

// The scaled intervals equal the plain intervals for data with uncertainties multiplied by sqrt(reduced chi^2).
TEST_F(FitTest, DoubtfulFit_ScaledIntervalsAreThoseOfLargerUncertainties) {
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0)};
  MeasuredData data = measured(kNoise, {"surface.sigma=0.26"});
  const FitResult result = fitted(data, parameters);
  ASSERT_NE(fit_quality(result.p_value), "good") << *result.p_value;
  for (Measurement& one : data.measurements) *one.uncertainty *= std::sqrt(*result.reduced_chi_square);
  const FitResult wider = fitted(data, parameters);
  EXPECT_EQ(fit_quality(wider.p_value), "good");
  constexpr double kRoot = 0.02;  // share of a half-width: both ends are found to 0.5 % of the root of the growth
  for (std::size_t j = 0; j < 2; ++j) {
    const FitParameter &one = result.parameters[j], &other = wider.parameters[j];
    ASSERT_TRUE(one.scaled_68 && one.scaled_95 && !other.scaled_68 && !other.scaled_95);
    for (const auto& [scaled, plain] :
         {std::pair(*one.scaled_68, other.interval_68), {*one.scaled_95, other.interval_95}}) {
      EXPECT_NEAR(*scaled.low, *plain.low, kRoot * (one.value - *plain.low));
      EXPECT_NEAR(*scaled.high, *plain.high, kRoot * (*plain.high - one.value));
    }
    EXPECT_LT(*one.scaled_68->low, *one.interval_68.low);
  }
}

TEST_F(FitTest, ExactData_GiveTheTruth) {
  const FitResult result = fitted(measured(0.0), {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0),
                                                  number("surface.sigma", 0.02, 1.0)});
  const double truth[] = {1.6, 0.5, 0.2};
  for (std::size_t j = 0; j < 3; ++j) {
    // Without noise the minimum is at the truth. The remaining difference is the model's numerical error, far below an
    // uncertainty.
    EXPECT_NEAR(result.parameters[j].value, truth[j], 0.02 * *result.parameters[j].standard_error);
    EXPECT_FALSE(result.parameters[j].is_at_bound);
  }
  EXPECT_LT(result.chi_square, 1e-3);
  EXPECT_LT(result.numerical_error, 0.01);
  EXPECT_EQ(result.degrees_of_freedom, 17U);
  EXPECT_TRUE(result.degeneracies.empty());
}

TEST_F(FitTest, LinearParameter_IntervalsAreThoseOfTheCovariance) {
  // rho is linear in k_s. With the emission of a body at the same temperature, Q/I is nearly linear, too.
  const FitResult result =
      fitted(measured(kNoise), {number("surface.specular", 0.2, 1.0)}, {}, {"surface.specular=0.6"});
  const FitParameter& one = result.parameters.front();
  ASSERT_TRUE(one.interval_68.low && one.interval_95.low && one.interval_68.high && one.interval_95.high);
  const double error = *one.standard_error;
  constexpr double kCurvature = 0.05;  // relative curvature of Q/I in k_s over the interval
  EXPECT_NEAR(one.value - *one.interval_68.low, error, kCurvature * error);
  EXPECT_NEAR(*one.interval_68.high - one.value, error, kCurvature * error);
  EXPECT_NEAR(one.value - *one.interval_95.low, 1.96 * error, 2.0 * kCurvature * error);
  EXPECT_NEAR(*one.interval_95.high - one.value, 1.96 * error, 2.0 * kCurvature * error);
}

TEST_F(FitTest, IntervalEnds_LieWhereTheBestOfTheOthersHasGrownSo) {
  const MeasuredData data = measured(kNoise);
  const FitRange sigma = number("surface.sigma", 0.02, 1.0);
  const FitResult result = fitted(data, {number("surface.n", 1.1, 4.0), sigma});
  for (const bool is_95 : {false, true}) {
    const FitInterval& interval = is_95 ? result.parameters[1].interval_95 : result.parameters[1].interval_68;
    for (const std::optional<double>& end : {interval.low, interval.high}) {
      ASSERT_TRUE(end.has_value());
      const FitResult held =
          fitted(data, {number("surface.n", 1.1, 4.0)}, {}, {"surface.sigma=" + std::to_string(*end)});
      // The profile's root is found to 0.5 %, so its square to 1 %; to_string keeps six digits.
      EXPECT_NEAR(held.chi_square - result.chi_square, is_95 ? 3.841 : 1.0, 0.015 * (is_95 ? 3.841 : 1.0));
    }
  }
}

/// The smallest growth over the third parameter at given coordinates of two others, by brute force: scans its range,
/// and the neighbourhood of the previous minimum.
std::vector<double> brute_growth(Residuals& residuals, const FitResult& result, const std::array<std::size_t, 2>& pair,
                                 const std::vector<Eigen::Vector2d>& places) {
  constexpr int kSteps = 40;
  std::vector<double> least(places.size(), std::numeric_limits<double>::infinity());
  std::vector<double> middles(places.size(), 0.5);
  for (double width = 0.5; width > 1e-4; width *= 2.0 / kSteps) {
    std::vector<Eigen::VectorXd> points;
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (int i = -kSteps / 2; i <= kSteps / 2; ++i) {
        Eigen::VectorXd& point = points.emplace_back(3);
        point.setConstant(std::clamp(middles[k] + 2.0 * width * i / kSteps, 0.0, 1.0));
        for (std::size_t j = 0; j < 2; ++j)
          point[static_cast<Eigen::Index>(pair[j])] = places[k][static_cast<Eigen::Index>(j)];
      }
    }
    const std::vector<Linearisation> found = residuals.at(points);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t k = i / (kSteps + 1);
      const double growth = objective(found[i].residuals, Loss::kSquares) - result.chi_square;
      if (growth >= least[k]) continue;
      least[k] = growth;
      middles[k] = points[i][static_cast<Eigen::Index>(3 - pair[0] - pair[1])];
    }
  }
  return least;
}

class FitContours : public FitTest {
 protected:
  /// Compares contours of n, k and sigma from a few points with brute force. `off` is the largest allowed error of the
  /// root of the growth.
  void expect_true(int points, std::uint64_t seed, double off) {
    const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0),
                                              number("surface.sigma", 0.02, 1.0)};
    const Model model(parse_scene(kScene, "scene"), {measured(kNoise, {}, true, points, seed)}, parameters);
    const FitResult result = fit::fit(model, evaluator_, {}).value();
    const Contours contours = contours_of(model, evaluator_, result, {}).value();
    EXPECT_LE(contours.evaluations, 2 * result.evaluations);
    const auto& pair = contours.parameters;
    Residuals residuals(model, result.tolerance, Differences::kForward, evaluator_, {});
    Eigen::AlignedBox2d box;
    std::vector<Eigen::Vector2d> places;
    std::vector<double> roots;
    for (Eigen::Index i = 0; i < contours.growth.size(); ++i) {
      const double growth = contours.growth.reshaped()[i];
      if (std::isnan(growth)) continue;
      const Eigen::Vector2d place(parameters[pair[0]].coordinate(contours.values[0].reshaped()[i]),
                                  parameters[pair[1]].coordinate(contours.values[1].reshaped()[i]));
      box.extend(place);
      if (growth > kContourLevels[1] || i % 2 != 0) continue;
      places.push_back(place);
      roots.push_back(std::sqrt(growth));
    }
    ASSERT_GE(places.size(), 40U);
    const std::vector<double> right = brute_growth(residuals, result, pair, places);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(roots[i], std::sqrt(std::max(0.0, right[i])), off) << places[i].transpose();
    // Outside the contours nothing may lie well below the higher level.
    places.clear();
    for (int i = 0; i < 225; ++i) places.emplace_back(i % 15 / 14.0, i / 15 / 14.0);
    const std::vector<double> growths = brute_growth(residuals, result, pair, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_at_bound = places[i].minCoeff() <= 0.0 || places[i].maxCoeff() >= 1.0;
      EXPECT_TRUE(growths[i] > 0.9 * kContourLevels[1] || is_at_bound || box.contains(places[i]))
          << places[i].transpose();
    }
  }
};

// Residuals bend between nodes, and descents stop before the bottom of the valley.
TEST_F(FitContours, EightPoints_AreWhereTheLeastOfTheThirdParameterSays) { expect_true(8, 7, 0.1); }

// The data cannot distinguish n, k and sigma. The valley bends, and the affordable grid is coarse.
TEST_F(FitContours, FourPoints_AreWhereTheLeastOfTheThirdParameterSays) { expect_true(4, 7, 0.4); }

TEST_F(FitTest, NoUncertainties_TheResidualsGiveTheScale) {
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)};
  const FitResult with = fitted(measured(kNoise), parameters);
  const FitResult without = fitted(measured(kNoise, {}, false), parameters);
  EXPECT_FALSE(without.p_value.has_value());
  EXPECT_NEAR(without.chi_square, with.chi_square * kNoise * kNoise, 1e-3 * without.chi_square);
  EXPECT_NEAR(without.scale, without.chi_square / 18.0, 1e-9 * without.scale);
  const double ratio = std::sqrt(*with.reduced_chi_square);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_NEAR(without.parameters[j].value, with.parameters[j].value, 0.01 * *with.parameters[j].standard_error);
    EXPECT_NEAR(*without.parameters[j].standard_error, ratio * *with.parameters[j].standard_error,
                0.02 * *with.parameters[j].standard_error);
  }
}

// At each k below the minimum there are two minima of n: one at its bound and a lower one inside. Without the other
// branch, most of k's interval would be missing.
TEST_F(FitTest, MinimumAtABound_IntervalHasTheOtherBranch) {
  MeasuredData data;
  data.name = "paint";
  data.zenith_column = "theta_deg";
  data.has_uncertainties = true;
  const std::vector<double> dolp = {0.000321, 0.000975, 0.002693, 0.004349, 0.006603,
                                    0.010358, 0.014966, 0.019867, 0.025187};
  for (std::size_t i = 0; i < dolp.size(); ++i) {
    data.measurements.push_back({.observable = Observable::kDolp, .theta_deg = 5.0 * static_cast<double>(i + 1)});
    data.measurements.back().value = dolp[i];
    data.measurements.back().uncertainty = 5e-4;
  }
  const FitResult result =
      fitted(data, {number("surface.n", 1.1, 3.0), number("surface.k", 0.0, 2.0)}, {},
             {"surface.sigma=0.15", "surface.specular=0.97", "surface.diffuse=0.03", "surface.diffuse_exponent=-0.3",
              "emission.temperature_K=290", "surroundings.temperature_K=240", "spectrum.band_um=[8,14]"});
  ASSERT_EQ(result.parameters[0].value, 1.1);
  ASSERT_TRUE(result.parameters[1].interval_68.low.has_value());
  EXPECT_NEAR(*result.parameters[1].interval_68.low, 0.195, 0.01);
  EXPECT_NEAR(*result.parameters[1].interval_68.high, 0.396, 0.002);
}

TEST_F(FitTest, ParameterWithoutInfluence_IsNamedAndOpen) {
  const FitResult result =
      fitted(measured(kNoise, {"surface.distribution=gaussian"}),
             {number("surface.n", 1.1, 4.0), number("surface.q", 1.6, 5.0)}, {}, {"surface.distribution=gaussian"});
  ASSERT_EQ(result.degeneracies.size(), 1U);
  EXPECT_EQ(result.degeneracies.front(), "the data do not determine surface.q at all");
  EXPECT_FALSE(result.parameters[1].standard_error.has_value());
  EXPECT_FALSE(result.parameters[1].interval_68.low || result.parameters[1].interval_68.high);
  EXPECT_TRUE(result.parameters[0].interval_95.low && result.parameters[0].interval_95.high);
  EXPECT_EQ(result.determined, 1U);
}

TEST_F(FitTest, FactorsOfOneProduct_AreNamedAsAPair) {
  // Only a source: I and Q are both proportional to k_s times its irradiance, and Q/I depends on neither.
  const std::vector<std::string> source_alone = {"emission=none", "surroundings=none", "source.irradiance=1"};
  const MeasuredData data = measured(kNoise, source_alone);
  const FitResult result = fitted(
      data, {number("surface.n", 1.1, 4.0), number("surface.specular", 0.2, 0.9), number("source.scale", 0.5, 2.0)}, {},
      source_alone);
  ASSERT_EQ(result.degeneracies.size(), 2U);
  EXPECT_NE((result.degeneracies[0] + result.degeneracies[1]).find("surface.specular"), std::string::npos);
  EXPECT_NE((result.degeneracies[0] + result.degeneracies[1]).find("source.scale"), std::string::npos);
  EXPECT_TRUE(result.parameters[0].interval_95.low.has_value());
}

TEST_F(FitTest, TruthBeyondTheRange_IsAtItsBound) {
  const FitResult result = fitted(measured(kNoise), {number("surface.n", 1.1, 1.5)});
  EXPECT_TRUE(result.parameters.front().is_at_bound);
  EXPECT_EQ(result.parameters.front().value, 1.5);
  EXPECT_FALSE(result.parameters.front().standard_error.has_value());
  EXPECT_EQ(result.parameters.front().why_no_error, "it is at its bound");
  EXPECT_FALSE(result.parameters.front().interval_95.high.has_value());
}

TEST_F(FitTest, StandardErrors_ThatReachBeyondTheRange_AreNone) {
  const auto error_in = [&](double high) {
    return fitted(measured(10.0 * kNoise), {number("surface.k", 0.0, high)}).parameters.front();
  };
  const FitParameter wide = error_in(5.0);
  ASSERT_TRUE(wide.standard_error.has_value()) << wide.why_no_error;
  EXPECT_TRUE(wide.why_no_error.empty());
  const FitParameter narrow = error_in(wide.value + 0.5 * *wide.standard_error);
  EXPECT_NEAR(narrow.value, wide.value, 0.1 * *wide.standard_error);
  EXPECT_FALSE(narrow.standard_error.has_value());
  EXPECT_NE(narrow.why_no_error.find("would reach beyond its range 0:"), std::string::npos) << narrow.why_no_error;
}

TEST_F(FitTest, Outlier_MovesSquaresMoreThanARobustLoss) {
  MeasuredData data = measured(0.0);
  data.measurements[15].value += 50.0 * kNoise;
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0)};
  const double squares = std::abs(fitted(data, parameters).parameters.front().value - 1.6);
  for (const Loss loss : {Loss::kHuber, Loss::kSoftL1, Loss::kCauchy, Loss::kTukey}) {
    FitOptions options;
    options.loss = loss;
    const FitResult result = fitted(data, parameters, options);
    EXPECT_LT(std::abs(result.parameters.front().value - 1.6), 0.3 * squares);
    EXPECT_FALSE(result.p_value.has_value());
  }
}

TEST_F(FitTest, TwoDataSets_ShareParametersAndKeepKeysOfTheirOwn) {
  MeasuredData warm = measured(0.0);
  MeasuredData cold = measured(0.0, {"emission.temperature_K=250"});
  cold.settings = {{"emission.temperature_K", 250.0}};
  const Model model(parse_scene(kScene, "scene"), {warm, cold}, {number("surface.n", 1.1, 4.0)});
  const std::optional<FitResult> result = fit::fit(model, evaluator_, {});
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(result->parameters.front().value, 1.6, 1e-4);
  EXPECT_LT(result->chi_square, 1e-3);
  EXPECT_EQ(result->residuals.size(), 40);
}

TEST_F(FitTest, Intervals_HoldTheTruthAsOftenAsTheySay) {
  constexpr int kDraws = 40;
  constexpr double kSpread = 3.0;  // standard deviations of the binomial distribution
  const std::vector<FitRange> parameters = {number("surface.n", 1.3, 2.0), number("surface.sigma", 0.1, 0.4)};
  const double truth[] = {1.6, 0.2};
  for (const bool has_uncertainties : {true, false}) {
    int held_68 = 0, held_95 = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      FitOptions options;
      options.starts = 1;
      const FitResult result =
          fitted(measured(kNoise, {}, has_uncertainties, 5, static_cast<std::uint64_t>(draw)), parameters, options);
      // one parameter per draw, because the parameters of a draw are correlated
      const std::size_t j = static_cast<std::size_t>(draw) % 2;
      const auto holds = [&](const FitInterval& interval) {
        return interval.low.value_or(0.0) <= truth[j] && truth[j] <= interval.high.value_or(10.0);
      };
      held_68 += holds(result.parameters[j].interval_68) ? 1 : 0;
      held_95 += holds(result.parameters[j].interval_95) ? 1 : 0;
    }
    const auto expect_share = [&](int held, double share) {
      EXPECT_NEAR(held, kDraws * share, kSpread * std::sqrt(kDraws * share * (1.0 - share))) << has_uncertainties;
    };
    expect_share(held_68, 0.6827);
    expect_share(held_95, 0.95);
  }
}

TEST_F(FitTest, SameSeed_GivesTheSameDigits) {
  const MeasuredData data = measured(kNoise);
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)};
  const FitResult one = fitted(data, parameters);
  const FitResult two = fitted(data, parameters);
  EXPECT_EQ(one.parameters[0].value, two.parameters[0].value);
  EXPECT_EQ(one.parameters[1].interval_95.high, two.parameters[1].interval_95.high);
  FitOptions other;
  other.seed = 2;
  EXPECT_NEAR(fitted(data, parameters, other).parameters[0].value, one.parameters[0].value,
              0.01 * *one.parameters[0].standard_error);
}

TEST_F(FitTest, Jacobian_IsThatOfFinerDifferences) {
  const Model model(parse_scene(kScene, "scene"), {measured(kNoise)},
                    {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)});
  Residuals residuals(model, 2e-5, Differences::kCentral, evaluator_, {});
  Residuals exact(model, 1e-10, Differences::kCentral, evaluator_, {});
  const Eigen::VectorXd point = Eigen::Vector2d(0.3, 0.6);
  Linearisation found = residuals.at({point}).front();
  for (int i = 0; i < 2; ++i) residuals.linearise({&found});  // the first call determines its steps
  constexpr double kStep = 1e-4;
  for (Eigen::Index j = 0; j < 2; ++j) {
    Eigen::VectorXd below = point, above = point;
    below[j] -= kStep;
    above[j] += kStep;
    const std::vector<Linearisation> beside = exact.at({below, above});
    const Eigen::VectorXd slope = (beside[1].residuals - beside[0].residuals) / (2.0 * kStep);
    EXPECT_LT((found.jacobian.col(j) - slope).norm(), 2e-3 * slope.norm());
  }
}

TEST(MeasuredData, Columns_AreReadAndCheckedLineByLine) {
  const MeasuredData data =
      MeasuredData::from_csv("# a comment\ntheta_deg,dolp,uncertainty,wavelength_um\n30,0.1,0.01,10\n", "f.csv");
  ASSERT_EQ(data.measurements.size(), 1U);
  EXPECT_EQ(data.measurements.front().observable, Observable::kDolp);
  EXPECT_EQ(data.measurements.front().wavelength_um, 10.0);
  EXPECT_TRUE(data.has_uncertainties);
  EXPECT_EQ(MeasuredData::from_csv("theta_deg,emissivity_s,emissivity_p\n1,0.8,0.9\n", "f").measurements.size(), 2U);
  const auto message = [](const std::string& text) -> std::string {
    return error_text([&] { MeasuredData::from_csv(text, "f.csv"); });
  };
  EXPECT_TRUE(message("").starts_with("f.csv:1: the file is empty"));
  EXPECT_TRUE(message("theta_deg,dolp\n").starts_with("f.csv:1: no points"));
  EXPECT_TRUE(message("theta_deg,dolp,q_over_i\n1,0,0\n").starts_with("f.csv:1: several measured quantities"));
  EXPECT_TRUE(message("dolp\n1\n").starts_with("f.csv:1: column \"theta_deg\" is missing"));
  EXPECT_TRUE(message("theta_deg,dolp\n1,12\n").starts_with("f.csv:2: dolp = 12: out of range"));
  EXPECT_EQ(message("theta_deg,dolp\n1,-0.1\n"),
            "f.csv:2: dolp = -0.1: must not be negative; a signed Q/I goes in a column q_over_i");
  EXPECT_TRUE(message("theta_deg,dolp,std\n").starts_with("f.csv:1: column \"std\" is unknown; allowed are theta_deg"));
  EXPECT_TRUE(
      message("theta_deg,unc\n").starts_with("f.csv:1: column \"unc\" is unknown; the nearest known is uncert"));
  EXPECT_TRUE(message("theta_deg,dolp,uncertainty\n1,0.1,0\n").starts_with("f.csv:2: uncertainty = 0: out of range"));
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
