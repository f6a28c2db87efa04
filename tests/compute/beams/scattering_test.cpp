// The Mueller pBRDF, compared with a computation from explicit vectors in quadruple precision. Tests in tests/reference
// show that the matrices of this computation are reciprocal and realisable. The environment variable
// DOLP_PROPERTY_DRAWS sets the number of points per model.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "beams/beam_geometry.hpp"
#include "beams/scattering.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/angles.hpp"
#include "mueller_support.hpp"
#include "properties_support.hpp"
#include "reference/reference_evaluator.hpp"

namespace dolp::scattering_test {
namespace {

using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr std::uint64_t kSeed = 20260110;

double tan_deg(double angle_deg) { return std::tan(angle_deg * std::numbers::pi / 180.0); }

const std::size_t kPoints = draws_wanted(400);

// Matrices with a smaller m00 are not compared. The reference computes m00 from a slope density that may be 1e22 times
// smaller than m00. Near the smallest positive double, this density would have few digits.
constexpr double kSmallest = 1e-280;

bool needs_masking_integral(Masking masking) { return masking == Masking::kIntegral || masking == Masking::kSmith; }

// Every second point gets another width across, with a quotient of 1/3 to 3.
void make_elliptic(std::vector<ScatteringPoint>& points) {
  Draws draw(kSeed);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    points[i].shape.sigma_cross = points[i].shape.sigma * draw.log_uniform(1.0 / 3.0, 3.0);
    points[i].shape.azimuth_deg = draw.uniform(-180.0, 180.0);
  }
}

class ScatteringOf : public testing::TestWithParam<Model> {
 protected:
  RandomPoints random() const { return {kSeed, GetParam().masking}; }
  ScatteringRequest request(const std::vector<ScatteringPoint>& points) const {
    return request_of(GetParam().distribution, GetParam().masking, points);
  }
  std::vector<Matrix> scatter(const std::vector<ScatteringPoint>& points) const {
    return matrices(scattering_matrices(request(points), {}));
  }
  static std::vector<Matrix> matrices(const std::vector<ScatteringMatrix>& list) {
    std::vector<Matrix> matrices;
    for (const ScatteringMatrix& f : list) matrices.emplace_back(Eigen::Map<const Matrix>(f.m.data()));
    return matrices;
  }
};

TEST_P(ScatteringOf, AllElements_AgreeWithExplicitVectors) {
  std::vector<ScatteringPoint> points = random().draw(kPoints);
  if (!needs_masking_integral(GetParam().masking)) make_elliptic(points);
  const std::vector<Matrix> computed = scatter(points);
  const std::vector<Matrix> references = matrices(ReferenceEvaluator().scatter(request(points), {}));
  double worst = 0.0;
  std::size_t where = 0, compared = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double m00 = references[i](0, 0);
    if (m00 < kSmallest) continue;
    const double error = (computed[i] - references[i]).cwiseAbs().maxCoeff() / m00;
    ++compared;
    if (error <= worst) continue;
    worst = error;
    where = i;
  }
  std::printf("worst error over m00 of %zu: %.1e at %s\n", compared, worst, text_of(points[where]).c_str());
  EXPECT_GT(compared, kPoints / 3);
  EXPECT_LE(worst, kScatteringError) << text_of(points[where]);
}

// Mirror symmetry relates the pBRDF f at the azimuths dphi and -dphi: f(-dphi) = T f(dphi) T, T = diag(1, 1, -1, -1).
// The results obey this relation bit for bit.
TEST_P(ScatteringOf, OppositeAzimuth_TurnsTheSignsOfUAndV) {
  const Matrix mirror = Eigen::Vector4d(1.0, 1.0, -1.0, -1.0).asDiagonal();
  std::vector<ScatteringPoint> points = random().draw(kPoints);
  const std::vector<Matrix> f = scatter(points);
  for (ScatteringPoint& point : points) point.angles.delta_phi_deg *= -1.0;
  const std::vector<Matrix> opposite = scatter(points);
  for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(f[i], mirror * opposite[i] * mirror) << text_of(points[i]);
}

// Beams are computed in groups. A group must not change the beams in it.
TEST_P(ScatteringOf, OtherBeams_ChangeNoBit) {
  const std::vector<ScatteringPoint> points = random().draw(150);
  const std::vector<Matrix> together = scatter(points);
  for (std::size_t i = 0; i < points.size(); i += 7) EXPECT_EQ(scatter({points[i]}).front(), together[i]);
}

INSTANTIATE_TEST_SUITE_P(Models, ScatteringOf, testing::ValuesIn(kModels),
                         [](const auto& test) { return to_name(test.param); });

