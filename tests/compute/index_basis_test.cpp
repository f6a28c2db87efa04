// Bases of indices: reflectances that are combined from those of a few, against the reference's Fresnel equations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "model/index_basis.hpp"
#include "properties_support.hpp"
#include "reference/fresnel.hpp"

namespace {

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

std::vector<OpticalConstants> random_indices(const Box& box, std::size_t count, Random& random) {
  std::vector<OpticalConstants> indices;
  for (std::size_t i = 0; i < count; ++i) {
    indices.push_back({random.uniform(box.least.n, box.most.n), random.uniform(box.least.k, box.most.k)});
  }
  return indices;
}

/// (R_s + R_p) / 2 and (R_s - R_p) / 2.
std::pair<double, double> curves_at(const OpticalConstants& index, double cosine) {
  const reference::FresnelCoefficients of = reference::fresnel(index, cosine);
  return {0.5 * (std::norm(of.r_s) + std::norm(of.r_p)), 0.5 * (std::norm(of.r_s) - std::norm(of.r_p))};
}

double level_of(const OpticalConstants& index) {
  const double at_normal = curves_at(index, 1.0).first;
  return std::min(at_normal, 1.0 - at_normal);
}

// At far more angles than the basis looks at, for indices of the run and others.
TEST(IndexBasis, CombinedReflectances_StayWithinTheirBounds) {
  constexpr int kAngles = 4000;
  Random random(1);
  for (const Box& box : kBoxes) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
      SCOPED_TRACE(std::string(box.name) + " at " + fmt::format("{:g}", tolerance));
      const std::vector<OpticalConstants> run = random_indices(box, 300, random);
      const auto basis = IndexBasis::of(run, tolerance);
      ASSERT_TRUE(basis);
      EXPECT_LE(2 * basis->indices().size(), run.size());
      std::vector<OpticalConstants> asked(run.begin(), run.begin() + 20);
      for (const OpticalConstants& other : random_indices(box, 20, random)) asked.push_back(other);
      int reached = 0;
      for (const OpticalConstants& index : asked) {
        const auto weights = basis->weights_of(index);
        if (!weights) continue;
        ++reached;
        EXPECT_NEAR(weights->mean.sum(), 1.0, 1e-12);
        EXPECT_LE(std::max(weights->mean_error, weights->difference_error), 1.0001 * tolerance * level_of(index));
        double mean_off = 0.0, difference_off = 0.0;
        for (int i = 1; i <= kAngles; ++i) {
          const double cosine = std::pow(static_cast<double>(i) / kAngles, 2.0);
          auto [mean, difference] = curves_at(index, cosine);
          for (std::size_t j = 0; j < basis->indices().size(); ++j) {
            const auto own = curves_at(basis->indices()[j], cosine);
            mean -= weights->mean[static_cast<Eigen::Index>(j)] * own.first;
            difference -= weights->difference[static_cast<Eigen::Index>(j)] * own.second;
          }
          mean_off = std::max(mean_off, std::abs(mean));
          difference_off = std::max(difference_off, std::abs(difference));
        }
        constexpr double kRounding = 1e-13;
        EXPECT_LE(mean_off, weights->mean_error + kRounding) << index.n << " " << index.k;
        EXPECT_LE(difference_off, weights->difference_error + kRounding) << index.n << " " << index.k;
      }
      EXPECT_GT(reached, 20);
    }
  }
}

TEST(IndexBasis, FewOrEqualIndices_HaveNone) {
  EXPECT_FALSE(IndexBasis::of({}, 1e-4));
  EXPECT_FALSE(IndexBasis::of({{1.5, 0.1}}, 1e-4));
  EXPECT_FALSE(IndexBasis::of({{1.5, 0.1}, {4.0, 0.0}, {0.9, 3.0}, {20.0, 60.0}}, 1e-4));
  EXPECT_FALSE(IndexBasis::of(std::vector<OpticalConstants>(100, {1.5, 0.1}), 1e-4));
}

TEST(IndexBasis, IndicesWithAKink_AreNotReached) {
  Random random(3);
  std::vector<OpticalConstants> run = random_indices(kBoxes[0], 200, random);
  const auto basis = IndexBasis::of(run, 1e-4);
  ASSERT_TRUE(basis);
  EXPECT_TRUE(basis->weights_of({1.7, 0.5}));
  for (const OpticalConstants& index :
       {OpticalConstants{0.5, 0.0}, {0.9, 0.001}, {1.001, 0.0}, {1.0, 0.0}, {30.0, 70.0}})
    EXPECT_FALSE(basis->weights_of(index)) << index.n << " " << index.k;
}

}  // namespace
