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

// chi^2 of these data has several minima of nearly equal height. The expected ends are roots of chi^2 at the tolerance
// 1e-7, from a dense scan over the parameter. With two parameters, chi^2 is minimised over a dense scan of n.
using Pieces = std::vector<std::pair<std::optional<double>, std::optional<double>>>;

struct SeveralMinima {
  std::string scene;  ///< a sample scene
  std::vector<std::string> settings;
  std::string csv;
  std::vector<FitRange> parameters;
  Pieces pieces_68, pieces_95;  ///< for the last of the parameters
};

constexpr std::optional<double> kOpen = std::nullopt;
const std::vector<std::string> kLaser = {"spectrum.wavelength_um=10.6"};

class FitOfSeveralMinima : public FitTest, public testing::WithParamInterface<SeveralMinima> {};

TEST_P(FitOfSeveralMinima, Pieces_AreAllValuesThatTheDataDoNotExclude) {
  constexpr double kEnd = 0.01;  // relative. By the tolerance of the growth, 1 %, these ends move by up to 0.6 %.
  const SeveralMinima& given = GetParam();
  const SceneValues scene =
      read_scene(DOLP_HOST_DIR "/scenes/" + given.scene + ".toml", settings_from_text(given.settings));
  const Model model(scene, {MeasuredData::from_csv(given.csv)}, given.parameters);
  const FitParameter found = fit::fit(model, evaluator_, {}).value().parameters.back();
  for (const auto& [pieces, expected] :
       {std::pair(found.interval_68.pieces, given.pieces_68), {found.interval_95.pieces, given.pieces_95}}) {
    ASSERT_EQ(pieces.size(), expected.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      ASSERT_EQ(pieces[i].first.has_value(), expected[i].first.has_value());
      ASSERT_EQ(pieces[i].second.has_value(), expected[i].second.has_value());
      EXPECT_NEAR(pieces[i].first.value_or(0.0), expected[i].first.value_or(0.0),
                  kEnd * expected[i].first.value_or(1.0));
      EXPECT_NEAR(pieces[i].second.value_or(0.0), expected[i].second.value_or(0.0),
                  kEnd * expected[i].second.value_or(1.0));
    }
  }
}

const std::string kPaint3 = R"(theta_deg,q_over_i,uncertainty
20,-0.001949,0.003
30,-0.012044,0.003
40,-0.017838,0.003
)";

