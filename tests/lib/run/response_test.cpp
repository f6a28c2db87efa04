// Weights of reflectances, which response tables contain. Finer quadrature, the reference and closed forms check them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "properties_support.hpp"
#include "reference/fresnel.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/response_run.hpp"
#include "scene/scene_reader.hpp"

namespace response_test {

using namespace dolp;

EntryResponses responses(const Model& model, const std::vector<Point>& points, double tolerance,
                         ModelEvaluator& evaluator, bool has_extra_splits = false) {
  Surface surface;
  surface.distribution = model.distribution;
  surface.masking = model.masking;
  MomentsRequest request = response_request(surface);
  request.has_extra_splits = has_extra_splits;
  for (const Point& p : points) request.append({p.theta_deg, p.shape, kUnusedIndex});
  return compute_responses(request, {.tolerance = tolerance}, evaluator, {});
}

std::span<const double> weights(const EntryResponses& all, ResponseVariable variable, std::size_t entry) {
  const std::size_t count = all.responses[ResponseVariable::kResponseI].size() / all.albedo.size();
  return std::span(all.responses[variable]).subspan(entry * count, count);
}

double error_at(const EntryResponses& all, std::size_t entry) {
  return all.responses[ResponseVariable::kResponseError][entry];
}

/// Expects that weights in `a` and `b` differ by at most the sum of their stated errors. Returns the largest ratio of
/// the difference to this sum. Entry i of `b` and entry i * `step` of `a` belong to point i.
double expect_within_bounds(const EntryResponses& a, const EntryResponses& b, const std::vector<Point>& points,
                            std::size_t step = 1) {
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(std::isnan(error_at(a, i * step)), std::isnan(error_at(b, i))) << text_of(points[i]);
    const double bound = error_at(a, i * step) + error_at(b, i);
    if (std::isnan(bound)) continue;
    for (const ResponseVariable variable : kAllResponseVariables) {
      if (!describe(variable).has_beta || a.responses[variable].empty()) continue;
      const bool is_of_q = variable == ResponseVariable::kResponseQ || variable == ResponseVariable::kEmissionQ;
      const double distance = response_distance(weights(a, variable, i * step), weights(b, variable, i), is_of_q);
      EXPECT_LE(distance, bound) << describe(variable).name << " at " << text_of(points[i]);
      worst = std::max(worst, distance / bound);
    }
  }
  return worst;
}

class ResponsesOf : public testing::TestWithParam<Model> {};

TEST_P(ResponsesOf, RandomEntries_StayWithinTheirBounds) {
  const Model model = GetParam();
  constexpr std::uint64_t kSeed = 44;
  const std::vector<Point> points = Random(kSeed).points(model, draws_wanted(40));
  CpuEvaluator evaluator;
  const EntryResponses fine = responses(model, points, 1e-8, evaluator, true);
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const EntryResponses own = responses(model, points, tolerance, evaluator);
    const double worst = expect_within_bounds(own, fine, points);
    std::printf("seed %llu, tolerance %g: largest distance over the bounds %.2g\n",
                static_cast<unsigned long long>(kSeed), tolerance, worst);
  }
}

