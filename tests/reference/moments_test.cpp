// Moments by the reference, compared with exact results and with simpler quadratures.
#include "reference/moments.hpp"
#include "reference/reference_evaluator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <complex>
#include <dolp/errors.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "model/choices.hpp"
#include "reference/mueller.hpp"

namespace dolp::moments_test {
namespace {

using boost::math::quadrature::gauss_kronrod;
using std::numbers::pi;

constexpr double kRadPerDeg = pi / 180.0;
constexpr OpticalConstants kSteel{1.508, 0.0};
constexpr std::array kMaskings{Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};

Moments moments(Distribution distribution, Masking masking, double theta_deg, SlopeShape shape, OpticalConstants index,
                reference::Refinement options = {}) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.tolerance = 0.0;
  request.append({theta_deg, shape, index});
  return ReferenceEvaluator(options).evaluate(request, {}).at(0);
}

struct Reflectances {
  double s;
  double p;
};
// Fresnel reflectances of a smooth surface in textbook form, with Snell's law.
Reflectances fresnel_reflectances(OpticalConstants constants, double theta_deg) {
  const std::complex<double> n{constants.n, constants.k};
  const double cos_i = std::cos(theta_deg * kRadPerDeg);
  const std::complex<double> sin_t = std::sin(theta_deg * kRadPerDeg) / n;
  const std::complex<double> cos_t = std::sqrt(1.0 - sin_t * sin_t);
  return {std::norm((cos_i - n * cos_t) / (cos_i + n * cos_t)), std::norm((n * cos_i - cos_t) / (n * cos_i + cos_t))};
}

TEST(ReferenceMoments, Mirror_IsFresnelToRounding) {
  constexpr double kRounding = 1e-15;
  const OpticalConstants metal{27.0, 90.0};
  const Reflectances r = fresnel_reflectances(metal, 60.0);
  const Moments m = moments(Distribution::kCauchy, Masking::kSmith, 60.0, {0.0, 2.0}, metal);
  EXPECT_NEAR(m.r_i, 0.25 * (r.s + r.p), kRounding);
  EXPECT_NEAR(m.r_q, 0.25 * (r.s - r.p), kRounding);
  EXPECT_NEAR(m.deficit, 0.25 * (2.0 - r.s - r.p), kRounding);
  EXPECT_NEAR(m.albedo, 0.5, kRounding);
}

TEST(ReferenceMoments, SmithAlbedoAt60Degrees_MatchesTheModelDocument) {
  constexpr double kTwoDigits = 0.005;
  EXPECT_NEAR(moments(Distribution::kCauchy, Masking::kSmith, 60.0, {0.3, 2.0}, kSteel).albedo / 0.5, 0.74, kTwoDigits);
  EXPECT_NEAR(moments(Distribution::kCauchy, Masking::kSmith, 60.0, {0.905, 2.0}, kSteel).albedo / 0.5, 0.35,
              kTwoDigits);
}

TEST(ReferenceMoments, Grazing_IsTheLimit) {
  // Near 90 degrees the moments change about linearly with cos(theta). So the test allows a difference of
  // 100 cos(theta) between the moments at theta and at 90 degrees.
  constexpr double kOffset_deg = 1e-4;
  const double tolerance = 100.0 * kOffset_deg * kRadPerDeg;
  for (const Masking masking : kMaskings) {
    const Moments at = moments(Distribution::kCauchy, masking, 90.0, {0.3, 2.0}, kSteel);
    const Moments near = moments(Distribution::kCauchy, masking, 90.0 - kOffset_deg, {0.3, 2.0}, kSteel);
    EXPECT_NEAR(at.r_i, near.r_i, tolerance);
    EXPECT_NEAR(at.r_q, near.r_q, tolerance);
    EXPECT_EQ(at.deficit, -at.r_i);
    const bool is_dark = masking == Masking::kVCavity || masking == Masking::kSmith;
    EXPECT_EQ(at.r_i == 0.0, is_dark);
  }
}

TEST(ReferenceMoments, GrazingWithHeavyTails_DivergesBelowThreeHalves) {
  for (const Masking masking : {Masking::kNone, Masking::kIntegral}) {
    const Moments heavy = moments(Distribution::kCauchy, masking, 90.0, {0.3, 1.5}, kSteel);
    EXPECT_EQ(heavy.r_i, std::numeric_limits<double>::infinity());
    EXPECT_EQ(heavy.r_q, -std::numeric_limits<double>::infinity());
    // For q just above 3/2, r_i is nearly proportional to 1/(2q - 3). So half the distance from 3/2 doubles r_i.
    constexpr double kDistance = 1e-5;
    const double near = moments(Distribution::kCauchy, masking, 90.0, {0.3, 1.5 + kDistance}, kSteel).r_i;
    const double far = moments(Distribution::kCauchy, masking, 90.0, {0.3, 1.5 + 2.0 * kDistance}, kSteel).r_i;
    EXPECT_NEAR(near / far, 2.0, 100.0 * kDistance);
  }
  EXPECT_EQ(moments(Distribution::kCauchy, Masking::kVCavity, 90.0, {0.3, 1.2}, kSteel).r_i, 0.0);
}

// The azimuth Delta_phi at which v-cavity masking has a kink. There, with the angle of incidence beta on the facet,
// cos^2(beta) = (cos(theta_i) + cos(theta_r)) min(cos(theta_i), cos(theta_r)). If theta_r is 3 theta_i - 180 degrees or
// 60 + theta_i / 3 degrees, Delta_phi is 180 degrees. The test splits the integral over theta_r at these two zeniths.
double bend_deg(double theta_i_deg, double theta_r_deg) {
  const double c_i = std::cos(theta_i_deg * kRadPerDeg), c_r = std::cos(theta_r_deg * kRadPerDeg);
  const double sines = std::sin(theta_i_deg * kRadPerDeg) * std::sin(theta_r_deg * kRadPerDeg);
  const double cosine = (2.0 * (c_i + c_r) * std::min(c_i, c_r) - 1.0 - c_i * c_r) / sines;
  return std::acos(std::clamp(cosine, -1.0, 1.0)) / kRadPerDeg;
}

TEST(ReferenceMoments, PlainQuadratureOfTheMuellerMatrix_Agrees) {
  // Relative tolerances of the inner integral, over the azimuth, and of the outer integral, over the zenith.
  constexpr double kInner = 1e-6;
  constexpr double kOuter = 5e-6;
  constexpr unsigned kDepth = 8;
  constexpr double kTheta_deg = 65.0;
  const OpticalConstants index{1.6, 0.4};
  const reference::Slopes slopes(Distribution::kCauchy, {0.5, 1.8});
  for (const Masking masking : kMaskings) {
    const auto over_azimuth = [&](double theta_r_deg) {
      const auto elements = [&](double delta_phi_deg) {
        const auto f = reference::single_bounce(slopes, masking, index, {kTheta_deg, theta_r_deg, delta_phi_deg});
        return std::complex(f(0, 0), f(0, 1));
      };
      const double bend = bend_deg(kTheta_deg, theta_r_deg);
      std::complex<double> sum;
      for (const auto& [from, to] : {std::pair(0.0, bend), std::pair(bend, 180.0)}) {
        if (from < to) sum += gauss_kronrod<double, 21>::integrate(elements, from, to, kDepth, kInner);
      }
      return 2.0 * std::sin(theta_r_deg * kRadPerDeg) * sum;
    };
    constexpr std::array kEnds{0.0, 3.0 * kTheta_deg - 180.0, kTheta_deg, 60.0 + kTheta_deg / 3.0, 90.0};
    std::complex<double> sum;
    for (std::size_t i = 0; i + 1 < kEnds.size(); ++i) {
      sum += gauss_kronrod<double, 21>::integrate(over_azimuth, kEnds[i], kEnds[i + 1], kDepth, kOuter);
    }
    const std::complex<double> mean = sum * kRadPerDeg * kRadPerDeg;
    const Moments m = moments(Distribution::kCauchy, masking, kTheta_deg, {0.5, 1.8}, index);
    EXPECT_NEAR(m.r_i, mean.real(), (kInner + kOuter) * m.r_i) << to_name(masking);
    EXPECT_NEAR(m.r_q, mean.imag(), (kInner + kOuter) * m.r_i) << to_name(masking);
  }
}

// With v-cavity and smith masking rho has a limit at 90 degrees and is linear in cos(theta) just below 90 degrees. So
// rho lies on a line at three zeniths: gap_deg, 2 gap_deg and 4 gap_deg below 90 degrees. If the reference lost digits,
// the values would scatter.
TEST(ReferenceMoments, NextToGrazing_KeepTheirDigits) {
  constexpr double kTolerance = 1e-13;
  const reference::Refinement options{.relative_tolerance = kTolerance, .subdivisions = 2};
  for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
    for (const SlopeShape shape : {SlopeShape{0.3, 2.0}, SlopeShape{0.01, 3.0}}) {
      for (const double gap_deg : {1e-11, 1e-12}) {
        const auto rho = [&](double factor) {
          const double theta_deg = 90.0 - factor * gap_deg;
          const Moments m = moments(Distribution::kCauchy, masking, theta_deg, shape, kSteel, options);
          EXPECT_LE(m.r_i_error, 2.0 * kTolerance * m.r_i);
          return std::array{m.r_i / reference::zenith_from_deg(theta_deg).cos,
                            m.r_q / reference::zenith_from_deg(theta_deg).cos};
        };
        const auto far = rho(4.0);
        const auto middle = rho(2.0);
        const auto near = rho(1.0);
        for (const std::size_t k : {0U, 1U}) {
          EXPECT_NEAR(near[k] - middle[k], 0.5 * (middle[k] - far[k]), 2.0 * kTolerance * near[0])
              << "gap " << gap_deg << " sigma " << shape.sigma;
        }
      }
    }
  }
}

