// Response bases: reflectances as sums of Chebyshev polynomials, compared with Fresnel's equations in host/reference.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "model/response_basis.hpp"
#include "properties_support.hpp"
#include "reference/fresnel.hpp"

namespace response_basis_test {

using namespace dolp;

struct Box {
  const char* name;
  OpticalConstants least, most;
};
constexpr Box kBoxes[] = {{"paints", {1.3, 0.01}, {2.5, 1.0}},
                          {"dielectrics", {1.2, 0.0}, {4.0, 0.0}},
                          {"all absorbers", {0.3, 0.0}, {4.0, 4.0}},
                          {"metals", {1.0, 5.0}, {40.0, 90.0}},
                          {"everything", {1.05, 1e-3}, {60.0, 120.0}}};

std::vector<FacetOptics> random_indices(const Box& box, std::size_t count, Random& random) {
  std::vector<FacetOptics> indices;
  for (std::size_t i = 0; i < count; ++i) {
    indices.push_back({random.uniform(box.least.n, box.most.n), random.uniform(box.least.k, box.most.k)});
  }
  return indices;
}

/// (R_s + R_p) / 2 and (R_s - R_p) / 2 of a smooth surface.
std::pair<double, double> curves_at(const OpticalConstants& index, double cosine) {
  const reference::FresnelCoefficients of = reference::fresnel(index, cosine);
  return {0.5 * (std::norm(of.r_s) + std::norm(of.r_p)), 0.5 * (std::norm(of.r_s) - std::norm(of.r_p))};
}

double level_of(const OpticalConstants& index) {
  const double at_normal = curves_at(index, 1.0).first;
  return std::min(at_normal, 1.0 - at_normal);
}

/// The sum of coefficients times Chebyshev polynomials, at one cosine of the angle of incidence.
double sum_at(const ResponseBasis& basis, const Eigen::VectorXd& coefficients, double cosine) {
  const double x = 2.0 * std::asinh(cosine / basis.c0()) / std::asinh(1.0 / basis.c0()) - 1.0;
  double sum = 0.0;
  for (Eigen::Index j = 0; j < coefficients.size(); ++j)
    sum += coefficients[j] * std::cos(static_cast<double>(j) * std::acos(std::clamp(x, -1.0, 1.0)));
  return sum;
}

// Compares reflectances at far more angles than the basis uses, for indices that it was made for and for other indices.
TEST(ResponseBasis, CombinedReflectances_StayWithinTheirBounds) {
  constexpr int kAngles = 4000;
  Random random(1);
  for (const Box& box : kBoxes) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
      SCOPED_TRACE(std::string(box.name) + " at " + fmt::format("{:g}", tolerance));
      const std::vector<FacetOptics> run = random_indices(box, 300, random);
      const auto basis = ResponseBasis::of(run, tolerance, 1);
      if (!basis) {
        EXPECT_LT(tolerance, 1e-4);
        continue;
      }
      EXPECT_LE(basis->count(), kMostResponses);
      std::vector<FacetOptics> asked(run.begin(), run.begin() + 20);
      for (const FacetOptics& other : random_indices(box, 20, random)) asked.push_back(other);
      int reached = 0;
      for (const FacetOptics& optics : asked) {
        const OpticalConstants& index = optics.index;
        const auto weights = basis->find_weights(index);
        if (!weights) continue;
        ++reached;
        EXPECT_LE(std::max(weights->absorbed_error, weights->split_error), tolerance * level_of(index));
        double mean_off = 0.0, difference_off = 0.0;
        for (int i = 1; i <= kAngles; ++i) {
          const double cosine = std::pow(static_cast<double>(i) / kAngles, 2.0);
          const auto [mean, difference] = curves_at(index, cosine);
          const double sin2 = (1.0 - cosine) * (1.0 + cosine);
          mean_off = std::max(mean_off, std::abs(1.0 - mean - sum_at(*basis, weights->absorbed, cosine)));
          difference_off =
              std::max(difference_off, std::abs(difference - sin2 * sum_at(*basis, weights->split, cosine)));
        }
        constexpr double kRounding = 1e-13;
        EXPECT_LE(mean_off, weights->absorbed_error + kRounding) << index.n << " " << index.k;
        EXPECT_LE(difference_off, weights->split_error + kRounding) << index.n << " " << index.k;
      }
      EXPECT_GT(reached, 10);
    }
  }
}

TEST(ResponseBasis, FewIndices_HaveNone) {
  EXPECT_FALSE(ResponseBasis::of({}, 1e-4, 1));
  EXPECT_FALSE(ResponseBasis::of({{1.5, 0.1}}, 1e-4, 1));
  // The program uses a response basis only if the basis saves time. It needs at least three indices to save time if the
  // kernel runs once, and at least seven indices if the kernel runs three times.
  const std::vector<FacetOptics> three = {{1.5, 0.1}, {1.6, 0.1}, {1.7, 0.2}};
  EXPECT_TRUE(ResponseBasis::of(three, 1e-4, 1));
  EXPECT_FALSE(ResponseBasis::of(three, 1e-4, 3));
}

TEST(ResponseBasis, IndicesWithAKink_AreNotReached) {
  Random random(3);
  const auto basis = ResponseBasis::of(random_indices(kBoxes[0], 200, random), 1e-4, 1);
  ASSERT_TRUE(basis);
  EXPECT_TRUE(basis->find_weights({1.7, 0.5}));
  for (const OpticalConstants& index : {OpticalConstants{0.5, 0.0}, {0.9, 0.001}, {1.001, 0.0}, {1.0, 0.0}})
    EXPECT_FALSE(basis->find_weights(index)) << index.n << " " << index.k;
}

}  // namespace response_basis_test
