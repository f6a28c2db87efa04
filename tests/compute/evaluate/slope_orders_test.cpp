// Slopes that differ along and across, computed by the kernels: comparison with the reference, which integrates the
// density over slopes and azimuths, and properties that hold for all inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "calibrate/random_entries.hpp"
#include "model/angles.hpp"
#include "model/sky_basis.hpp"
#include "properties_support.hpp"
#include "reference/reference_evaluator.hpp"

namespace dolp::slope_orders_test {
namespace {

struct Light {
  const char* name;
  Masking masking;
  Scattering scattering;
  bool is_direct;
};
constexpr std::array<Light, 3> kLights{{{"none", Masking::kNone, Scattering::kSingle, false},
                                        {"v-cavity", Masking::kVCavity, Scattering::kSingle, true},
                                        {"all bounces", Masking::kVCavity, Scattering::kMultiple, false}}};
constexpr Light kSmithDirect{"smith", Masking::kSmith, Scattering::kSingle, true};
constexpr std::array kBothDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr SlopeShape kBrushed{.sigma = 0.3, .q = 3.0, .sigma_cross = 0.12, .azimuth_deg = 25.0};
constexpr double kTolerance = 1e-4;

MomentsRequest empty_request(Distribution distribution, const Light& light) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = light.masking;
  request.scattering = light.scattering;
  request.wants_direct = light.is_direct;
  request.tolerance = kTolerance;
  return request;
}

MomentsRequest brushed_request(Distribution distribution, const Light& light, const std::vector<SlopeShape>& shapes) {
  MomentsRequest request = empty_request(distribution, light);
  for (const SlopeShape& shape : shapes) request.append({70.0, shape, FacetOptics{1.6, 0.5}});
  return request;
}

/// Expects agreement within the stated errors, with U. Returns the largest ratio of a difference to its bound.
double expect_all_within_bounds(const Moments& a, const Moments& b, const std::string& where) {
  double worst = expect_within_bounds(a, b, where);
  const auto compare = [&](double own, double other, double bound) {
    EXPECT_LE(std::abs(own - other), bound) << where << ": U " << own << " and " << other;
    worst = std::max(worst, own == other ? 0.0 : std::abs(own - other) / bound);
  };
  compare(a.r_u, b.r_u, a.r_q_error + b.r_q_error);
  if (!std::isnan(b.direct_i)) compare(a.direct_u, b.direct_u, a.direct_q_error + b.direct_q_error);
  for (std::size_t k = 0; k < a.columns.size(); ++k) {
    const double bound = a.columns[k].error + b.columns[k].error;
    compare(a.columns[k].i, b.columns[k].i, bound);
    compare(a.columns[k].q, b.columns[k].q, bound);
    compare(a.columns[k].u, b.columns[k].u, bound);
  }
  return worst;
}

// The facets of order k are e^k of all, because the azimuths of all facets have the density sigma_a^2 / (2 pi sigma
// sigma_cross). With too few sectors, the errors of high orders exceed their bounds.
TEST(SlopeSectors, CosinesOfTheAzimuth_ArePowersOfTheEccentricity) {
  constexpr std::size_t kCount = 24;
  const SlopeShape shape{.sigma = 1.5, .sigma_cross = 4.3};
  const double e = -eccentricity(shape);
  for (int k = 0; k <= 24; ++k) {
    double sum = 0.0;
    for (const SlopeSector& sector : slope_sectors(shape, kCount))
      sum += sector.share * std::cos(2.0 * k * sector.azimuth);
    EXPECT_NEAR(sum, std::pow(e, k), 2.0 * std::pow(-e, 2.0 * kCount - k) + 1e-15) << k;
  }
}

class SlopeOrders : public testing::TestWithParam<Kernel> {
 protected:
  std::unique_ptr<ModelEvaluator> evaluator_ = make_evaluator(GetParam());
};

// Gaussian slopes of the sea, clean surface, at 10 m/s: Cox and Munk (1954). N = 1.18 + 0.07i. Values of v-cavity: a
// sum over 9e6 facets on a grid of slopes, by a program that shares nothing with this one. Values of smith: own
// quadrature in two dimensions, see tests/reference/elliptic_slopes_test.cpp.
TEST_P(SlopeOrders, Sea_EmitsDifferentlyUpwindAndCrosswind) {
  struct Row {
    Light light;
    double theta_deg, azimuth_deg, q, u, emissivity;  // Q/I and U/I in %
  };
  const Light& cavity = kLights[1];
  const std::vector<Row> rows = {
      {cavity, 75.0, 0.0, -4.963, 0.0, 0.87084},       {cavity, 75.0, 45.0, -5.090, 0.107, 0.86568},
      {cavity, 75.0, 90.0, -5.235, 0.0, 0.85992},      {cavity, 82.0, 0.0, -6.595, 0.0, 0.78685},
      {cavity, 82.0, 45.0, -6.771, 0.245, 0.77593},    {cavity, 82.0, 90.0, -6.979, 0.0, 0.76286},
      {kSmithDirect, 75.0, 0.0, -4.898, 0.0, 0.87289}, {kSmithDirect, 75.0, 45.0, -5.044, 0.110, 0.86713},
      {kSmithDirect, 75.0, 90.0, -5.206, 0.0, 0.86085}};
  for (const Row& row : rows) {
    MomentsRequest request = empty_request(Distribution::kGaussian, row.light);
    request.tolerance = 1e-5;
    const SlopeShape shape{std::sqrt(0.0316), 2.0, std::sqrt(0.0222), row.azimuth_deg};
    request.append({row.theta_deg, shape, FacetOptics{1.18, 0.07}});
    const Moments m = evaluator_->evaluate(request, {}).front();
    const std::string where = std::string(row.light.name) + " " + std::to_string(row.theta_deg);
    EXPECT_NEAR(100.0 * m.direct_q / m.direct_i, row.q, 0.6e-3) << where;
    EXPECT_NEAR(100.0 * m.direct_u / m.direct_i, row.u, 0.6e-3) << where;
    EXPECT_NEAR(m.direct_i / cos_sin_deg(row.theta_deg).cos, row.emissivity, 1.1e-5) << where;
  }
}

/// Entries with widths along and across whose quotient is 1/3 to 3.
MomentsRequest random_entries(Distribution distribution, const Light& light, std::size_t count) {
  constexpr std::uint64_t kEntrySeed = 20270301;
  Draws draw(kEntrySeed + static_cast<std::uint64_t>(distribution));
  MomentsRequest request = empty_request(distribution, light);
  for (std::size_t i = 0; i < count; ++i) {
    MomentsPoint entry = random_entry(draw, Domain::kOrdinary, distribution, light.masking);
    entry.shape.sigma = draw.log_uniform(0.03, 1.0);
    entry.shape.q = draw.uniform(1.6, 6.0);
    entry.shape.sigma_cross = entry.shape.sigma * draw.log_uniform(1.0 / 3.0, 3.0);
    entry.shape.azimuth_deg = draw.uniform(-180.0, 180.0);
    request.append(entry);
  }
  return request;
}

// Close to the largest quotient of the widths that a tolerance allows, at grazing incidence, many orders matter.
TEST_P(SlopeOrders, VeryUnequalWidths_AreWithinTheBoundsOfTheReference) {
  ReferenceEvaluator reference;
  for (const auto& [distribution, tolerance, sigma_cross] : {std::tuple{Distribution::kGaussian, 1e-2, 6.6},
                                                             {Distribution::kGaussian, 1e-3, 3.9},
                                                             {Distribution::kCauchy, 1e-2, 6.6}}) {
    MomentsRequest request = empty_request(distribution, kLights[1]);
    request.tolerance = tolerance;
    for (const double theta_deg : {88.0, 89.5, 89.95})
      request.append({theta_deg, {0.3, 1.8, sigma_cross, 0.0}, FacetOptics{3.0, 2.0}});
    const std::vector<Moments> own = evaluator_->evaluate(request, {});
    const std::vector<Moments> exact = reference.evaluate(request, {});
    for (std::size_t i = 0; i < own.size(); ++i)
      expect_all_within_bounds(own[i], exact[i], std::to_string(sigma_cross) + ' ' + std::to_string(i));
  }
}

TEST_P(SlopeOrders, RandomEntries_AreWithinTheBoundsOfTheReference) {
  ReferenceEvaluator reference;
  for (const Distribution distribution : kBothDistributions) {
    for (const Light& light : {kLights[0], kLights[1], kLights[2], kSmithDirect}) {
      const MomentsRequest request =
          random_entries(distribution, light, light.scattering == Scattering::kMultiple ? 3 : 6);
      const std::vector<Moments> own = evaluator_->evaluate(request, {});
      const std::vector<Moments> exact = reference.evaluate(request, {});
      double worst = 0.0;
      for (std::size_t i = 0; i < own.size(); ++i) {
        const MomentsPoint p = request[i];
        worst =
            std::max(worst, expect_all_within_bounds(own[i], exact[i], text_of({p.theta_deg, p.shape, p.index.index})));
      }
      std::printf("%s %s: worst %.2g of its bound\n", to_name(distribution), light.name, worst);
    }
  }
}

TEST_P(SlopeOrders, Sky_IsThatOfTheReference) {
  const SkyNodes nodes({0.0, 45.0, 90.0});
  Eigen::VectorXd cosines(static_cast<Eigen::Index>(nodes.zenith_deg().size()));
  for (Eigen::Index i = 0; i < cosines.size(); ++i)
    cosines[i] = cos_sin_deg(nodes.zenith_deg()[static_cast<std::size_t>(i)]).cos;
  for (const Light& light : kLights) {
    MomentsRequest request = brushed_request(Distribution::kGaussian, light, {kBrushed});
    request.wants_direct = false;
    request.sky = std::make_shared<const SkyBasis>(nodes, std::vector{cosines}, 1e-6);
    const Moments own = evaluator_->evaluate(request, {}).front();
    const Moments exact = ReferenceEvaluator().evaluate(request, {}).front();
    ASSERT_EQ(own.columns.size(), 1U) << light.name;
    EXPECT_GT(std::abs(exact.columns.front().u), 10.0 * own.columns.front().error) << light.name;
    expect_all_within_bounds(own, exact, light.name);
  }
}

bool have_same_bits(const Moments& a, const Moments& b) {
  const auto is_same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return are_same(a, b) && is_same(a.direct_i, b.direct_i) && is_same(a.direct_q, b.direct_q) && a.r_u == b.r_u &&
         a.direct_u == b.direct_u;
}

TEST_P(SlopeOrders, EqualWidths_GiveTheBitsOfIsotropicSlopes) {
  for (const Light& light : kLights) {
    const SlopeShape isotropic{0.3, 2.5}, equal{0.3, 2.5, 0.3, 40.0};
    const Moments a = evaluator_->evaluate(brushed_request(Distribution::kCauchy, light, {isotropic}), {}).front();
    const Moments b = evaluator_->evaluate(brushed_request(Distribution::kCauchy, light, {equal}), {}).front();
    EXPECT_TRUE(have_same_bits(a, b)) << light.name;
    EXPECT_EQ(a.r_u, 0.0);
  }
}

TEST_P(SlopeOrders, HalfTurnAndMirrorImage_ChangeNothingButTheSignOfU) {
  const double rounding = is_double(GetParam()) ? 1e-12 : 2e-6;
  SlopeShape turned = kBrushed, mirrored = kBrushed;
  turned.azimuth_deg += 180.0;
  mirrored.azimuth_deg *= -1.0;
  for (const Light& light : kLights) {
    const MomentsRequest request = brushed_request(Distribution::kCauchy, light, {kBrushed, turned, mirrored});
    const std::vector<Moments> m = evaluator_->evaluate(request, {});
    for (const MomentMember& member : kMomentMembers) {
      if (!light.is_direct && std::isnan(m[0].*member.value)) continue;
      EXPECT_NEAR(m[1].*member.value, m[0].*member.value, rounding) << light.name;
      EXPECT_NEAR(m[2].*member.value, m[0].*member.value, rounding) << light.name;
    }
    for (const auto u : {&Moments::r_u, &Moments::direct_u}) {
      EXPECT_NEAR(m[1].*u, m[0].*u, rounding) << light.name;
      EXPECT_NEAR(m[2].*u, -(m[0].*u), rounding) << light.name;
    }
    EXPECT_GT(std::abs(m[0].r_u), 1e-4);
  }
}

// The mean over all azimuths has the facets of isotropic distributions: slopes (sqrt(2) sigma r cos w, sqrt(2)
// sigma_cross r sin w) have an isotropic density in (r, w), so w is uniform.
TEST_P(SlopeOrders, MeanOverAzimuths_IsThatOfIsotropicSectors) {
  constexpr std::size_t kAzimuths = 10, kSectors = 16;  // errors of both means: the eccentricity 0.43 to these powers
  std::vector<SlopeShape> turned, sectors;
  for (std::size_t i = 0; i < kAzimuths; ++i) {
    turned.push_back(kBrushed);
    turned.back().azimuth_deg = 180.0 * static_cast<double>(i) / kAzimuths;
  }
  for (std::size_t i = 0; i < kSectors; ++i) {
    const double w = std::numbers::pi * (static_cast<double>(i) + 0.5) / kSectors;
    sectors.push_back({std::hypot(kBrushed.sigma * std::cos(w), kBrushed.sigma_cross * std::sin(w)), kBrushed.q});
  }
  for (const Light& light : kLights) {
    const auto mean = [&](const std::vector<SlopeShape>& shapes) {
      const MomentsRequest request = brushed_request(Distribution::kGaussian, light, shapes);
      Moments sum{.direct_i = 0.0, .direct_q = 0.0};
      for (const Moments& m : evaluator_->evaluate(request, {})) {
        for (const auto member : {&Moments::r_i, &Moments::r_q, &Moments::r_u, &Moments::albedo, &Moments::direct_i,
                                  &Moments::direct_q, &Moments::direct_u})
          sum.*member += m.*member / static_cast<double>(shapes.size());
      }
      return sum;
    };
    const Moments a = mean(turned), b = mean(sectors);
    EXPECT_NEAR(a.r_i, b.r_i, 2.0 * kTolerance * b.r_i) << light.name;
    EXPECT_NEAR(a.r_q, b.r_q, 2.0 * kTolerance * b.r_i) << light.name;
    EXPECT_NEAR(a.r_u, 0.0, 2.0 * kTolerance * b.r_i) << light.name;
    EXPECT_NEAR(a.albedo, b.albedo, 2.0 * kTolerance * b.albedo) << light.name;
    if (!light.is_direct) continue;
    EXPECT_NEAR(a.direct_i, b.direct_i, 2.0 * kTolerance * b.direct_i);
    EXPECT_NEAR(a.direct_q, b.direct_q, 2.0 * kTolerance * b.direct_i);
    EXPECT_NEAR(a.direct_u, 0.0, 2.0 * kTolerance * b.direct_i);
  }
}

TEST_P(SlopeOrders, PerfectReflector_ReflectsEverythingAtEveryAzimuth) {
  const double rounding = is_double(GetParam()) ? 1e-12 : 2e-6;
  const FacetOptics perfect{1e-9, 30.0};  // absorbs less than 1e-9 of the light
  MomentsRequest request = empty_request(Distribution::kGaussian, kLights[2]);
  for (const double azimuth_deg : {0.0, 25.0, 90.0, 140.0}) {
    SlopeShape shape = kBrushed;
    shape.azimuth_deg = azimuth_deg;
    request.append({70.0, shape, perfect});
  }
  const double c = cos_sin_deg(70.0).cos;
  for (const Moments& m : evaluator_->evaluate(request, {})) {
    EXPECT_NEAR(m.albedo, c, rounding);
    EXPECT_NEAR(m.r_i, c, m.r_i_error + rounding);
    EXPECT_LE(m.r_i_error, 2.0 * kTolerance * c);
    EXPECT_NEAR(m.r_q, 0.0, m.r_q_error + rounding);
    EXPECT_NEAR(m.r_u, 0.0, m.r_q_error + rounding);
  }
}

// The nodes resolve the high orders. With too few, the stated errors are 18 to 28 times the tolerance.
TEST_P(SlopeOrders, WidthsOfOneToThree_MeetTheTolerance) {
  for (const Distribution distribution : kBothDistributions) {
    for (const Light& light : {kLights[1], kLights[2]}) {
      MomentsRequest request = empty_request(distribution, light);
      request.append({50.0, {.sigma = 0.2, .q = 3.0, .sigma_cross = 0.6, .azimuth_deg = 30.0}, FacetOptics{1.6, 0.5}});
      const Moments m = evaluator_->evaluate(request, {}).front();
      EXPECT_LE(m.r_i_error, kTolerance * m.r_i) << light.name;
      EXPECT_LE(m.r_q_error, kTolerance * m.r_i) << light.name;
    }
  }
}

TEST_P(SlopeOrders, EvaluationsOfTheEntries_AddUpToThoseOfTheEvaluator) {
  MomentsRequest request = empty_request(Distribution::kGaussian, kLights[1]);
  for (const double theta_deg : {20.0, 50.0, 70.0})
    request.append({theta_deg, {.sigma = 0.01 * theta_deg, .q = 3.0, .sigma_cross = 0.3}, FacetOptics{1.6, 0.5}});
  double sum = 0.0;
  for (const Moments& m : evaluator_->evaluate(request, {})) sum += m.evaluations;
  EXPECT_NEAR(sum, evaluator_->report().evaluations, 1e-5 * sum);
}

TEST_P(SlopeOrders, Vacuum_ReflectsNothing) {
  for (const Light& light : kLights) {
    MomentsRequest request = empty_request(Distribution::kCauchy, light);
    request.append({70.0, kBrushed, FacetOptics{1.0, 0.0}});
    const Moments m = evaluator_->evaluate(request, {}).front();
    EXPECT_EQ(m.r_i, 0.0) << light.name;
    EXPECT_EQ(m.r_q, 0.0) << light.name;
    EXPECT_EQ(m.r_u, 0.0) << light.name;
    if (!light.is_direct) continue;
    EXPECT_NEAR(m.direct_i, cos_sin_deg(70.0).cos, m.direct_i_error);
    EXPECT_NEAR(m.direct_u, 0.0, m.direct_q_error);
  }
}

// Vulkan in double computes what the CPU computes in double, from the same source.
INSTANTIATE_TEST_SUITE_P(Kernels, SlopeOrders,
                         testing::Values(Kernel::kCpuFloat, Kernel::kCpuDouble, Kernel::kVulkanFloat),
                         [](const auto& test) { return to_name(test.param); });

}  // namespace
}  // namespace dolp::slope_orders_test
