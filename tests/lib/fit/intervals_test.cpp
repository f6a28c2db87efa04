// Intervals agree with closed forms, with brute force and with synthetic measurements.
#include "fit_support.hpp"

namespace dolp::fit::intervals_test {
namespace {

TEST_F(FitTest, LinearParameter_IntervalsAreThoseOfTheCovariance) {
  // rho is linear in k_s, and Q/I is nearly linear, because I changes little with k_s.
  const FitResult result =
      fitted(measured(kNoise), {number("surface.specular", 0.2, 1.0)}, kFewStarts, {"surface.specular=0.6"});
  const FitParameter& one = result.parameters.front();
  ASSERT_TRUE(one.interval_68.low && one.interval_95.low && one.interval_68.high && one.interval_95.high);
  const double error = *one.standard_error;
  constexpr double kCurvature = 0.05;  // relative deviation of Q/I from a linear function of k_s over the interval
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
          fitted(data, {number("surface.n", 1.1, 4.0)}, kFewStarts, {"surface.sigma=" + std::to_string(*end)});
      // The growth is chi^2 minus its minimum. The search for an end allows an error of 0.5 % of sqrt(growth), which is
      // 1 % of the growth. The tolerance is 1.5 %, because to_string writes only six decimals.
      EXPECT_NEAR(held.chi_square - result.chi_square, is_95 ? 3.841 : 1.0, 0.015 * (is_95 ? 3.841 : 1.0));
    }
  }
}

// Scaled intervals must equal the intervals of a fit whose uncertainties are multiplied by sqrt(reduced chi^2).
TEST_F(FitTest, DoubtfulFit_ScaledIntervalsAreThoseOfLargerUncertainties) {
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0)};
  MeasuredData data = measured(kNoise, {"surface.sigma=0.26"});
  const FitResult result = fitted(data, parameters);
  ASSERT_NE(fit_quality(result.p_value), "good") << *result.p_value;
  for (Measurement& one : data.measurements) *one.uncertainty *= std::sqrt(*result.reduced_chi_square);
  const FitResult wider = fitted(data, parameters);
  EXPECT_EQ(fit_quality(wider.p_value), "good");
  // Tolerance of an end, as a share of its distance from the best value. sqrt(chi^2 - minimum) is nearly proportional
  // to this distance. The search for an end allows an error of 0.5 % of the root, so two ends may differ by 1 %. The
  // tolerance is twice as large.
  constexpr double kRoot = 0.02;
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

// For each k below its best value, chi^2 has two minima in n: one at the bound of n, and a lower one inside the range.
// If intervals followed only the minimum at the bound, they would miss most of the interval of k.
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

TEST_F(FitTest, Intervals_HoldTheTruthAsOftenAsTheySay) {
  constexpr int kDraws = 40;
  constexpr double kSpread = 3.0;  // allowed deviation in standard deviations of the binomial distribution
  const std::vector<FitRange> parameters = {number("surface.n", 1.3, 2.0), number("surface.sigma", 0.1, 0.4)};
  const double truth[] = {1.6, 0.2};
  const std::vector<std::string> cheap = {"surface.masking=none"};
  for (const bool has_uncertainties : {true, false}) {
    int held_68 = 0, held_95 = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const MeasuredData data = measured(kNoise, cheap, has_uncertainties, 5, static_cast<std::uint64_t>(draw));
      const FitResult result = fitted(data, parameters, {.vary = {}, .starts = 1}, cheap);
      // Tests only one parameter per data set, because both parameters of a data set have correlated errors.
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

// ---- The model error "bracket" -------------------------------------------------------------------------------------
// The bracket of a quantity is the range that is possible with all bounces of light. These fits assume that the true
// value lies anywhere in the bracket.

constexpr double kQuantile68 = 22.436339987;  // 68.27 % and 95 % quantiles of chi^2 for 20 degrees of freedom
constexpr double kQuantile95 = 31.410432844;

// The residual of a value in the bracket is 0. The residual of a value outside is the distance from the nearer end of
// the bracket. The test has data of both kinds, first of Q/I and then of DOLP.
TEST_F(FitTest, ModelErrorOfTheBracket_ResidualIsTheDistanceFromTheInterval) {
  const SceneValues scene = parse_scene(kScene, "scene");
  const std::vector<FitRange> n = {number("surface.n", 1.1, 4.0)};
  const Eigen::VectorXd truth = Eigen::VectorXd::Constant(1, 1.6);
  MeasuredData data = measured(0.0);
  const MeasuredData single = data;
  const MeasuredData direct = measured(0.0, {"emission.model=direct"});
  constexpr double kOutside = 3.0;  // uncertainties
  for (const Observable observable : {Observable::kQOverI, Observable::kDolp}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < data.measurements.size(); ++i) {
      const double one = single.measurements[i].value, other = direct.measurements[i].value;
      const double beyond = i % 3 == 0 || std::max(one, other) > -kOutside * kNoise ? 0.0 : kOutside * kNoise;
      double value = i % 3 == 1 ? std::max(one, other) + beyond : std::min(one, other) - beyond;
      if (beyond == 0.0) value = std::lerp(one, other, 0.4);
      sum += beyond * beyond;
      data.measurements[i].observable = observable;
      data.measurements[i].value = observable == Observable::kDolp ? -value : value;
    }
    const Model model(scene, {data}, n, ModelError::kBracket);
    Residuals residuals(model, evaluator_, {1e-8, Differences::kCentral});
    const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, n[0].coordinate(truth[0]));
    const double expected = sum / (kNoise * kNoise);
    EXPECT_GT(expected, 50.0);
    EXPECT_NEAR(residuals.at({at}).front().objective, expected, 1e-3 * expected);
  }
}

// At the ends of n's intervals, chi^2 minimised over sigma equals the quantile for 20 degrees of freedom.
TEST_F(FitTest, ModelErrorOfTheBracket_IntervalsEndAtTheQuantileOfChiSquared) {
  const SceneValues scene = parse_scene(kScene, "scene");
  const FitRange sigma = number("surface.sigma", 0.05, 0.5);
  const MeasuredData data = measured(kNoise, {"emission.model=direct"});
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), sigma};
  const FitOptions once = {.vary = {}, .starts = 1};
  EXPECT_FALSE(contains(fitted(data, parameters, once).parameters[0].interval_95, 1.6));
  const FitResult result = fit::fit(Model(scene, {data}, parameters, ModelError::kBracket), evaluator_, once).value();
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
      const FitResult least = fit::fit(Model(held, {data}, {sigma}, ModelError::kBracket), evaluator_, once).value();
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

// Every second measured value is far outside the bracket. So no value of n agrees with the data, and the intervals of n
// are empty. The scaled intervals are not empty: they use uncertainties that are enlarged to the scatter of the data.
TEST_F(FitTest, ModelErrorOfTheBracket_ThatExplainsNothing_LeavesEmptyIntervals) {
  MeasuredData data = measured(0.0);
  for (std::size_t i = 0; i < 20; i += 2) data.measurements[i].value += 20.0 * kNoise;
  const Model model(parse_scene(kScene, "scene"), {data}, {number("surface.n", 1.1, 4.0)}, ModelError::kBracket);
  const FitParameter n = fit::fit(model, evaluator_, {}).value().parameters.front();
  EXPECT_TRUE(n.interval_68.is_empty && n.interval_95.is_empty);
  ASSERT_TRUE(n.scaled_68 && n.scaled_95);
  EXPECT_TRUE(contains(*n.scaled_68, n.value) && contains(*n.scaled_95, n.value));
}

}  // namespace
}  // namespace dolp::fit::intervals_test
