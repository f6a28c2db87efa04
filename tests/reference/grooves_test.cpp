// All bounces in V-grooves, and direct emission. Compared with exact results, counted rays and simpler quadratures.
#include "reference/moments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>
#include <iostream>
#include <numbers>
#include <vector>

#include "reference/fresnel.hpp"
#include "reference/groove_beam.hpp"
#include "reference/mueller.hpp"
#include "reference/reference_evaluator.hpp"
#include "reference/slopes.hpp"

namespace dolp::grooves_test {
namespace {

using boost::math::quadrature::gauss_kronrod;
using reference::zenith_from_deg;
using std::numbers::pi;

constexpr double kRadPerDeg = pi / 180.0;
constexpr auto kCauchy = Distribution::kCauchy;
constexpr auto kGaussian = Distribution::kGaussian;
constexpr OpticalConstants kPaint{1.5, 0.0};
constexpr OpticalConstants kMetal{27.0, 90.0};
constexpr OpticalConstants kInfraredMetal{10.0, 60.0};

struct Point {
  Distribution distribution;
  double theta_deg;
  SlopeShape shape;
  OpticalConstants index;
};

Moments moments(const Point& point, Scattering scattering, Masking masking = Masking::kVCavity,
                reference::Refinement options = {}) {
  MomentsRequest request;
  request.distribution = point.distribution;
  request.masking = masking;
  request.scattering = scattering;
  request.wants_direct = true;
  request.tolerance = 0.0;
  request.append({point.theta_deg, point.shape, point.index});
  return ReferenceEvaluator(options).evaluate(request, {}).at(0);
}

Moments all_bounces(const Point& point, reference::Refinement options = {}) {
  return moments(point, Scattering::kMultiple, Masking::kVCavity, options);
}

TEST(ReferenceGrooves, PublishedValues_AreReached) {
  struct Row {
    Point point;
    double rho_i, rho_q, unit;  // unit: unit of the last digit of the published values
  };
  const std::vector<Row> rows{{{kCauchy, 0.0, {0.3, 2.0}, kPaint}, 0.0321166, 0.0, 1e-7},
                              {{kCauchy, 60.0, {0.3, 2.0}, kPaint}, 0.0652161, 0.0396415, 1e-7},
                              {{kGaussian, 60.0, {0.2, 2.0}, kInfraredMetal}, 0.9843616, 0.0079579, 1e-7},
                              {{kCauchy, 80.0, {0.5, 3.0}, {26.0, 90.0}}, 0.97526, 0.01232, 1e-5},
                              {{kGaussian, 85.0, {0.1, 2.0}, {1.3, 0.05}}, 0.398024, 0.091648, 1e-6}};
  for (const Row& row : rows) {
    const Moments m = all_bounces(row.point, {.relative_tolerance = 1e-8});
    const double cos_theta = zenith_from_deg(row.point.theta_deg).cos;
    EXPECT_NEAR(m.r_i / cos_theta, row.rho_i, 0.6 * row.unit) << row.point.theta_deg;
    EXPECT_NEAR(m.r_q / cos_theta, row.rho_q, 0.6 * row.unit) << row.point.theta_deg;
    EXPECT_LE(m.r_i_error, 1e-7 * m.r_i);
    EXPECT_LE(m.deficit_error, 1e-7 * m.deficit);
  }
}

TEST(ReferenceGrooves, Albedo_IsOne_AndNothingIsLost) {
  constexpr double kRounding = 1e-12;
  const std::vector<Point> points{{kCauchy, 0.0, {0.3, 2.0}, kPaint},    {kCauchy, 60.0, {0.3, 2.0}, kPaint},
                                  {kGaussian, 60.0, {0.3, 2.0}, kMetal}, {kCauchy, 60.0, {5.0, 2.0}, kPaint},
                                  {kCauchy, 89.9, {0.3, 2.0}, kPaint},   {kCauchy, 60.0, {0.3, 1.001}, kPaint},
                                  {kCauchy, 60.0, {10.0, 2.0}, {3, 1}},  {kCauchy, 90.0 - 1e-9, {0.3, 1.6}, kPaint}};
  for (const Point& point : points) {
    const Moments m = all_bounces(point, {.relative_tolerance = 1e-5});
    const double cos_theta = zenith_from_deg(point.theta_deg).cos;
    EXPECT_NEAR(m.albedo / cos_theta, 1.0, kRounding) << point.theta_deg << " " << point.shape.q;
    EXPECT_NEAR((m.r_i + m.deficit) / cos_theta, 1.0, kRounding) << point.theta_deg << " " << point.shape.q;
    EXPECT_GT(m.r_i, 0.0);
    EXPECT_GT(m.deficit, 0.0);
    EXPECT_LE(m.r_i_error, 1e-4 * m.r_i) << point.theta_deg << " " << point.shape.q;
  }
}

// Share of the rays that bounce 0, 1, 2, ... times in a groove, found by following each ray from facet to facet.
std::vector<double> counted_shares(double alpha, const reference::Vector<double>& omega, int rays) {
  std::vector<double> shares(40);
  const double c = std::cos(alpha), s = std::sin(alpha);
  for (int i = 0; i < rays; ++i) {
    double x = c * (2.0 * (i + 0.5) / rays - 1.0), z = s, dx = -omega[0], dz = -omega[2];
    std::size_t bounces = 0;
    for (bool is_inside = true; is_inside;) {
      double nearest = 1e300, side_hit = 0.0;
      for (const double side : {-1.0, 1.0}) {  // facet from (0, 0) to (side c, s) with the normal (-side s, c)
        const double falls = -(dx * -side * s + dz * c);
        const double tau = (x * -side * s + z * c) / falls;
        const double along = (x + tau * dx) * side * c + (z + tau * dz) * s;
        if (falls > 0.0 && tau > 1e-12 && tau < nearest && along <= 1.0) nearest = tau, side_hit = side;
      }
      is_inside = side_hit != 0.0;
      if (!is_inside) break;
      x += nearest * dx, z += nearest * dz;
      const double across = 2.0 * (dx * -side_hit * s + dz * c);
      dx -= across * -side_hit * s, dz -= across * c;
      ++bounces;
    }
    shares.at(bounces) += 1.0 / rays;
  }
  return shares;
}

TEST(GrooveBeam, Fluxes_MatchCountedRays) {
  constexpr int kRays = 20000;
  // After k bounces at most two beams leave: one hit facet A first, the other hit facet B first. The number of rays
  // that are counted in a beam is wrong by at most 1. So the error for both beams is at most 2, and 3 leaves a margin.
  constexpr double kTolerance = 3.0 / kRays;
  for (const double alpha_deg : {10.0, 35.0, 60.0, 80.0, 85.0}) {
    for (const double theta_deg : {0.0, 20.0, 55.0, 80.0, 89.0}) {
      for (const double phi_deg : {0.0, 40.0, 89.0, 130.0}) {
        const double alpha = alpha_deg * kRadPerDeg, theta = theta_deg * kRadPerDeg, phi = phi_deg * kRadPerDeg;
        const reference::Vector<double> omega{std::sin(theta) * std::cos(phi), -std::sin(theta) * std::sin(phi),
                                              std::cos(theta)};
        const std::vector<double> counted = counted_shares(alpha, omega, kRays);
        std::vector<double> shares(counted.size());
        for (const auto first : {reference::Facet::kA, reference::Facet::kB}) {
          reference::GrooveBeam<double> beam({std::cos(alpha), std::sin(alpha)}, omega, first);
          for (std::size_t k = 1; beam.flux() > 0.0; ++k) {
            const auto b = reference::bounce<double>(beam.direction(), beam.normal(), {0, 1, 0});
            shares.at(k) += beam.reflect(b.k_out) / (2.0 * std::cos(alpha) * std::cos(theta));
          }
        }
        for (std::size_t k = 0; k < shares.size(); ++k) {
          EXPECT_NEAR(shares[k], counted[k], kTolerance) << alpha_deg << " " << theta_deg << " " << phi_deg << " " << k;
        }
      }
    }
  }
}

TEST(ReferenceGrooves, Grazing_HasALimit) {
  const Point at_90{kCauchy, 90.0, {0.3, 2.0}, kPaint};
  const Moments zero = all_bounces(at_90);
  for (const double value : {zero.r_i, zero.r_q, zero.albedo, zero.deficit, zero.direct_i}) EXPECT_EQ(value, 0.0);
  const auto rho = [&](double gap_deg) {
    const Moments m = all_bounces({kCauchy, 90.0 - gap_deg, {0.3, 2.0}, kPaint}, {.relative_tolerance = 1e-8});
    const double cos_theta = zenith_from_deg(90.0 - gap_deg).cos;
    return std::array{m.r_i / cos_theta, m.r_q / cos_theta, m.direct_i / cos_theta};
  };
  const auto near = rho(1e-9), nearer = rho(1e-12);
  for (std::size_t k = 0; k < near.size(); ++k) EXPECT_NEAR(near[k], nearer[k], 1e-7);
}

TEST(ReferenceGrooves, CoarseQuadrature_StaysWithinItsErrors) {
  const std::vector<Point> points{{kCauchy, 60.0, {0.3, 2.0}, kMetal},
                                  {kCauchy, 60.0, {0.3, 2.0}, {0.5, 0.0}},
                                  {kCauchy, 47.5, {1.35, 1.45}, {2.8, 0.0}},
                                  {kCauchy, 89.9, {0.3, 2.0}, kPaint},
                                  {kCauchy, 20.0, {0.01, 1.001}, {4.0, 1.0}}};
  double worst = 0.0;
  for (const Point& point : points) {
    const Moments coarse = all_bounces(point, {.relative_tolerance = 1e-3});
    const Moments fine = all_bounces(point, {.relative_tolerance = 1e-5});
    for (const auto& [value, error] : kMomentMembers) {
      const double distance = std::abs(coarse.*value - fine.*value), bound = coarse.*error + fine.*error;
      EXPECT_LE(distance, bound) << point.theta_deg << " " << point.shape.q << " " << point.index.n;
      worst = std::max(worst, distance / bound);
    }
  }
  std::cout << "largest distance over error: " << worst << "\n";
}

TEST(ReferenceDirect, BracketsTheEmission) {
  for (const Point& point : {Point{kCauchy, 60.0, {0.3, 2.0}, kPaint}, Point{kGaussian, 75.0, {0.6, 2.0}, kMetal},
                             Point{kCauchy, 10.0, {1.5, 1.2}, {0.5, 0.0}}}) {
    const Moments multiple = all_bounces(point, {.relative_tolerance = 1e-6});
    const Moments single = moments(point, Scattering::kSingle, Masking::kVCavity, {.relative_tolerance = 1e-6});
    EXPECT_EQ(multiple.direct_i, single.direct_i);
    EXPECT_LT(0.0, multiple.direct_i);
    EXPECT_LT(multiple.direct_i, multiple.deficit);
    EXPECT_LT(multiple.deficit, single.deficit);
    // Light that leaves after further bounces is at most fully polarised: its |Q| does not exceed its I.
    EXPECT_LE(std::abs(-multiple.r_q - multiple.direct_q), multiple.deficit - multiple.direct_i);
  }
}

TEST(ReferenceDirect, Vacuum_EmitsAll) {
  constexpr double kTolerance = 1e-9;
  for (const Masking masking : {Masking::kSmith, Masking::kVCavity}) {
    for (const double theta_deg : {0.0, 1e-6, 60.0, 89.99}) {
      for (const SlopeShape shape : {SlopeShape{0.3, 2.0}, SlopeShape{5.0, 1.51}, SlopeShape{1e-3, 50.0}}) {
        const Moments m = moments({kCauchy, theta_deg, shape, {1.0, 0.0}}, Scattering::kSingle, masking,
                                  {.relative_tolerance = kTolerance});
        const double cos_theta = zenith_from_deg(theta_deg).cos;
        EXPECT_NEAR(m.direct_i / cos_theta, 1.0, kTolerance) << theta_deg << " " << shape.q;
        EXPECT_LE(std::abs(m.direct_q), 1e-15 * cos_theta);
      }
    }
  }
}

// Integrates over the facet normals in spherical coordinates around the direction of the view. The polar angle is the
// angle of incidence beta, the azimuth is eta. The reference integrates over the slopes and azimuths of the facets.
TEST(ReferenceDirect, PlainQuadratureAroundTheView_Agrees) {
  constexpr double kPlainTolerance = 1e-6;
  constexpr unsigned kDepth = 9;
  constexpr double kTheta = 65.0 * kRadPerDeg;
  const OpticalConstants index{1.6, 0.4};
  const reference::Slopes slopes(kCauchy, {0.5, 2.5});
  for (const Masking masking : {Masking::kSmith, Masking::kVCavity}) {
    const double smith = 1.0 / (1.0 + reference::smith_lambda(slopes, zenith_from_deg(65.0)));
    const auto over_beta = [&](double beta, bool is_q) {
      const auto at_eta = [&](double eta) {
        const double cos_alpha = std::cos(kTheta) * std::cos(beta) + std::sin(kTheta) * std::sin(beta) * std::cos(eta);
        if (cos_alpha <= 1e-6) return 0.0;
        const double g =
            masking == Masking::kSmith ? smith : std::min(1.0, 2.0 * cos_alpha * std::cos(kTheta) / std::cos(beta));
        const double density = slopes.facet_density(1.0 / (cos_alpha * cos_alpha) - 1.0);
        return 2.0 * density * g * (is_q ? std::cos(2.0 * eta) : 1.0);
      };
      const double mean = gauss_kronrod<double, 21>::integrate(at_eta, 0.0, pi, kDepth, kPlainTolerance);
      const auto r = reference::fresnel(index, std::cos(beta));
      const double absorbed = 0.5 * (is_q ? r.absorbed_s - r.absorbed_p : r.absorbed_s + r.absorbed_p);
      return mean * absorbed * std::cos(beta) * std::sin(beta);
    };
    const auto total = [&](bool is_q) {
      const auto integrand = [&](double beta) { return over_beta(beta, is_q); };
      return gauss_kronrod<double, 21>::integrate(integrand, 0.0, 0.5 * pi, kDepth, kPlainTolerance);
    };
    const Moments m = moments({kCauchy, 65.0, {0.5, 2.5}, index}, Scattering::kSingle, masking);
    EXPECT_NEAR(m.direct_i, total(false), 20.0 * kPlainTolerance * m.direct_i);
    EXPECT_NEAR(m.direct_q, total(true), 20.0 * kPlainTolerance * m.direct_i);
  }
}

TEST(ReferenceGrooves, OutsideTheDomain_ThrowsInputError) {
  const Point point{kCauchy, 60.0, {0.3, 2.0}, kPaint};
  EXPECT_THROW(moments(point, Scattering::kMultiple, Masking::kSmith), InputError);
  EXPECT_THROW(moments(point, Scattering::kSingle, Masking::kIntegral), InputError);
  EXPECT_THROW(moments(point, Scattering::kSingle, Masking::kNone), InputError);
  ScatteringRequest request;
  request.scattering = Scattering::kMultiple;
  EXPECT_THROW(ReferenceEvaluator().scatter(request, {}), InputError);
}

}  // namespace
}  // namespace dolp::grooves_test
