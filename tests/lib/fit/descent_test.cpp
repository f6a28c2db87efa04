// Steps of descents, and derivatives.
#include "fit_support.hpp"

namespace dolp::fit {
namespace {

// If a step of predict_step would leave the range of a parameter, this parameter gets a step that ends on the bound.
// Least squares then give new steps of the other parameters. Last, the step to the bound is halved, so this test
// doubles it again. The damping of steps is proportional to kScale, which is so tiny here that damping has no effect.
TEST(PredictStep, ParametersLeaveTheBounds_OthersAreSolvedAgain) {
  constexpr double kScale = 1e-14;
  constexpr double kRounding = 1e-6;  // rounding error of normal equations with almost parallel columns
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

TEST_F(FitTest, Jacobian_IsThatOfFinerDifferences) {
  const Model model(parse_scene(kScene, "scene"), {measured(kNoise)},
                    {number("surface.n", 1.1, 4.0), number("surface.sigma", 0.02, 1.0)});
  Residuals residuals(model, 2e-5, Differences::kCentral, evaluator_, {});
  Residuals exact(model, 1e-10, Differences::kCentral, evaluator_, {});
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

}  // namespace
}  // namespace dolp::fit