// ---- Limits and extremes -------------------------------------------------------------------------------------------

Matrix plain_mueller(const BeamAngles& angles, const OpticalConstants& index = {1.5, 0.2}) {
  const ScatteringPoint point{angles, {0.3, 2.0}, index};
  const auto f = scattering_matrices(request_of(Distribution::kCauchy, Masking::kNone, {point}), {}).front();
  return Matrix(Eigen::Map<const Matrix>(f.m.data()));
}

TEST(MuellerLimits, NormalIncidence_TurnsWithTheAzimuthOfTheView) {
  for (const double azimuth_deg : {0.0, 37.0, 90.0, -120.0, 180.0, 360.0}) {
    const Matrix at = plain_mueller({0.0, 0.0, azimuth_deg});
    for (const BeamAngles& near : {BeamAngles{1e-6, 1e-6, azimuth_deg}, BeamAngles{0.0, 1e-6, azimuth_deg},
                                   BeamAngles{1e-200, 0.0, azimuth_deg}}) {
      EXPECT_LE((plain_mueller(near) - at).cwiseAbs().maxCoeff(), 1e-9 * at(0, 0)) << azimuth_deg;  // 2e-8 rad
    }
    const double cosine = std::cos(2.0 * azimuth_deg * std::numbers::pi / 180.0);
    EXPECT_NEAR(at(1, 1) / at(0, 0), cosine, kScatteringError);
    EXPECT_NEAR(at(2, 2) / at(0, 0), -cosine, kScatteringError);
    EXPECT_NEAR(at(3, 3) / at(0, 0), -1.0, kScatteringError);  // r_p = -r_s
  }
}

TEST(MuellerLimits, Retro_IsTheSameFromEverySide) {
  const Matrix at = plain_mueller({40.0, 40.0, 0.0});
  for (const BeamAngles& angles : {BeamAngles{40.0 + 1e-6, 40.0, 0.0}, BeamAngles{40.0, 40.0 + 1e-6, 0.0},
                                   BeamAngles{40.0, 40.0, 1e-6}, BeamAngles{40.0, 40.0, -1e-6}}) {
    EXPECT_LE((plain_mueller(angles) - at).cwiseAbs().maxCoeff(), 1e-6 * at(0, 0));
  }
  EXPECT_EQ(plain_mueller({40.0, 40.0, 360.0}), at);
}

// At the critical angle a square root in Fresnel's formulas is almost 0. This amplifies the rounding errors of the
// angles. The stated error must cover the amplified errors.
TEST(MuellerLimits, CriticalAngle_AgreesWithExplicitVectors) {
  std::vector<ScatteringPoint> points;
  for (double n = 0.1; n < 0.96; n += 0.05) {
    for (const double offset_deg : {-1e-9, -1e-12, 0.0, 1e-12, 1e-9}) {
      const double theta_deg = std::asin(n) * 180.0 / std::numbers::pi + offset_deg;
      points.push_back({{theta_deg, theta_deg, 180.0}, {0.3, 2.0}, {n, 0.0}});
    }
  }
  const ScatteringRequest request = request_of(Distribution::kCauchy, Masking::kNone, points);
  const auto references = ReferenceEvaluator().scatter(request, {});
  const auto f = scattering_matrices(request, {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < 16; ++j) EXPECT_NEAR(f[i].m[j], references[i].m[j], f[i].error) << text_of(points[i]);
  }
}

// The ends of the allowed ranges of sigma, q, index and angles, in all combinations.
TEST(MuellerLimits, CornersOfTheDomain_AreFiniteAndAgreeWithExplicitVectors) {
  std::vector<ScatteringPoint> points;
  for (const double sigma : {1e-20, 1e-9, 1e-3, 0.3, 10.0}) {
    for (const double q : {1.000001, 1.6, 30.0, 1e4}) {
      for (const OpticalConstants& index :
           {OpticalConstants{1e6, 1e6}, {1e-6, 0.0}, {1e-3, 1e6}, {1.0, 0.0}, {1e-6, 1e-6}, {1.0 + 1e-12, 0.0}}) {
        for (const BeamAngles& angles : {BeamAngles{0.0, 0.0, 0.0},
                                         {40.0, 40.0, 180.0},
                                         {40.0, 40.0, 1e-9},
                                         {89.999999, 90.0, 180.0},
                                         {89.9999, 89.9999, 1.0},
                                         {1e-9, 60.0, 77.0}}) {
          points.push_back({angles, {sigma, q}, index});
        }
      }
    }
  }
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
      std::vector<ScatteringPoint> own = points;
      const bool needs_mean = masking == Masking::kSmith && distribution == Distribution::kCauchy;
      if (needs_mean) std::erase_if(own, [](const ScatteringPoint& p) { return p.shape.q <= 1.5; });
      const ScatteringRequest request = request_of(distribution, masking, own);
      const std::vector<ScatteringMatrix> f = scattering_matrices(request, {});
      const std::vector<ScatteringMatrix> references = ReferenceEvaluator().scatter(request, {});
      for (std::size_t i = 0; i < own.size(); ++i) {
        // A vacuum reflects nothing, and the reference only rounds. Its masking `integral` ends at slopes of 1e17,
        // which are frequent if q is nearly 1.
        const bool is_comparable =
            references[i].m[0] > kSmallest && own[i].index.n != 1.0 && own[i].shape.sigma > 1e-15;
        for (std::size_t j = 0; j < 16; ++j) {
          EXPECT_TRUE(std::isfinite(f[i].m[j])) << text_of(own[i]);
          if (is_comparable) {
            EXPECT_NEAR(f[i].m[j], references[i].m[j], f[i].error + references[i].error)
                << to_name(masking) << " " << text_of(own[i]);
          }
        }
      }
    }
  }
}

