// The Mueller pBRDF of the shaders' text (in double and float on the CPU) against explicit vectors and its symmetries.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "evaluate/cpu/text.hpp"
#include "evaluate/reference/mueller.hpp"
#include "plan/geometry.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kSeed = 20260110;
constexpr int kGeometries = 100;

// G of `integral` and smith comes from a table that is good to 1e-6 (the plan's kMaskingTableError); G >= 1/2 for the
// first, and the closed forms of the others leave only rounding.
constexpr double kTableTolerance = 4e-6;
constexpr double kDoubleTolerance = 1e-11;
constexpr double kFloatTolerance = 1e-5;
// A gaussian's exponent, 80 at most, carries four roundings of 6e-8.
constexpr double kFloatGaussianTolerance = 2e-5;

// A float's exponential ends at e^-80: smaller densities are 0, and errors are taken relative to this at least.
constexpr double kSmallestFloat = 1e-28;

struct Model {
  Surface surface;
  OpticalConstants index;
};

struct Angles {
  double theta_i_deg, theta_r_deg, delta_phi_deg;
};

Eigen::Matrix4d text_mueller(const Model& model, const Angles& angles, bool in_double) {
  MomentsRequest request;
  request.distribution = model.surface.distribution;
  request.masking = model.surface.masking;
  request.theta_deg = {0.0};
  request.shapes = {{model.surface.sigma, model.surface.q}};
  request.indices = {model.index};
  const KernelData data = kernel_data(request);
  const auto text = in_double ? make_kernel_text_double(data) : make_kernel_text_float(data);
  if (data.needs_masking_table()) text->build_masking_table(0);
  const auto geometry = geometry_node(angles.theta_i_deg, angles.theta_r_deg, angles.delta_phi_deg);
  const kernel::MuellerNode node = text->mueller(geometry, 0, 0);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(node.m);
  return matrix / (geometry.c_i * geometry.c_r);
}

Eigen::Matrix4d reference_mueller(const Model& model, const Angles& angles) {
  const MuellerMatrix rows =
      reference_pbrdf(model.surface, model.index, angles.theta_i_deg, angles.theta_r_deg, angles.delta_phi_deg);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  return matrix;
}

class Random {
 public:
  double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(engine_); }

  Model model(Masking masking, Distribution distribution) {
    Model model;
    model.surface.masking = masking;
    model.surface.distribution = distribution;
    model.surface.sigma = std::exp(uniform(std::log(0.05), std::log(1.0)));
    model.surface.q = uniform(1.6, 6.0);
    const bool metal = uniform(0.0, 1.0) < 0.4;
    model.index = metal ? OpticalConstants{uniform(0.5, 27.0), uniform(1.0, 90.0)}
                        : OpticalConstants{uniform(0.6, 4.0), uniform(0.0, 0.5)};
    return model;
  }

  Angles angles() { return {uniform(1.0, 88.0), uniform(1.0, 88.0), uniform(-180.0, 180.0)}; }

 private:
  std::mt19937_64 engine_{kSeed};
};

using Case = std::tuple<Distribution, Masking>;

class RandomGeometries : public testing::TestWithParam<Case> {
 protected:
  Model next_model() { return random_.model(std::get<1>(GetParam()), std::get<0>(GetParam())); }
  bool has_table() const {
    const Masking masking = std::get<1>(GetParam());
    return masking == Masking::kIntegral || masking == Masking::kSmith;
  }
  Random random_;
};

TEST_P(RandomGeometries, AllElements_AgreeWithExplicitVectors) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  double worst_double = 0.0;
  double worst_float = 0.0;
  for (int n = 0; n < kGeometries; ++n) {
    const Model model = next_model();
    const Angles angles = random_.angles();
    const Eigen::Matrix4d reference = reference_mueller(model, angles);
    const auto error = [&](bool in_double, double least) {
      const Eigen::Matrix4d difference = text_mueller(model, angles, in_double) - reference;
      return difference.cwiseAbs().maxCoeff() / std::max(reference(0, 0), least);
    };
    worst_double = std::max(worst_double, error(true, 0.0));
    worst_float = std::max(worst_float, error(false, kSmallestFloat));
  }
  std::printf("worst error over m00: double %.1e, float %.1e\n", worst_double, worst_float);
  EXPECT_LE(worst_double, has_table() ? kTableTolerance : kDoubleTolerance);
  const bool gaussian = std::get<0>(GetParam()) == Distribution::kGaussian;
  EXPECT_LE(worst_float, gaussian ? kFloatGaussianTolerance : kFloatTolerance);
}

