// Slopes that differ along and across, in the reference: comparison with a plain sum over facets and with beams.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <numbers>
#include <vector>

#include "reference/fresnel.hpp"
#include "reference/moments.hpp"
#include "reference/reference_evaluator.hpp"
#include "reference/vectors.hpp"

namespace dolp::elliptic_slopes_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr SlopeShape kBrushed{.sigma = 0.2, .sigma_cross = 0.4, .azimuth_deg = 35.0};
const FacetOptics kOptics{3.0, 4.0};

Moments reference_moments(Masking masking, double theta_deg, const SlopeShape& shape) {
  MomentsRequest request;
  request.distribution = Distribution::kGaussian;
  request.masking = masking;
  request.wants_direct = masking == Masking::kVCavity;
  request.append({theta_deg, shape, kOptics});
  return ReferenceEvaluator({.relative_tolerance = 1e-7}).evaluate(request, {}).front();
}

/// Adds the light of one facet. `weight`: projected area of the facets toward the viewer, per horizontal area.
void add_facet(Moments& sum, Masking masking, double theta, const reference::Vector<double>& normal, double weight) {
  const reference::Vector<double> view{std::sin(theta), 0.0, std::cos(theta)};
  const reference::Vector<double> s{0.0, -1.0, 0.0}, p = view.cross(s);
  const double cos_beta = view.dot(normal);
  if (cos_beta <= 0.0) return;
  const reference::Vector<double> facet_s = view.cross(normal).normalized();
  const auto r = reference::fresnel(kOptics, cos_beta);
  const double half = 0.5 * (std::norm(r.r_s) - std::norm(r.r_p)), mean = 0.5 * (std::norm(r.r_s) + std::norm(r.r_p));
  const double chi = std::atan2(facet_s.dot(p), facet_s.dot(s));
  const double seen = weight * std::min(1.0, 2.0 * normal[2] * view[2] / cos_beta);
  sum.direct_i += seen * (1.0 - mean);
  sum.direct_q -= seen * half * std::cos(2.0 * chi);
  sum.direct_u -= seen * half * std::sin(2.0 * chi);
  const double cos_r = 2.0 * cos_beta * normal[2] - view[2];
  if (cos_r <= 0.0) return;
  const double g =
      masking == Masking::kNone ? 1.0 : std::min(1.0, 2.0 * normal[2] * std::min(view[2], cos_r) / cos_beta);
  sum.albedo += weight * g;
  sum.r_i += weight * g * mean;
  sum.r_q += weight * g * half * std::cos(2.0 * chi);
  sum.r_u += weight * g * half * std::sin(2.0 * chi);
}

/// A sum over a grid of slopes, in all quadrants, for gaussian slopes.
Moments summed_facets(Masking masking, double theta_deg, const SlopeShape& shape) {
  constexpr int kSteps = 800;
  constexpr double kReach = 5.0;  // in units of sqrt(2) sigma; 1e-11 of the facets are steeper
  const double theta = theta_deg * kDegree, azimuth = shape.azimuth_deg * kDegree;
  const double step = 2.0 * kReach / kSteps;
  Moments sum{.direct_i = 0.0, .direct_q = 0.0};
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double a = (i + 0.5) * step - kReach, b = (j + 0.5) * step - kReach;
      const double along = std::sqrt(2.0) * shape.sigma * a, across = std::sqrt(2.0) * shape.sigma_cross * b;
      const double x = along * std::cos(azimuth) - across * std::sin(azimuth);
      const double y = along * std::sin(azimuth) + across * std::cos(azimuth);
      const double cos_alpha = 1.0 / std::sqrt(1.0 + x * x + y * y);
      const double share = std::exp(-a * a - b * b) / pi * step * step;
      const double weight = share * (std::cos(theta) + std::sin(theta) * x);
      add_facet(sum, masking, theta, {x * cos_alpha, y * cos_alpha, cos_alpha}, weight);
    }
  }
  return sum;
}

TEST(ReferenceElliptic, Moments_AreASumOverFacets) {
  // Without masking the integrand jumps at the horizon. There the grid is wrong by a part of one step of 0.0125 in
  // units of the width. Largest differences: 2.1e-5 without masking, 1.3e-7 with it.
  constexpr double kGridError = 4e-5;
  for (const Masking masking : {Masking::kNone, Masking::kVCavity}) {
    for (const double theta_deg : {40.0, 75.0}) {
      const Moments sum = summed_facets(masking, theta_deg, kBrushed);
      const Moments own = reference_moments(masking, theta_deg, kBrushed);
      std::vector<double Moments::*> members = {&Moments::r_i, &Moments::r_q, &Moments::r_u, &Moments::albedo};
      if (masking == Masking::kVCavity)
        members.insert(members.end(), {&Moments::direct_i, &Moments::direct_q, &Moments::direct_u});
      for (const auto member : members) EXPECT_NEAR(own.*member, sum.*member, kGridError) << theta_deg;
      EXPECT_GT(std::abs(own.r_u), 10.0 * kGridError);
    }
  }
}