// Moments are integrals of the pBRDF's first row. A kernel computes them by other formulas.
TEST(Mueller, HemisphericalSum_GivesTheMoments) {
  constexpr int kZeniths = 400;
  constexpr int kAzimuths = 400;
  // Error of the midpoint rule, proportional to its step, because the integrand has a kink at the horizon.
  constexpr double kMidpointError = 2e-4;
  const ScatteringPoint surface{{50.0, 0.0, 0.0}, {0.3, 2.0}, {1.5, 0.2}};
  std::vector<ScatteringPoint> points;
  for (int zenith = 0; zenith < kZeniths; ++zenith) {
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
      points.push_back(surface);
      points.back().angles = {50.0, 90.0 * (zenith + 0.5) / kZeniths, 180.0 * (azimuth + 0.5) / kAzimuths};
    }
  }
  const auto f = scattering_matrices(request_of(Distribution::kCauchy, Masking::kNone, points), {});
  MomentsRequest request;
  request.precision = Precision::kDouble;
  request.masking = Masking::kNone;
  request.append({50.0, surface.shape, surface.index});
  const Moments moments = CpuEvaluator().evaluate(request, {}).front();
  double r_i = 0.0;
  double r_q = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double sine = cos_sin_deg(points[i].angles.theta_r_deg).sin;
    const double weight = 2.0 * sine * (0.5 * std::numbers::pi / kZeniths) * (std::numbers::pi / kAzimuths);
    r_i += weight * f[i].m[0];
    r_q += weight * f[i].m[1];
  }
  EXPECT_NEAR(r_i, moments.r_i, kMidpointError * moments.r_i);
  EXPECT_NEAR(r_q, moments.r_q, kMidpointError * moments.r_i);
}

TEST(Mueller, ProgressThatSaysNo_Cancels) {
  const std::vector<ScatteringPoint> points = RandomPoints(kSeed, Masking::kNone).draw(10);
  const ScatteringRequest request = request_of(Distribution::kCauchy, Masking::kNone, points);
  EXPECT_THROW(scattering_matrices(request, [](std::size_t, std::size_t) { return false; }), Cancelled);
  EXPECT_TRUE(scattering_matrices({}, {}).empty());
}

// The normal of the facet halves the angle between omega_i and omega_r, because a facet is a mirror.
TEST(BeamGeometry, BeamsInOnePlane_HaveTheFacetBetweenThem) {
  for (const auto& [theta_i_deg, theta_r_deg, delta_phi_deg, slope_deg, beta_deg] :
       std::vector<std::array<double, 5>>{{40, 40, 180, 0, 40},
                                          {40, 40, 0, 40, 0},
                                          {0, 60, 180, 30, 30},
                                          {20, 60, 180, 20, 40},
                                          {20, 60, 0, 40, 20}}) {
    const BeamGeometry geometry = beam_geometry({theta_i_deg, theta_r_deg}, delta_phi_deg);
    EXPECT_NEAR(geometry.slope, tan_deg(slope_deg), 1e-15) << theta_i_deg << " " << theta_r_deg;
    EXPECT_NEAR(geometry.cos_beta, cos_sin_deg(beta_deg).cos, 1e-15) << theta_i_deg << " " << theta_r_deg;
    EXPECT_NEAR(geometry.sin2_beta, std::pow(cos_sin_deg(beta_deg).sin, 2.0), 1e-15) << theta_i_deg;
  }
}

}  // namespace
}  // namespace dolp::scattering_test
