// Derivatives of the residuals, which the descents follow.
#include "fit_support.hpp"

namespace dolp::fit {
namespace {

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