// f(i, r, dphi) = S f(r, i, -dphi)^T S with S = diag(1, 1, -1, 1); with dphi unchanged S = diag(1, 1, 1, -1).
TEST_P(RandomGeometries, ExchangedBeams_GiveTheTransposedMatrix) {
  const Eigen::Matrix4d mirrored = Eigen::Vector4d(1.0, 1.0, -1.0, 1.0).asDiagonal();
  const Eigen::Matrix4d kept = Eigen::Vector4d(1.0, 1.0, 1.0, -1.0).asDiagonal();
  for (int n = 0; n < kGeometries; ++n) {
    const Model model = next_model();
    const Angles a = random_.angles();
    const Eigen::Matrix4d f = text_mueller(model, a, true);
    const Eigen::Matrix4d minus = text_mueller(model, {a.theta_r_deg, a.theta_i_deg, -a.delta_phi_deg}, true);
    const Eigen::Matrix4d same = text_mueller(model, {a.theta_r_deg, a.theta_i_deg, a.delta_phi_deg}, true);
    EXPECT_LE((f - mirrored * minus.transpose() * mirrored).cwiseAbs().maxCoeff(), kDoubleTolerance * f(0, 0));
    EXPECT_LE((f - kept * same.transpose() * kept).cwiseAbs().maxCoeff(), kDoubleTolerance * f(0, 0));
  }
}

// A pure (Mueller-Jones) matrix: its coherency matrix has one eigenvalue above rounding, none below.
TEST_P(RandomGeometries, EveryMatrix_IsRealisable) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const std::array<Eigen::Matrix2cd, 4> pauli = {
      Eigen::Matrix2cd{{1.0, 0.0}, {0.0, 1.0}}, Eigen::Matrix2cd{{1.0, 0.0}, {0.0, -1.0}},
      Eigen::Matrix2cd{{0.0, 1.0}, {1.0, 0.0}}, Eigen::Matrix2cd{{0.0, -i}, {i, 0.0}}};
  for (int n = 0; n < kGeometries; ++n) {
    const Eigen::Matrix4d f = text_mueller(next_model(), random_.angles(), true);
    Eigen::Matrix4cd coherency = Eigen::Matrix4cd::Zero();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        const Eigen::Matrix2cd& a = pauli[static_cast<std::size_t>(row)];
        const Eigen::Matrix2cd b = pauli[static_cast<std::size_t>(column)].conjugate();
        for (int block = 0; block < 4; ++block) {
          coherency.block<2, 2>(2 * (block / 2), 2 * (block % 2)) +=
              0.25 * f(row, column) * a(block / 2, block % 2) * b;
        }
      }
    }
    const Eigen::Vector4d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd>(coherency).eigenvalues();
    EXPECT_GE(values(0), -kDoubleTolerance * f(0, 0));
    EXPECT_LE(values(2), kDoubleTolerance * f(0, 0));
  }
}

std::string name_of(const testing::TestParamInfo<Case>& test) {
  constexpr std::array kMaskings = {"None", "VCavity", "Integral", "Smith"};
  const auto [distribution, masking] = test.param;
  return std::string(distribution == Distribution::kCauchy ? "Cauchy" : "Gaussian") +
         kMaskings[static_cast<std::size_t>(masking)];
}

INSTANTIATE_TEST_SUITE_P(Models, RandomGeometries,
                         testing::Combine(testing::Values(Distribution::kCauchy, Distribution::kGaussian),
                                          testing::Values(Masking::kNone, Masking::kVCavity, Masking::kIntegral,
                                                          Masking::kSmith)),
                         name_of);

Model plain_model() {
  Model model;
  model.surface.sigma = 0.3;
  model.surface.q = 2.0;
  model.surface.masking = Masking::kNone;
  model.index = {1.5, 0.2};
  return model;
}

