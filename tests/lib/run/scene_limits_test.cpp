// Results and status of runs at limits: 90 degrees, normal incidence, extreme slopes, metals, and rounding.
#include <gtest/gtest.h>

#include <cmath>

#include <dolp/status.hpp>
#include "scene_run_support.hpp"

namespace dolp::scene_limits_test {
namespace {

using namespace scene_run_support;

constexpr SlopeShape kPaperShape{0.3, 2.0};
// The manual states the limits at 90 degrees with four digits.
constexpr double kFourDigits = 5e-5;

bool has_limit(Masking masking) { return masking == Masking::kVCavity || masking == Masking::kSmith; }

TEST(Limits_RightAngle, VCavityAndSmithHaveTheDocumentedReflectance) {
  for (const Evaluator evaluator : kPrecisions) {
    const SceneValues v_cavity = make_scene(Distribution::kCauchy, Masking::kVCavity, kDielectric);
    EXPECT_NEAR(run_one(v_cavity, 90.0, kPaperShape, evaluator)[Quantity::kRhoI], 0.3717, kFourDigits);
    const SceneValues smith = make_scene(Distribution::kCauchy, Masking::kSmith, kDielectric);
    EXPECT_NEAR(run_one(smith, 90.0, kPaperShape, evaluator)[Quantity::kRhoI], 0.1538, kFourDigits);
  }
}

TEST(Limits_RightAngle, DivergingReflectanceLeavesOnlyTheDolp) {
  for_each_model([](Distribution distribution, Masking masking) {
    for (const double diffuse : {0.0, 0.1}) {
      if (has_limit(masking) && diffuse == 0.0) continue;
      for (const double q : {1.2, 1.5, 2.0}) {
        if (masking == Masking::kSmith && q <= 1.5) continue;
        SceneValues scene = make_scene(distribution, masking, kDielectric);
        scene.surface.diffuse = diffuse;
        for (const Evaluator evaluator : kPrecisions) {
          const PointResult r = run_one(scene, 90.0, {0.3, q}, evaluator);
          const std::string name = text_of(scene, {90.0, {0.3, q}, {}});
          EXPECT_TRUE(std::isnan(r[Quantity::kRhoI]) && std::isnan(r[Quantity::kRhoQ]) &&
                      std::isnan(r[Quantity::kStokesI]))
              << name;
          EXPECT_TRUE(std::isnan(r[Quantity::kStokesQ]) && std::isnan(r[Quantity::kStokesU]) &&
                      std::isnan(r[Quantity::kStokesV]))
              << name;
          const std::uint32_t missed = r.status & kAnyToleranceNotMet;
          EXPECT_EQ(r.status ^ missed, kReflectanceOutsideZeroToOne | kOutsideModelDomain) << name;
          EXPECT_EQ(missed != 0, !(r[Quantity::kErrorEstimate] <= scene.accuracy.tolerance)) << name;
          EXPECT_TRUE(r[Quantity::kDolp] >= 0.0 && r[Quantity::kDolp] <= 1.0) << name << " " << r[Quantity::kDolp];
          EXPECT_LE(r[Quantity::kErrorEstimate], 10.0 * scene.accuracy.tolerance) << name;
        }
      }
    }
  });
}

TEST(Limits_RightAngle, DivergingDiffusePartOfAFlatPatternDoesNotCount) {
  SceneValues scene = make_scene(Distribution::kCauchy, Masking::kSmith, kDielectric);
  scene.surface.diffuse = 0.1;
  scene.surface.diffuse_exponent = 0.0;
  const PointResult r = run_one(scene, 90.0, kPaperShape, Evaluator::kDouble);
  EXPECT_EQ(r.status, 0U);
  EXPECT_NEAR(r[Quantity::kRhoI], 0.1538 + 0.1, kFourDigits);
}

TEST(Limits_RightAngle, MirrorReflectsAllWithoutPolarisation) {
  for_each_model([](Distribution distribution, Masking masking) {
    for (const OpticalConstants& index : {kDielectric, kMetal, OpticalConstants{1e6, 1e6}}) {
      const SceneValues scene = make_scene(distribution, masking, index);
      const PointResult r = run_one(scene, 90.0, {0.0, 2.0}, Evaluator::kFloat);
      EXPECT_EQ(r[Quantity::kRhoI], 1.0);
      EXPECT_EQ(r.status, 0U);
      EXPECT_LT(r[Quantity::kDolp], 1e-90);
    }
  });
}

TEST(Limits_RightAngle, MirrorsOwnEmissionHasThePolarisationOfItsLimit) {
  // A smooth surface of index N has the emissivities 1 - R_s and 1 - R_p. For small c = cos(theta) and with
  // w = sqrt(N^2 - 1), they are 4 c Re(w) / |w|^2 and 4 c Re(conj(N^2) w) / |w|^2.
  constexpr double kRelativeRounding = 1e-13;
  for (const OpticalConstants& index : {kDielectric, kAbsorbing, kMetal, OpticalConstants{1e6, 1e6}}) {
    const std::complex<double> square = std::complex(index.n, index.k) * std::complex(index.n, index.k);
    const std::complex<double> w = std::sqrt(square - 1.0);
    const double s = w.real();
    const double p = (std::conj(square) * w).real();
    SceneValues scene = make_scene(Distribution::kCauchy, Masking::kSmith, index);
    scene.surroundings.reset();
    const PointResult r = run_one(scene, 90.0, {0.0, 2.0}, Evaluator::kFloat);
    EXPECT_NEAR(r[Quantity::kDolp], (p - s) / (p + s), kRelativeRounding) << index.n;
  }
}

TEST(Limits_TinySlopes, AreThoseOfTheMirror) {
  for_each_model([](Distribution distribution, Masking masking) {
    for (const OpticalConstants& index : {kDielectric, kAbsorbing, kMetal}) {
      const SceneValues scene = make_scene(distribution, masking, index);
      for (const Evaluator evaluator : kPrecisions) {
        for (const double theta_deg : {0.0, 1e-6, 45.0, 85.0}) {
          const PointResult mirror = run_one(scene, theta_deg, {0.0, 2.0}, evaluator);
          for (const double sigma : {1e-30, 1e-29, 1e-28, 1e-27, 1e-25, 1e-20}) {
            const PointResult r = run_one(scene, theta_deg, {sigma, 2.0}, evaluator);
            EXPECT_NEAR(r[Quantity::kRhoI], mirror[Quantity::kRhoI],
                        r[Quantity::kRhoErrorEstimate] * r[Quantity::kRhoI] + 1e-15);
            EXPECT_NEAR(r[Quantity::kDolp], mirror[Quantity::kDolp],
                        r[Quantity::kErrorEstimate] + mirror[Quantity::kErrorEstimate])
                << text_of(scene, {theta_deg, {sigma, 2.0}, {}});
            EXPECT_EQ(r.status, 0U) << text_of(scene, {theta_deg, {sigma, 2.0}, {}});
          }
        }
      }
    }
  });
}

/// All combinations of hard directions, slope distributions and indices.
std::vector<SceneEntry> hard_entries(Distribution distribution, Masking masking) {
  std::vector<SceneEntry> entries;
  for (const OpticalConstants& index : {kDielectric, kAbsorbing, kMetal, kTotallyReflecting, OpticalConstants{0.2, 3.0},
                                        OpticalConstants{1000.0, 1000.0}}) {
    for (const double theta_deg : {0.0, 1e-6, 53.1, 89.99, 89.9999, 90.0}) {
      for (const double sigma : {0.0, 1e-30, 1e-20, 1e-4, 0.3, 10.0}) {
        for (const double q : {1.001, 1.4999, 1.5, 1.5001, 2.0, 1e4}) {
          const bool has_mean_slope = q > 1.5 || distribution == Distribution::kGaussian;
          if (has_mean_slope || masking != Masking::kSmith) entries.push_back({theta_deg, {sigma, q}, index});
        }
      }
    }
  }
  return entries;
}

/// Expects finite numbers. If the result is marked as outside the model's domain, I and rho_I must be NaN instead.
void expect_sound(const PointResult& r, double tolerance, const std::string& name) {
  const bool outside = (r.status & kOutsideModelDomain) != 0;
  EXPECT_EQ(outside, std::isnan(r[Quantity::kStokesI])) << name;
  EXPECT_EQ(outside, std::isnan(r[Quantity::kRhoI])) << name;
  EXPECT_TRUE(std::isfinite(r[Quantity::kDolp])) << name;
  if (!outside) {
    EXPECT_TRUE(std::isfinite(r[Quantity::kStokesQ]) && std::isfinite(r[Quantity::kAlbedo])) << name;
    EXPECT_EQ((r.status & kIntensityNotPositive) != 0, r[Quantity::kStokesI] <= 0.0) << name;
  }
  const bool dolp_missed = r[Quantity::kErrorEstimate] > tolerance;
  const bool is_missed =
      outside ? dolp_missed : r[Quantity::kRhoErrorEstimate] > tolerance || (promises_dolp(r.status) && dolp_missed);
  EXPECT_EQ((r.status & kAnyToleranceNotMet) != 0, is_missed) << name;
  EXPECT_TRUE(r[Quantity::kErrorEstimate] >= 0.0 && r[Quantity::kRhoErrorEstimate] >= 0.0) << name;
}

TEST(Limits_HardEntries, AreFiniteOrSayWhyNot) {
  for_each_model([](Distribution distribution, Masking masking) {
    SceneValues scene = make_scene(distribution, masking, kDielectric);
    const std::vector<SceneEntry> entries = hard_entries(distribution, masking);
    for (const Evaluator evaluator : kPrecisions) {
      scene.accuracy.tolerance = evaluator == Evaluator::kFloat ? 1e-4 : 1e-3;
      const std::vector<PointResult> results = run(scene, entries, evaluator);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const bool at_right_angle = entries[i].theta_deg == 90.0;
        expect_sound(results[i], scene.accuracy.tolerance, text_of(scene, entries[i]));
        if (!at_right_angle) {
          EXPECT_EQ(results[i].status & kOutsideModelDomain, 0U) << text_of(scene, entries[i]);
        }
      }
    }
  });
}

/// The smallest zenith, in steps of 0.25 degrees, for which rho_s or rho_p is outside [0, 1] there and at all larger
/// zeniths. If there is no such zenith, the result is 90.
double unphysical_from_deg(Masking masking, const OpticalConstants& index, double sigma, Evaluator evaluator) {
  SceneValues scene = make_scene(Distribution::kCauchy, masking, index);
  scene.grid = make_axes({}, {sigma}, {2.0});
  for (double theta_deg = 45.0; theta_deg < 90.0; theta_deg += 0.25) scene.grid[Axis::kTheta].push_back(theta_deg);
  const std::vector<PointResult> results = run(scene, grid_entries(scene), evaluator);
  std::size_t first = results.size();
  while (first > 0 && (results[first - 1].status & kReflectanceOutsideZeroToOne) != 0) --first;
  return first < results.size() ? scene.grid[Axis::kTheta][first] : 90.0;
}

TEST(Limits_IntegralMasking, LeavesPhysicsWhereDocumented) {
  struct Case {
    double sigma;
    double from_deg;
  };
  for (const Evaluator evaluator : kPrecisions) {
    for (const Case& row : {Case{0.1, 78.0}, Case{0.3, 69.0}, Case{0.445, 66.0}, Case{0.905, 66.0}}) {
      const double integral = unphysical_from_deg(Masking::kIntegral, kMetal, row.sigma, evaluator);
      EXPECT_NEAR(integral, row.from_deg, 1.0) << row.sigma;
      const double none = unphysical_from_deg(Masking::kNone, kMetal, row.sigma, evaluator);
      EXPECT_TRUE(none >= integral - 6.5 && none <= integral - 0.5) << none << " against " << integral;
    }
  }
}

}  // namespace
}  // namespace dolp::scene_limits_test