INSTANTIATE_TEST_SUITE_P(
    , FitOfSeveralMinima,
    testing::Values(
        // At small k, chi^2 is flat. The other minimum fits equally well.
        SeveralMinima{"night_paint",
                      kLaser,
                      kPaint3,
                      {number("surface.k", 0.001, 100.0)},
                      {{kOpen, 0.1922}, {9.876, 11.66}},
                      {{kOpen, 0.2880}, {9.222, 12.84}}},
        // The range ends before the other minimum.
        SeveralMinima{
            "night_paint", kLaser, kPaint3, {number("surface.k", 0.001, 1.0)}, {{kOpen, 0.1958}}, {{kOpen, 0.2894}}},
        SeveralMinima{"rough_metal",
                      kLaser,
                      R"(theta_deg,q_over_i
2.77,0.016954515
4.83,0.059852866
5.75,-0.006420428
26.54,-0.026266683
26.67,-0.049755235
38.68,-0.016436190
40.24,0.026240254
61.18,-0.020239966
65.37,-0.087221106
)",
                      {number("surface.n", 1.0, 30.0)},
                      {{1.4957, 2.784}, {11.92, kOpen}},
                      {{kOpen, kOpen}}},
        // The end of the range is a minimum. On the way to the best one chi^2 rises by less than 1.
        SeveralMinima{"bare_aluminium",
                      {},
                      R"(theta_deg,dolp,uncertainty
10.66,0.003428,0.0112
16.84,0.0023377,0.0112
40.86,0.0115897,0.0112
42.09,0.0062476,0.0112
45.58,0.0046638,0.0112
)",
                      {number("surroundings.temperature_K", 0.0, 400.0)},
                      {{222.26, 287.15}, {317.6, kOpen}},
                      {{210.67, kOpen}}},
        SeveralMinima{"stainless_steel",
                      kLaser,
                      R"(theta_deg,dolp,uncertainty
5.64,0.0148394642,0.01124
20.11,0.0013145279,0.01124
39.53,0.0244393367,0.01124
51.0,0.0234405906,0.01124
60.16,0.0224949413,0.01124
64.68,0.0218818485,0.01124
64.69,0.0090896702,0.01124
70.46,0.0016121967,0.01124
74.87,0.0225853276,0.01124
)",
                      {number("source.relative_irradiance", 0.0, 10.0)},
                      {{2.8936, 3.7400}, {3.9794, 4.5856}},
                      {{2.5395, 5.3638}}},
        SeveralMinima{"rough_metal",
                      kLaser,
                      R"(theta_deg,dolp,uncertainty
15.32,0.0073471,0.00986
16.71,0.010034,0.00986
33.97,0.0088976,0.00986
52.1,0.019762,0.00986
)",
                      {number("surface.n", 0.1, 100.0)},
                      {{0.647, 0.7857}, {1.359, 1.839}, {27.26, 83.54}},
                      {{0.2615, 0.9056}, {1.146, 2.156}, {18.57, kOpen}}},
        // The profile of k has two branches, and a descent that begins far from the best minimum finds the higher one.
        SeveralMinima{"night_paint",
                      kLaser,
                      R"(theta_deg,q_over_i,uncertainty
30,-0.002453,0.01
35,-0.013103,0.01
40,-0.016948,0.01
45,-0.033612,0.01
50,-0.02649,0.01
55,-0.023944,0.01
60,-0.05465,0.01
65,-0.068019,0.01
70,-0.074193,0.01
75,-0.086747,0.01
80,-0.096204,0.01
)",
                      {number("surface.n", 0.5, 50.0), number("surface.k", 0.001, 100.0)},
                      {{kOpen, 0.2865}, {8.1405, 39.88}},
                      {{kOpen, 0.4386}, {5.866, 42.96}}},
        SeveralMinima{"night_paint",
                      kLaser,
                      "theta_deg,dolp,uncertainty\n30,0.008143,0.003\n50,0.034867,0.003\n70,0.078491,0.003\n",
                      {number("surface.n", 0.5, 50.0), number("surface.k", 0.001, 100.0)},
                      {{kOpen, 0.350}, {10.08, 34.55}},
                      {{kOpen, 0.4535}, {6.10, 36.13}}},
        // The gap of the 95 % interval of sigma has a branch that no descent from the ends of the interval finds.
        SeveralMinima{"night_paint",
                      kLaser,
                      R"(theta_deg,q_over_i,uncertainty
30,-0.00901,0.003
50,-0.036334,0.003
70,-0.076431,0.003
)",
                      {number("surface.n", 1.1, 10.0), number("surface.sigma", 0.01, 1.0)},
                      {{0.1063, 0.2048}, {0.527, 0.5636}},
                      {{0.0430, 0.2980}, {0.4350, 0.5807}}}));

// chi^2 is an even function of k, so its derivative vanishes at small k although the data limit k.
TEST_F(FitTest, ParameterWithoutInfluenceNearItsBestValue_IsNotCalledUndeterminedAtAll) {
  const MeasuredData data = measured(0.0, {"surface.k=1e-5"});
  const FitResult result = fitted(data, {number("surface.k", 1e-7, 1.0)}, kFewStarts);
  EXPECT_TRUE(result.parameters.front().interval_95.high.has_value());
  ASSERT_EQ(result.degeneracies.size(), 1U);
  EXPECT_EQ(result.degeneracies.front(), "the data do not determine surface.k near its best value");
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
