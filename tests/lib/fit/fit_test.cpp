// Tests that fits find the true values of synthetic data, and name the parameters that the data do not determine.
#include <map>

#include "fit_support.hpp"
#include "scene/scene_keys.hpp"

namespace dolp::fit::fit_test {
namespace {

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

TEST_F(FitTest, Jacobian_HasTheDerivativesOfTheModelByTheParameters) {
  const std::vector<FitRange> parameters = {number("surface.n", 1.2, 2.4), number("surface.sigma", 0.01, 1.0)};
  const MeasuredData data = measured(0.0);
  const FitResult result = fitted(data, parameters);
  const Model model(parse_scene(kScene, "scene"), {data}, parameters);
  constexpr double kStep = 1e-3;       // of the value; a difference then errs by the order of 1e-6
  constexpr double kMostError = 1e-3;  // of the largest derivative, from the difference of the fit
  ASSERT_EQ(result.jacobian.rows(), 20);
  ASSERT_EQ(result.jacobian.cols(), 2);
  for (Eigen::Index j = 0; j < 2; ++j) {
    Eigen::VectorXd above(2);
    above << result.parameters[0].value, result.parameters[1].value;
    Eigen::VectorXd below = above;
    const double step = kStep * above[j];
    above[j] += step;
    below[j] -= step;
    const std::vector<Prediction> beside = model.predict({above, below}, 1e-9, evaluator_, {});
    const Eigen::VectorXd right = (beside[0].components - beside[1].components).col(0) / (2.0 * step);
    EXPECT_LE((result.jacobian.col(j) - right).cwiseAbs().maxCoeff(), kMostError * right.cwiseAbs().maxCoeff()) << j;
  }
}

TEST_F(FitTest, JacobianOfTheResiduals_IsThatOfFinerDifferences) {
  const Model model(parse_scene(kScene, "scene"), {measured(kNoise)},
                    {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)});
  Residuals residuals(model, evaluator_, {2e-5, Differences::kCentral});
  Residuals exact(model, evaluator_, {1e-10, Differences::kCentral});
  const Eigen::VectorXd point = Eigen::Vector2d(0.3, 0.6);
  Linearisation found = residuals.at({point}).front();
  for (int i = 0; i < 2; ++i) residuals.linearise({&found});  // the first call chooses the steps of finite differences
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

TEST_F(FitTest, ExactData_GiveTheTruth) {
  const FitResult result = fitted(measured(0.0), {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0),
                                                  number("surface.sigma", 0.02, 1.0)});
  const double truth[] = {1.6, 0.5, 0.2};
  for (std::size_t j = 0; j < 3; ++j) {
    // Without noise the minimum is at the truth. Only the numerical error of the model remains.
    EXPECT_NEAR(result.parameters[j].value, truth[j], 0.02 * *result.parameters[j].standard_error);
    EXPECT_FALSE(result.parameters[j].is_at_bound);
  }
  EXPECT_LT(result.chi_square, 1e-3);
  EXPECT_LT(result.numerical_error, 0.01);
  EXPECT_EQ(result.degrees_of_freedom, 17U);
  EXPECT_TRUE(result.degeneracies.empty());
}

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

TEST_F(FitTest, EachNumberOfAScene_VariesAsASettingOfItWould) {
  using Settings = std::vector<std::string>;
  const Settings sky = {"surroundings.temperature_K=none", "surroundings.profile=clear-sky"};
  const Settings ends = {"surroundings.temperature_K=none", "surroundings.zenith_temperature_K=220",
                         "surroundings.horizon_temperature_K=280"};
  const Settings film = {"surface.coating=[{n=1.5,k=0.2,thickness_um=2}]"};
  const Settings bistatic = {"geometry.mode=bistatic", "source.irradiance=9"};
  const Settings paint = {"surface.diffuse=0.3"};
  struct Row {
    double value;
    Settings needed = {};
  };
  const std::map<std::string, Row> rows = {
      {"surface.n", {1.7}},
      {"surface.k", {0.4}},
      {"surface.sigma", {0.3}},
      {"surface.wind_m_s", {6, {"surface.distribution=gaussian"}}},
      {"surface.sigma_cross", {0.4, {"surface.masking=none"}}},
      {"surface.q", {2.5}},
      {"surface.specular", {0.9}},
      {"surface.diffuse", {0.2, paint}},
      {"surface.diffuse_exponent", {-0.2, paint}},
      {"surface.coating.1.n", {1.6, film}},
      {"surface.coating.1.k", {0.1, film}},
      {"surface.coating.1.thickness_um", {1.5, film}},
      {"surface.coating.1.thickness_spread_um", {0.2, film}},
      {"emission.temperature_K", {310}},
      {"source.irradiance", {5, bistatic}},
      {"source.relative_irradiance", {5, bistatic}},
      {"source.scale", {2, bistatic}},
      {"geometry.view_zenith_deg", {50, bistatic}},
      {"geometry.relative_azimuth_deg", {170, bistatic}},
      {"geometry.surface_azimuth_deg", {40, {"surface.masking=none", "surface.sigma_cross=0.4"}}},
      {"surroundings.temperature_K", {210}},
      {"surroundings.zenith_temperature_K", {200, ends}},
      {"surroundings.horizon_temperature_K", {290, ends}},
      {"surroundings.vapour_cm", {0.5, sky}},
      {"surroundings.air_temperature_K", {280, sky}},
      {"path.transmittance", {0.8, {"path.temperature_K=280"}}},
      {"path.temperature_K", {270, {"path.transmittance=0.9"}}},
      {"path.radiance", {3, {"path.transmittance=0.9"}}},
      {"spectrum.wavelength_um", {9}}};
  for (const Key& key : keys()) {
    if (key.type != Key::Type::kNumber || key.layer > 1 || key.key == "accuracy.tolerance") continue;
    ASSERT_TRUE(rows.contains(key.key)) << key.key << " is new; add it to the rows";
    const Row& row = rows.at(key.key);
    const SceneValues scene = parse_scene(kScene, "scene", settings_from_text(row.needed));
    const SceneValues set = with_settings(scene, {{key.key, row.value}});
    MeasuredData data = measured(0.0);
    if (scene.geometry.mode == Mode::kBistatic) data.zenith_column = "theta_i_deg";
    const double reach = 0.1 * std::abs(row.value);
    const Model varied(scene, {data}, {number(key.key, row.value - reach, row.value + reach)});
    const Model fixed(set, {data}, {number("surface.specular", 0.5, 1.0)});
    const auto at = [&](const Model& model, double value) {
      return model.predict({Eigen::VectorXd::Constant(1, value)}, 1e-6, evaluator_, {}).front().components;
    };
    const Eigen::MatrixX2d found = at(varied, row.value);
    EXPECT_LT((found - at(fixed, set.surface.specular)).cwiseAbs().maxCoeff(), 1e-14) << key.key;
    EXPECT_GT((found - at(varied, 1.05 * row.value)).cwiseAbs().maxCoeff(), 1e-9) << key.key;
  }
}

TEST_F(FitTest, ParameterWithoutInfluence_IsNamedAndOpen) {
  const FitResult result = fitted(measured(kNoise, {"surface.distribution=gaussian"}),
                                  {number("surface.n", 1.1, 4.0), number("surface.q", 1.6, 5.0)}, kFewStarts,
                                  {"surface.distribution=gaussian"});
  ASSERT_EQ(result.degeneracies.size(), 1U);
  EXPECT_EQ(result.degeneracies.front(), "the data do not determine surface.q at all");
  EXPECT_FALSE(result.parameters[1].standard_error.has_value());
  EXPECT_FALSE(result.parameters[1].interval_68.low || result.parameters[1].interval_68.high);
  EXPECT_TRUE(result.parameters[0].interval_95.low && result.parameters[0].interval_95.high);
  EXPECT_EQ(result.determined, 1U);
}

TEST_F(FitTest, FactorsOfOneProduct_AreNamedAsAPair) {
  // I and Q are both proportional to k_s times the irradiance of the source, so Q/I depends on neither.
  const std::vector<std::string> source_alone = {"emission=none", "surroundings=none", "source.irradiance=1"};
  const MeasuredData data = measured(kNoise, source_alone);
  const FitResult result = fitted(
      data, {number("surface.n", 1.1, 4.0), number("surface.specular", 0.2, 0.9), number("source.scale", 0.5, 2.0)},
      kFewStarts, source_alone);
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

TEST_F(FitTest, Outlier_MovesSquaresMoreThanARobustLoss) {
  MeasuredData data = measured(0.0);
  data.measurements[15].value += 50.0 * kNoise;
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0)};
  const double squares = std::abs(fitted(data, parameters).parameters.front().value - 1.6);
  for (const Loss loss : {Loss::kHuber, Loss::kSoftL1, Loss::kCauchy, Loss::kTukey}) {
    const FitResult result = fitted(data, parameters, {.vary = {}, .starts = 4, .loss = loss});
    EXPECT_LT(std::abs(result.parameters.front().value - 1.6), 0.3 * squares);
    EXPECT_FALSE(result.p_value.has_value());
  }
}

TEST_F(FitTest, SameSeed_GivesTheSameDigits) {
  const MeasuredData data = measured(kNoise);
  const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)};
  const FitResult one = fitted(data, parameters);
  const FitResult two = fitted(data, parameters);
  EXPECT_EQ(one.parameters[0].value, two.parameters[0].value);
  EXPECT_EQ(one.parameters[1].interval_95.high, two.parameters[1].interval_95.high);
  EXPECT_NEAR(fitted(data, parameters, {.vary = {}, .starts = 4, .seed = 2}).parameters[0].value,
              one.parameters[0].value, 0.01 * *one.parameters[0].standard_error);
}

}  // namespace
}  // namespace dolp::fit::fit_test
