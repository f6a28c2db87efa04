// The quotient r_q / r_i at 90 degrees, where r_q and r_i are infinite. The tests compare it with an integral, and with
// the kernel's quotient just below 90 degrees.
#include "run/closed_forms.hpp"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "scene_run_support.hpp"

namespace dolp::grazing_limit_test {
namespace {

using namespace scene_run_support;
using Real = long double;

constexpr std::array kQs = {1.0001, 1.1, 1.2, 1.3, 1.45, 1.5};
constexpr std::array kAllIndices = {
    OpticalConstants{1.508, 0.0}, OpticalConstants{1.0, 0.0},   OpticalConstants{1.0001, 0.0},
    OpticalConstants{2.0, 0.7},   OpticalConstants{27.0, 90.0}, OpticalConstants{1000.0, 1000.0},
    OpticalConstants{1e6, 1e6},   OpticalConstants{0.2, 3.0},   OpticalConstants{0.6, 0.0},
    OpticalConstants{0.6, 1e-4},  OpticalConstants{0.01, 0.0},  OpticalConstants{0.51444802339652151, 4.4e-12}};

// Accuracy of grazing_limit_moments(), as run/closed_forms.hpp states it.
constexpr double kRelativeAccuracy = 1e-12;
constexpr double kAlbedoAccuracy = 2e-15;
// Just below 90 degrees, the difference between r_q / r_i and its limit is a power series in cos(theta)^(3 - 2q). Its
// first term is at most 2 % of r_q / r_i at q = 1.3. Extrapolation removes this term, but not the second, which is
// about (2 %)^2.
constexpr double kExtrapolationAccuracy = 4e-4;

/// Ends of integration panels, whose widths halve toward both ends of [from, to].
std::vector<Real> graded_panels(Real from, Real to) {
  constexpr int kHalvings = 60;
  const Real middle = 0.5L * (from + to);
  std::vector<Real> ends = {from};
  for (int i = kHalvings; i > 0; --i) ends.push_back(from + (middle - from) * std::ldexp(1.0L, -i));
  ends.push_back(middle);
  for (int i = 1; i <= kHalvings; ++i) ends.push_back(to - (to - middle) * std::ldexp(1.0L, -i));
  ends.push_back(to);
  return ends;
}

/// Integral over phi from 0 to 90 degrees of cos(phi)^(4 - 2q) times `part`, a function of the reflectance at the angle
/// of incidence phi. The code integrates over psi = 90 degrees - phi. The panels get narrower where the integrand is
/// not smooth: toward psi = 0, psi = 90 degrees and the critical angle of total reflection.
Real integral(double q, const OpticalConstants& index, const std::function<Real(const SmoothReflectance&)>& part) {
  const Real quarter = 0.5L * std::numbers::pi_v<Real>;
  const Real squared = 1.0L - (Real(index.n) * index.n - Real(index.k) * index.k);
  std::vector<Real> ends = {0.0L, quarter};
  if (squared > 0.0L && squared < 1.0L) ends = {0.0L, std::asin(std::sqrt(squared)), quarter};
  Real sum = 0.0L;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const std::vector<Real> panels = graded_panels(ends[i], ends[i + 1]);
    for (std::size_t j = 0; j + 1 < panels.size(); ++j) {
      const auto integrand = [&](Real psi) {
        const Real x = std::sin(psi);
        return std::pow(x, 4.0L - 2.0L * Real(q)) * part(smooth_reflectance(index, x));
      };
      sum += boost::math::quadrature::gauss<Real, 30>::integrate(integrand, panels[j], panels[j + 1]);
    }
  }
  return sum;
}

TEST(GrazingLimit, TinyIndex_ReflectsAllButAsMuch) {
  for (const double n : {1e-8, 1e-9, 1e-10, 1e-16, 1e-75, 1e-100, 1e-300, 5e-324}) {
    for (const double k : {0.0, 1e-12, 1e-100, 5e-324}) {
      for (const double q : {1.0001, 1.3, 1.5}) {
        const Moments moments = grazing_limit_moments({n, k}, q);
        EXPECT_NEAR(moments.r_i, moments.albedo, 4.0 * n + kAlbedoAccuracy * moments.albedo)
            << n << " " << k << " " << q;
        EXPECT_NEAR(moments.r_q, 0.0, 4.0 * n + kAlbedoAccuracy * moments.albedo) << n << " " << k << " " << q;
      }
    }
  }
}

TEST(GrazingLimit_EveryIndex, AgreesWithAnotherQuadrature) {
  for (const OpticalConstants& index : kAllIndices) {
    for (const double q : kQs) {
      const Moments limit = grazing_limit_moments(index, q);
      const Real albedo = integral(q, index, [](const auto&) { return 1.0L; });
      const Real r_i = integral(q, index, [](const SmoothReflectance& r) { return 0.5L * (r.s + r.p); });
      // In this limit the visible facets are vertical and the view direction is horizontal. So the plane of incidence
      // on a facet is horizontal. Q refers to the vertical plane through the view direction. So Q changes its sign.
      const Real r_q = integral(q, index, [](const SmoothReflectance& r) { return -0.5L * (r.s - r.p); });
      const double bound = kRelativeAccuracy * limit.r_i + kAlbedoAccuracy * limit.albedo;
      EXPECT_NEAR(limit.albedo, static_cast<double>(albedo), kRelativeAccuracy * limit.albedo);
      EXPECT_NEAR(limit.r_i, static_cast<double>(r_i), bound) << index.n << " " << index.k << " q " << q;
      EXPECT_NEAR(limit.r_q, static_cast<double>(r_q), bound) << index.n << " " << index.k << " q " << q;
      EXPECT_GE(limit.r_i_error, std::abs(limit.r_i - static_cast<double>(r_i)));
      EXPECT_GE(limit.r_q_error, std::abs(limit.r_q - static_cast<double>(r_q)));
      EXPECT_EQ(limit.deficit, -limit.r_i);
    }
  }
}

/// r_q / r_i at `short_deg` degrees below 90 degrees. The kernel integrates both moments in double.
double quotient_before(Masking masking, const OpticalConstants& index, double q, double short_deg) {
  MomentsRequest request;
  request.masking = masking;
  request.tolerance = 1e-8;
  request.precision = Precision::kDouble;
  request.append({90.0 - short_deg, {0.3, q}, index});
  const Moments moments = CpuEvaluator().evaluate(request, {}).front();
  return moments.r_q / moments.r_i;
}

TEST(GrazingLimit_Quotient, IsWhatTheKernelTendsTo) {
  constexpr double kShort_deg = 1e-3;
  constexpr double kShorter_deg = 1e-4;
  for (const Masking masking : {Masking::kNone, Masking::kIntegral}) {
    for (const OpticalConstants& index : kIndices) {
      for (const double q : {1.1, 1.2, 1.3}) {
        const double far = quotient_before(masking, index, q, kShort_deg);
        const double near = quotient_before(masking, index, q, kShorter_deg);
        const double shrinks_by = std::pow(kShort_deg / kShorter_deg, 3.0 - 2.0 * q);
        const double extrapolated = near + (near - far) / (shrinks_by - 1.0);
        const Moments limit = grazing_limit_moments(index, q);
        const double quotient = limit.r_q / limit.r_i;
        EXPECT_NEAR(extrapolated, quotient, kExtrapolationAccuracy * std::abs(quotient))
            << to_name(masking) << " N " << index.n << " + " << index.k << "i q " << q;
      }
    }
  }
}

// With q <= 1.5 the grid requests no moments at 90 degrees.
TEST(GrazingLimit_InAGrid, IsWhatAPointGives) {
  for (const Masking masking : {Masking::kNone, Masking::kIntegral}) {
    for (const std::vector<double>& theta_deg : {std::vector{30.0, 90.0}, {90.0, 30.0}, {90.0}}) {
      SceneValues scene = make_scene(Distribution::kCauchy, masking, kDielectric);
      scene.grid = make_axes(theta_deg, {0.3}, {1.2, 1.5});
      CpuEvaluator cpu;
      const SceneEntries grid = grid_entries(scene);
      const std::vector<PointResult> table = evaluate_scene(scene, grid, cpu, {});
      const std::vector<PointResult> points = evaluate_scene(scene, SceneEntries(list_of(grid)), cpu, {});
      for (std::size_t i = 0; i < table.size(); ++i)
        EXPECT_NEAR(table[i][Quantity::kDolp], points[i][Quantity::kDolp], points[i][Quantity::kErrorEstimate])
            << to_name(masking) << " entry " << i;
    }
  }
}

// At grazing incidence the amplitudes of both sides of the film cancel exactly.
TEST(GrazingLimit_UnderAFilmWithoutThickness, IsThatOfTheMedium) {
  FacetOptics optics(1.0, 0.0);
  optics.films = {{{1.5, 0.01}, 0.0}};
  for (const double q : {1.2, 1.5}) EXPECT_EQ(grazing_limit_moments(optics, q).r_i, 0.0);
  optics.index = {1.5, 0.1};
  const Moments bare = grazing_limit_moments(OpticalConstants{1.5, 0.1}, 1.5),
                covered = grazing_limit_moments(optics, 1.5);
  EXPECT_NEAR(covered.r_i, bare.r_i, covered.r_i_error + bare.r_i_error);
}

// R_s = R_p falls in a straight line from 1 at normal incidence to 0 at 45 degrees, and rises back to 1. For q = 3/2
// the integrand is R(phi) cos(phi), so r_i = 1 + 4 (1 - sqrt 2) / pi.
TEST(GrazingLimit, RowsOfMeasuredReflectances_AreEndsOfThePanels) {
  FacetOptics optics;
  optics.measured = std::make_shared<const MeasuredReflectance>(
      MeasuredReflectance{{0.0, 45.0, 90.0}, {1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}});
  const Moments moments = grazing_limit_moments(optics, 1.5);
  EXPECT_NEAR(moments.r_i, 1.0 + 4.0 / std::numbers::pi * (1.0 - std::numbers::sqrt2), moments.r_i_error);
  EXPECT_LE(moments.r_i_error, 1e-11);
}

}  // namespace
}  // namespace dolp::grazing_limit_test