TEST(ReferenceEvaluator, SeveralEntries_KeepTheOrderOfTheRequest) {
  MomentsRequest request;
  request.masking = Masking::kSmith;
  request.append({70.0, {0.2, 2.0}, {27.0, 90.0}});
  request.append({10.0, {0.5, 3.0}, kSteel});
  request.append({70.0, {0.5, 3.0}, {27.0, 90.0}});
  request.append({10.0, {0.2, 2.0}, kSteel});
  ReferenceEvaluator evaluator;
  std::size_t told = 0;
  const std::vector<Moments> together = evaluator.evaluate(request, [&](std::size_t done, std::size_t total) {
    EXPECT_GT(done, told);
    EXPECT_EQ(total, 4U);
    told = done;
    return true;
  });
  EXPECT_EQ(told, 4U);
  ASSERT_EQ(together.size(), request.size());
  for (std::size_t i = 0; i < request.size(); ++i) {
    MomentsRequest one;
    one.masking = request.masking;
    one.append(request[i]);
    EXPECT_EQ(evaluator.evaluate(one, {}).at(0).r_i, together[i].r_i) << i;
  }
  EXPECT_EQ(evaluator.report().evaluator, "reference");
  EXPECT_EQ(evaluator.report().precision, "double");
  EXPECT_FALSE(evaluator.report().device.empty());
  EXPECT_GT(evaluator.report().evaluations, 0.0);
}

TEST(ReferenceEvaluator, OutsideTheDomain_ThrowsInputError) {
  const auto evaluate = [](Masking masking, double theta_deg, SlopeShape shape, OpticalConstants index) {
    return moments(Distribution::kCauchy, masking, theta_deg, shape, index);
  };
  EXPECT_THROW(evaluate(Masking::kSmith, 10.0, {0.2, 1.5}, kSteel), InputError);
  EXPECT_NO_THROW(evaluate(Masking::kSmith, 10.0, {0.2, 1.51}, kSteel));
  EXPECT_THROW(evaluate(Masking::kNone, 10.0, {0.2, 1.0}, kSteel), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, -1.0, {0.2, 2.0}, kSteel), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, 90.5, {0.2, 2.0}, kSteel), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, 10.0, {-0.2, 2.0}, kSteel), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, 10.0, {std::nan(""), 2.0}, kSteel), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, 10.0, {0.2, 2.0}, {0.0, 1.0}), InputError);
  EXPECT_THROW(evaluate(Masking::kNone, 10.0, {0.2, 2.0}, {1.5, -1.0}), InputError);
}

}  // namespace
}  // namespace dolp::moments_test