// The beams of all sources, each with the azimuth of the surface that the viewer sees, add up to the moments.
TEST(ReferenceElliptic, Moments_AreASumOverBeams) {
  constexpr int kZeniths = 30;
  constexpr double kBeamSumError = 2e-4;  // the midpoint rule with steps of 3 degrees; largest difference: 1.3e-4
  const double theta_deg = 50.0;
  ScatteringRequest request;
  request.distribution = Distribution::kGaussian;
  request.masking = Masking::kVCavity;
  request.shapes = {kBrushed};
  request.optics = {kOptics};
  std::vector<double> solid_angles;
  const double step = 90.0 / kZeniths;
  for (int i = 0; i < kZeniths; ++i) {
    for (int j = 0; j < 4 * kZeniths; ++j) {
      const double theta_i_deg = (i + 0.5) * step;
      request.entries.push_back({static_cast<std::uint32_t>(request.angles.size()), 0, 0});
      request.angles.push_back({theta_i_deg, theta_deg, (j + 0.5) * step - 180.0});
      solid_angles.push_back(std::sin(theta_i_deg * kDegree) * step * kDegree * step * kDegree);
    }
  }
  const std::vector<ScatteringMatrix> beams = ReferenceEvaluator().scatter(request, {});
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < beams.size(); ++i) {
    for (std::size_t row = 0; row < sums.size(); ++row) sums[row] += solid_angles[i] * beams[i].m[4 * row];
  }
  const Moments own = reference_moments(Masking::kVCavity, theta_deg, kBrushed);
  EXPECT_NEAR(own.r_i, sums[0], kBeamSumError);
  EXPECT_NEAR(own.r_q, sums[1], kBeamSumError);
  EXPECT_NEAR(own.r_u, sums[2], kBeamSumError);
  EXPECT_GT(std::abs(own.r_u), 10.0 * kBeamSumError);
}

// Direct emission of the sea with smith masking: N = 1.18 + 0.07i, winds of 10 and 15 m/s.
TEST(ReferenceElliptic, Sea_EmitsDifferentlyUpwindAndCrosswind) {
  struct Row {
    double wind, theta_deg, azimuth_deg, q, u;  // Q/I and U/I in %
  };
  const std::vector<Row> rows = {
      {10.0, 75.0, 0.0, -4.898, 0.0}, {10.0, 75.0, 45.0, -5.044, 0.110}, {10.0, 75.0, 90.0, -5.206, 0.0},
      {10.0, 82.0, 0.0, -6.154, 0.0}, {10.0, 82.0, 45.0, -6.390, 0.265}, {10.0, 82.0, 90.0, -6.668, 0.0},
      {15.0, 82.0, 0.0, -5.345, 0.0}, {15.0, 82.0, 45.0, -5.597, 0.329}, {15.0, 82.0, 90.0, -5.906, 0.0}};
  for (const Row& row : rows) {
    const SlopeShape shape{.sigma = std::sqrt(0.00316 * row.wind),
                           .sigma_cross = std::sqrt(0.003 + 0.00192 * row.wind),
                           .azimuth_deg = row.azimuth_deg};
    const Moments m = reference::direct_emission({Distribution::kGaussian, shape}, Masking::kSmith, row.theta_deg,
                                                 FacetOptics{1.18, 0.07}, {.relative_tolerance = 1e-8});
    EXPECT_NEAR(100.0 * m.direct_q / m.direct_i, row.q, 0.51e-3) << row.wind << " " << row.azimuth_deg;
    EXPECT_NEAR(100.0 * m.direct_u / m.direct_i, row.u, 0.51e-3) << row.wind << " " << row.azimuth_deg;
  }
}

TEST(ReferenceElliptic, MaskingOfTheDistribution_ThrowsInputError) {
  for (const Masking masking : {Masking::kSmith, Masking::kIntegral}) {
    EXPECT_THROW(reference_moments(masking, 60.0, kBrushed), InputError);
    ScatteringRequest request;
    request.masking = masking;
    request.shapes = {kBrushed};
    EXPECT_THROW(ReferenceEvaluator().scatter(request, {}), InputError);
  }
}

}  // namespace
}  // namespace dolp::elliptic_slopes_test
