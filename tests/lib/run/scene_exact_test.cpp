// For q = 2, whole runs give the moments of GGX surfaces, as shaders/physics/README.md says in section 6.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "scene_run_support.hpp"

namespace dolp::scene_exact_test {
namespace {

using namespace scene_run_support;

// This tolerance exceeds the error of the independent integral (180 x 180 Gauss points) if sigma is 0.3 or more.
constexpr double kGgxAccuracy = 1e-9;

double radians(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }

/// Integral of `f` from 0 to `to` by a composite Gauss rule.
template <class Function>
double composite_gauss(double to, Function&& f) {
  constexpr int kPanels = 6;
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    sum += boost::math::quadrature::gauss<double, 30>::integrate(f, to * i / kPanels, to * (i + 1) / kPanels);
  }
  return sum;
}

struct GgxMoments {
  double rho_i = 0.0;
  double rho_q = 0.0;
  double albedo = 0.0;
};

/// Integrand of the moments of a GGX surface, over the direction (theta_r, phi) of the reflected ray. For `albedo` the
/// reflectance is 1. Source: Walter et al. 2007, eq. (33); Heitz 2014, eqs. (72), (99).
GgxMoments ggx_terms(double alpha_g, Masking masking, const OpticalConstants& index, double theta, double theta_r,
                     double phi) {
  const double a2 = alpha_g * alpha_g;
  const double c_i = std::cos(theta);
  const double c_r = std::cos(theta_r);
  const double cos_2_beta = c_i * c_r + std::sin(theta) * std::sin(theta_r) * std::cos(phi);
  const double cos_beta = std::sqrt(0.5 * (1.0 + cos_2_beta));
  const double cos_alpha = (c_i + c_r) / (2.0 * cos_beta);
  const double root = cos_alpha * cos_alpha * (a2 - 1.0) + 1.0;
  const double density = a2 / (std::numbers::pi * root * root);
  const auto lambda = [a2](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - c * c) / (c * c)) - 1.0); };
  const double masked = masking == Masking::kSmith ? 1.0 / (1.0 + lambda(c_i) + lambda(c_r)) : 1.0;
  const SmoothReflectance smooth = smooth_reflectance(index, cos_beta);
  const double cos_eta = (cos_alpha - c_i * cos_beta) / (std::sin(theta) * std::sqrt(0.5 * (1.0 - cos_2_beta)));
  const double term = density * masked / (4.0 * c_i);
  return {term * smooth.rho_i(), term * smooth.rho_q() * (2.0 * cos_eta * cos_eta - 1.0), term};
}

GgxMoments ggx_moments(double alpha_g, Masking masking, const OpticalConstants& index, double theta_deg) {
  const auto integral = [&](double GgxMoments::*part) {
    return 2.0 * composite_gauss(0.5 * std::numbers::pi, [&](double theta_r) {
             return std::sin(theta_r) * composite_gauss(std::numbers::pi, [&](double phi) {
                      return ggx_terms(alpha_g, masking, index, radians(theta_deg), theta_r, phi).*part;
                    });
           });
  };
  return {integral(&GgxMoments::rho_i), integral(&GgxMoments::rho_q), integral(&GgxMoments::albedo)};
}

TEST(SceneExact_QOfTwo, IsGgx) {
  constexpr double kSigma = 0.4;
  for (const Masking masking : {Masking::kNone, Masking::kSmith}) {
    for (const OpticalConstants& index : {kDielectric, kAbsorbing, kMetal}) {
      for (const double theta_deg : {3.0, 45.0, 75.0}) {
        const GgxMoments ggx = ggx_moments(std::sqrt(2.0) * kSigma, masking, index, theta_deg);
        for (const Evaluator evaluator : {Evaluator::kFloat, Evaluator::kDouble, Evaluator::kReference}) {
          const SceneValues scene = make_scene(Distribution::kCauchy, masking, index);
          const PointResult r = run_one(scene, theta_deg, {kSigma, 2.0}, evaluator);
          const double bound = (r[Quantity::kRhoErrorEstimate] + kGgxAccuracy) * ggx.rho_i;
          EXPECT_LE(r[Quantity::kRhoErrorEstimate], scene.accuracy.tolerance);
          EXPECT_NEAR(r[Quantity::kRhoI], ggx.rho_i, bound) << to_name(masking) << " " << theta_deg;
          EXPECT_NEAR(r[Quantity::kRhoQ], ggx.rho_q, bound) << to_name(masking) << " " << theta_deg;
          EXPECT_NEAR(r[Quantity::kAlbedo], ggx.albedo, scene.accuracy.tolerance * ggx.albedo);
        }
      }
    }
  }
}

}  // namespace
}  // namespace dolp::scene_exact_test
