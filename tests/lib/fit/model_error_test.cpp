// Fits with the model error "bracket". The bracket of a quantity is the range that is possible with all bounces of
// light. These fits assume that the true value lies anywhere in the bracket.
#include "fit_support.hpp"

namespace dolp::fit {
namespace {

constexpr double kQuantile68 = 22.436339987;  // 68.27 % and 95 % quantiles of chi^2 for 20 degrees of freedom
constexpr double kQuantile95 = 31.410432844;

// The residual of a value in the bracket is 0. The residual of a value outside is the distance from the nearer end of
// the bracket. The test has data of both kinds, first of Q/I and then of DOLP.
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

// At the ends of n's intervals, chi^2 minimised over sigma equals the quantile for 20 degrees of freedom.
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
}  // namespace dolp::fit