TEST_P(ResponsesOf, SomeEntries_AreThoseOfTheReference) {
  const std::vector<Point> points = {{35.0, {0.1, 2.5}, {}}, {60.0, {0.3, 2.0}, {}}, {85.0, {0.7, 4.0}, {}}};
  CpuEvaluator evaluator;
  ReferenceEvaluator reference({.relative_tolerance = 1e-6});
  const EntryResponses own = responses(GetParam(), points, 1e-4, evaluator);
  const EntryResponses right = responses(GetParam(), points, 1e-4, reference);
  expect_within_bounds(own, right, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE(error_at(own, i), 1e-4 * own.albedo[i]);
    EXPECT_NEAR(own.albedo[i], right.albedo[i], error_at(own, i) + error_at(right, i));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, ResponsesOf, testing::ValuesIn(kModels),
                         [](const auto& test) { return to_name(test.param); });

TEST(Responses, OfADevice_AreThoseOfTheCpu) {
  std::vector<Point> points;
  for (const double theta_deg : {0.0, 60.0, 90.0}) {
    for (const double sigma : {0.1, 0.5}) points.push_back({theta_deg, {sigma, 2.5}, {}});
  }
  VulkanOptions options;
  options.has_validation = true;
  VulkanEvaluator device(options);
  CpuEvaluator cpu;
  for (const Model& model : kModels) {
    Surface surface;
    surface.distribution = model.distribution;
    surface.masking = model.masking;
    MomentsRequest grid = response_request(surface);
    grid.theta_deg = {0.0, 60.0, 90.0};
    grid.optics = {kUnusedIndex};
    grid.shapes = {{0.1, 2.5}, {0.5, 2.5}};
    grid.set_grid();
    expect_within_bounds(compute_responses(grid, {.tolerance = 1e-4}, device, {}), responses(model, points, 1e-9, cpu),
                         points);
  }
}

TEST(Responses, OfADenseGrid_AreThoseOfEntriesByThemselves) {
  constexpr std::size_t kStep = 37;
  for (const Model& model : kModels) {
    Surface surface;
    surface.distribution = model.distribution;
    surface.masking = model.masking;
    MomentsRequest grid = response_request(surface);
    grid.theta_deg = {30.0, 75.0};
    grid.optics = {kUnusedIndex};
    const std::vector q = model.distribution == Distribution::kGaussian ? std::vector{2.0} : spaced(1.8, 5.0, 24);
    grid.shapes = shape_product(spaced(0.1, 0.6, 32), q);
    grid.set_grid();
    std::vector<Point> points;
    for (std::size_t i = 0; i < grid.size(); i += kStep) points.push_back({grid[i].theta_deg, grid[i].shape, {}});
    CpuEvaluator evaluator;
    const double worst = expect_within_bounds(compute_responses(grid, {.tolerance = 1e-4}, evaluator, {}),
                                              responses(model, points, 1e-7, evaluator), points, kStep);
    std::printf("%s: largest distance over the bounds %.2g\n", to_name(model).c_str(), worst);
  }
}

TEST(Responses, AxesThatTheyDoNotDependOn_AreNotInTheTable) {
  for (const char* axis : {"temperature_K = [280, 300]", "n = [1.3, 1.5]", "wavelength_um = [9, 10]",
                           "material = [\"iron\", \"PET\"]", "band_um = [[3, 5], [8, 12]]"}) {
    const bool has_index = std::string_view(axis).starts_with("material") || axis[0] == 'n';
    const bool has_spectrum = axis[0] == 'w' || axis[0] == 'b';
    const SceneValues scene = parse_scene(
        std::string("[surface]\nsigma = 0.2\n") + (has_index ? "" : "n = 1.5\n") + "[emission]\ntemperature_K = 300\n" +
            (has_spectrum ? "" : "[spectrum]\nwavelength_um = 10\n") + "[grid]\ntheta_deg = [0, 60]\n" + axis + '\n',
        "", {});
    EXPECT_EQ(response_layout(scene).head.size(), 2U) << axis;
  }
}

TEST(Responses, OfAMirror_GiveFresnelsReflectances) {
  constexpr double kInterpolation = 1e-8;  // error of the polynomials of degree 23 that replace the reflectances
  CpuEvaluator evaluator;
  const std::vector<Point> points = {{0.0, {0.0, 2.0}, {}}, {40.0, {0.0, 2.0}, {}}, {89.0, {0.0, 2.0}, {}}};
  const EntryResponses mirror = responses({Distribution::kCauchy, Masking::kSmith}, points, 1e-4, evaluator);
  const TableLayout layout = response_layout(parse_scene(
      "[surface]\nn = 1.5\nsigma = 0\n[emission]\ntemperature_K = 300\n[spectrum]\nwavelength_um = 10\n", "", {}));
  const std::vector<double>& beta_deg = layout.head.beta_deg;
  for (const OpticalConstants& index : {OpticalConstants{1.5, 0.0}, {2.2, 0.9}, {27.0, 90.0}}) {
    const auto curves = [&](double angle_deg) {
      const auto r = reference::fresnel(index, std::cos(angle_deg * std::numbers::pi / 180.0));
      return std::pair(0.5 * (std::norm(r.r_s) + std::norm(r.r_p)), 0.5 * (std::norm(r.r_s) - std::norm(r.r_p)));
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      double rho_i = 0.0, rho_q = 0.0, eps_i = 0.0, eps_q = 0.0;
      for (std::size_t j = 0; j < beta_deg.size(); ++j) {
        const auto [mean, half] = curves(beta_deg[j]);
        rho_i += weights(mirror, ResponseVariable::kResponseI, i)[j] * mean;
        rho_q += weights(mirror, ResponseVariable::kResponseQ, i)[j] * half;
        eps_i += weights(mirror, ResponseVariable::kEmissionI, i)[j] * (1.0 - mean);
        eps_q -= weights(mirror, ResponseVariable::kEmissionQ, i)[j] * half;
      }
      const auto [mean, half] = curves(points[i].theta_deg);
      EXPECT_NEAR(rho_i, mean, kInterpolation);
      EXPECT_NEAR(rho_q, half, kInterpolation);
      EXPECT_NEAR(eps_i, 1.0 - mean, kInterpolation);
      EXPECT_NEAR(eps_q, -half, kInterpolation);
    }
  }
}

TEST(Responses, At90Degrees_AreTheLimitOrNone) {
  CpuEvaluator evaluator;
  const std::vector<Point> points = {{90.0, {0.3, 2.5}, {}}, {90.0 - 1e-7, {0.3, 2.5}, {}}};
  for (const Model& model : kModels) {
    const EntryResponses all = responses(model, points, 1e-4, evaluator);
    EXPECT_EQ(std::isnan(all.albedo[0]), !keeps_projected_area(model.masking)) << to_name(model);
    if (!std::isnan(all.albedo[0])) {
      EXPECT_NEAR(all.albedo[0], all.albedo[1], 1e-5 + error_at(all, 0) + error_at(all, 1)) << to_name(model);
    }
  }
}

}  // namespace response_test