// Next to the specular direction at grazing incidence the table's G is known least.
TEST(MuellerAtGrazing, TableMasking_StaysWithinTheBeamsStatedError) {
  constexpr double kStatedError = 1e-5;       // kTableError of evaluate/run/scattering.cpp
  constexpr double kSmallestDouble = 1e-280;  // the text's exponential ends at e^-690
  Random random;
  double worst = 0.0;
  for (const Masking masking : {Masking::kIntegral, Masking::kSmith}) {
    for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
      for (int n = 0; n < kGeometries; ++n) {
        Model model = random.model(masking, distribution);
        model.surface.sigma = std::exp(random.uniform(std::log(1e-3), std::log(5.0)));
        const Angles angles = {90.0 - std::pow(10.0, random.uniform(-2.0, 1.0)),
                               90.0 - std::pow(10.0, random.uniform(-2.0, 1.0)),
                               180.0 - std::pow(10.0, random.uniform(-3.0, 1.0))};
        const double reference = reference_mueller(model, angles)(0, 0);
        if (reference < kSmallestDouble) continue;
        worst = std::max(worst, std::abs(text_mueller(model, angles, true)(0, 0) / reference - 1.0));
      }
    }
  }
  std::printf("worst relative error of f_00: %.1e\n", worst);
  EXPECT_LE(worst, kStatedError);
}

TEST(Mueller, NormalIncidenceRetro_IsTheLimit) {
  const Eigen::Matrix4d at = text_mueller(plain_model(), {0.0, 0.0, 0.0}, true);
  const Eigen::Matrix4d near = text_mueller(plain_model(), {1e-6, 1e-6, 0.0}, true);
  EXPECT_LE((at - near).cwiseAbs().maxCoeff(), 1e-9 * at(0, 0));  // the angle is 2e-8 rad
  const Eigen::Vector4d mirror(1.0, 1.0, -1.0, -1.0);             // r_p = -r_s
  EXPECT_LE((at / at(0, 0) - Eigen::Matrix4d(mirror.asDiagonal())).cwiseAbs().maxCoeff(), kDoubleTolerance);
}

TEST(Mueller, Retro_IsTheSameFromEverySide) {
  const Eigen::Matrix4d at = text_mueller(plain_model(), {40.0, 40.0, 0.0}, true);
  for (const Angles& angles : {Angles{40.0 + 1e-6, 40.0, 0.0}, Angles{40.0, 40.0 + 1e-6, 0.0}, Angles{40.0, 40.0, 1e-6},
                               Angles{40.0, 40.0, -1e-6}}) {
    EXPECT_LE((text_mueller(plain_model(), angles, true) - at).cwiseAbs().maxCoeff(), 1e-6 * at(0, 0));
  }
}

// The moments are the integrals of the first row of f: the check that kernel and pBRDF are one model.
TEST(Mueller, HemisphericalSum_GivesTheMoments) {
  constexpr int kZeniths = 400;
  constexpr int kAzimuths = 400;
  constexpr double kMidpointError = 2e-4;  // of the midpoint rule, with the kink of the horizon; halves with the step
  const Model model = plain_model();
  const double theta_deg = 50.0;
  MomentsRequest request;
  request.masking = model.surface.masking;
  request.theta_deg = {theta_deg};
  request.shapes = {{model.surface.sigma, model.surface.q}};
  request.indices = {model.index};
  request.entries = {{0, 0, 0}};
  const KernelData data = kernel_data(request);
  const auto text = make_kernel_text_double(data);
  const kernel::MomentsNode moments = text->moments(data.entries[0]);
  double r_i = 0.0;
  double r_q = 0.0;
  for (int zenith = 0; zenith < kZeniths; ++zenith) {
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
      const auto geometry =
          geometry_node(theta_deg, 90.0 * (zenith + 0.5) / kZeniths, 180.0 * (azimuth + 0.5) / kAzimuths);
      const kernel::MuellerNode f = text->mueller(geometry, 0, 0);
      const double weight = 2.0 * geometry.s_r * (0.5 * std::numbers::pi / kZeniths) * (std::numbers::pi / kAzimuths);
      r_i += weight * f.m[0];
      r_q += weight * f.m[1];
    }
  }
  EXPECT_NEAR(r_i, moments.r_i, kMidpointError * moments.r_i);
  EXPECT_NEAR(r_q, moments.r_q, kMidpointError * moments.r_i);
}

}  // namespace
}  // namespace dolp
