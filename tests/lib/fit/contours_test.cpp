// Contours of chi^2 over two parameters agree with brute force.
#include <Eigen/Geometry>

#include "fit_support.hpp"

namespace dolp::fit::contours_test {
namespace {

/// For each place (values of two parameters), minimises chi^2 over the third parameter and subtracts chi^2 of the fit.
/// Scans the range of the third parameter, then smaller and smaller ranges around its best value.
std::vector<double> brute_growth(Residuals& residuals, const FitResult& result, const std::array<std::size_t, 2>& pair,
                                 const std::vector<Eigen::Vector2d>& places) {
  constexpr int kSteps = 20;
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
      const double growth = found[i].objective - result.chi_square;
      if (growth >= least[k]) continue;
      least[k] = growth;
      middles[k] = points[i][static_cast<Eigen::Index>(3 - pair[0] - pair[1])];
    }
  }
  return least;
}

class FitContours : public FitTest {
 protected:
  /// Fits n, k and sigma, and compares the growth that compute_contours computes with brute_growth. The growth is chi^2
  /// minus chi^2 of the fit. `off` is the tolerance of its square root.
  void expect_true(int points, std::uint64_t seed, double off) {
    const std::vector<FitRange> parameters = {number("surface.n", 1.1, 4.0), number("surface.k", 0.0, 5.0),
                                              number("surface.sigma", 0.02, 1.0)};
    const Model model(parse_scene(kScene, "scene"), {measured(kNoise, {}, true, points, seed)}, parameters);
    const FitResult result = fit::fit(model, evaluator_, {}).value();
    const Contours contours = compute_contours(model, evaluator_, result, {}).value();
    EXPECT_LE(contours.evaluations, 2 * result.evaluations);
    const auto& pair = contours.parameters;
    Residuals residuals(model, evaluator_, {result.tolerance});
    Eigen::AlignedBox2d box;
    std::vector<Eigen::Vector2d> places;
    std::vector<double> roots;
    for (Eigen::Index i = 0; i < contours.growth.size(); ++i) {
      const double growth = contours.growth.reshaped()[i];
      if (std::isnan(growth)) continue;
      const Eigen::Vector2d place(parameters[pair[0]].coordinate(contours.values[0].reshaped()[i]),
                                  parameters[pair[1]].coordinate(contours.values[1].reshaped()[i]));
      box.extend(place);
      if (growth > kContourLevels[1] || i % 8 != 0) continue;
      places.push_back(place);
      roots.push_back(std::sqrt(growth));
    }
    ASSERT_GE(places.size(), 10U);
    const std::vector<double> right = brute_growth(residuals, result, pair, places);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(roots[i], std::sqrt(std::max(0.0, right[i])), off) << places[i].transpose();
    // Outside the box around the contours, the growth must not be far below the level of the outer contour.
    places.clear();
    for (int i = 0; i < 64; ++i) places.emplace_back(i % 8 / 7.0, i / 8 / 7.0);
    const std::vector<double> growths = brute_growth(residuals, result, pair, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_at_bound = places[i].minCoeff() <= 0.0 || places[i].maxCoeff() >= 1.0;
      EXPECT_TRUE(growths[i] > 0.9 * kContourLevels[1] || is_at_bound || box.contains(places[i]))
          << places[i].transpose();
    }
  }
};

// The tolerance is 0.1, because compute_contours interpolates the residuals linearly between the nodes of its grid, and
// its descents stop shortly before the minimum.
TEST_F(FitContours, EightPoints_AreWhereTheLeastOfTheThirdParameterSays) { expect_true(8, 7, 0.1); }

// Four points hardly distinguish n, k and sigma, so that chi^2 has a bent valley. In a bent valley, linear
// interpolation of the residuals has larger errors. So the tolerance is larger.
TEST_F(FitContours, FourPoints_AreWhereTheLeastOfTheThirdParameterSays) { expect_true(4, 7, 0.4); }

}  // namespace
}  // namespace dolp::fit::contours_test
