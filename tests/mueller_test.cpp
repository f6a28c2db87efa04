// The Mueller pBRDF of every evaluator, on the device and on the CPU, in float and in double: against explicit vectors in
// quadruple precision, and the symmetries that hold without a reference.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/reference/reference_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "mueller_support.hpp"

namespace dolp {
namespace {

using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr std::uint64_t kSeed = 20260110;
constexpr std::size_t kPoints = 400;

// Below the normal numbers of a double nothing has a relative accuracy.
constexpr double kSmallest = 1e-300;

struct Kernel {
  const char* name;
  bool on_device;
  Precision precision;
  double tolerance() const {
    return precision == Precision::kDouble ? kScatteringErrorDouble : kScatteringErrorFloat;
  }
};
constexpr std::array kKernels = {
    Kernel{"VulkanFloat", true, Precision::kFloat}, Kernel{"VulkanDouble", true, Precision::kDouble},
    Kernel{"CpuFloat", false, Precision::kFloat}, Kernel{"CpuDouble", false, Precision::kDouble}};

using Case = std::tuple<Kernel, Distribution, Masking>;

class EveryKernel : public testing::TestWithParam<Case> {
 protected:
  Kernel kernel() const { return std::get<0>(GetParam()); }
  Distribution distribution() const { return std::get<1>(GetParam()); }
  Masking masking() const { return std::get<2>(GetParam()); }
  RandomPoints random() const { return {kSeed, masking()}; }
  double tolerance() const { return kernel().tolerance(); }

  std::vector<Matrix> scatter(ScatteringEvaluator& evaluator, const std::vector<ScatteringPoint>& points) const {
    std::vector<Matrix> matrices;
    for (const ScatteringMatrix& f : evaluator.scatter(request_of(distribution(), masking(), points), {})) {
      matrices.emplace_back(Eigen::Map<const Matrix>(f.m.data()));
    }
    return matrices;
  }

  std::vector<Matrix> scatter(const std::vector<ScatteringPoint>& points) const {
    if (!kernel().on_device) {
      CpuEvaluator evaluator(kernel().precision);
      return scatter(evaluator, points);
    }
    VulkanOptions options;
    options.precision = kernel().precision;
    options.validation = ValidationMode::kOn;
    VulkanEvaluator evaluator(options);
    return scatter(evaluator, points);
  }
};

TEST_P(EveryKernel, AllElements_AgreeWithExplicitVectors) {
  const std::vector<ScatteringPoint> points = random().draw(kPoints);
  const std::vector<Matrix> matrices = scatter(points);
  ReferenceEvaluator reference_evaluator;
  const std::vector<Matrix> references = scatter(reference_evaluator, points);
  double worst = 0.0;
  std::size_t where = 0, compared = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double m00 = references[i](0, 0);
    if (m00 < kSmallest) continue;
    const double error = (matrices[i] - references[i]).cwiseAbs().maxCoeff() / m00;
    ++compared;
    if (error <= worst) continue;
    worst = error;
    where = i;
  }
  std::printf("worst error over m00 of %zu: %.1e at %s\n", compared, worst, text_of(points[where]).c_str());
  EXPECT_GT(compared, kPoints / 3);
  EXPECT_LE(worst, tolerance()) << text_of(points[where]);
}

/// The same surfaces with the beams exchanged, the azimuth turned by a sign.
std::vector<ScatteringPoint> exchanged(std::vector<ScatteringPoint> points, double sign) {
  for (ScatteringPoint& p : points) {
    p.angles = {p.angles.theta_r_deg, p.angles.theta_i_deg, sign * p.angles.delta_phi_deg};
  }
  return points;
}

// f(i, r, dphi) = S f(r, i, -dphi)^T S with S = diag(1, 1, -1, 1); with dphi unchanged S = diag(1, 1, 1, -1).
TEST_P(EveryKernel, ExchangedBeams_GiveTheTransposedMatrix) {
  const Matrix mirrored = Eigen::Vector4d(1.0, 1.0, -1.0, 1.0).asDiagonal();
  const Matrix kept = Eigen::Vector4d(1.0, 1.0, 1.0, -1.0).asDiagonal();
  const std::vector<ScatteringPoint> points = random().draw(kPoints);
  const std::vector<Matrix> f = scatter(points);
  const std::vector<Matrix> minus = scatter(exchanged(points, -1.0));
  const std::vector<Matrix> same = scatter(exchanged(points, 1.0));
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (f[i](0, 0) < kSmallest) continue;
    const Matrix of_minus = mirrored * minus[i].transpose() * mirrored;
    const Matrix of_same = kept * same[i].transpose() * kept;
    EXPECT_LE((f[i] - of_minus).cwiseAbs().maxCoeff(), 2.0 * tolerance() * f[i](0, 0)) << text_of(points[i]);
    EXPECT_LE((f[i] - of_same).cwiseAbs().maxCoeff(), 2.0 * tolerance() * f[i](0, 0)) << text_of(points[i]);
  }
}

// The surface has a mirror plane: f(-dphi) = T f(dphi) T with T = diag(1, 1, -1, -1), to the last bit.
TEST_P(EveryKernel, OppositeAzimuth_TurnsTheSignsOfUAndV) {
  const Matrix mirror = Eigen::Vector4d(1.0, 1.0, -1.0, -1.0).asDiagonal();
  std::vector<ScatteringPoint> points = random().draw(kPoints);
  const std::vector<Matrix> f = scatter(points);
  for (ScatteringPoint& point : points) point.angles.delta_phi_deg *= -1.0;
  const std::vector<Matrix> opposite = scatter(points);
  for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(f[i], mirror * opposite[i] * mirror) << text_of(points[i]);
}

/// Cloude's coherency matrix of a Mueller matrix. Source: Cloude 1986; its eigenvalues add up to m00 (here, halved twice).
Eigen::Matrix4cd coherency(const Matrix& f) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const std::array<Eigen::Matrix2cd, 4> pauli = {
      Eigen::Matrix2cd{{1.0, 0.0}, {0.0, 1.0}}, Eigen::Matrix2cd{{1.0, 0.0}, {0.0, -1.0}},
      Eigen::Matrix2cd{{0.0, 1.0}, {1.0, 0.0}}, Eigen::Matrix2cd{{0.0, -i}, {i, 0.0}}};
  Eigen::Matrix4cd result = Eigen::Matrix4cd::Zero();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Eigen::Matrix2cd& a = pauli[static_cast<std::size_t>(row)];
      const Eigen::Matrix2cd b = pauli[static_cast<std::size_t>(column)].conjugate();
      for (int block = 0; block < 4; ++block) {
        result.block<2, 2>(2 * (block / 2), 2 * (block % 2)) += 0.25 * f(row, column) * a(block / 2, block % 2) * b;
      }
    }
  }
  return result;
}

// A pure (Mueller-Jones) matrix: one eigenvalue above rounding, none below, so that no Stokes vector becomes unphysical.
TEST_P(EveryKernel, EveryMatrix_IsRealisable) {
  const std::vector<ScatteringPoint> points = random().draw(kPoints);
  const std::vector<Matrix> matrices = scatter(points);
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (matrices[i](0, 0) < kSmallest) continue;
    const Matrix f = matrices[i] / matrices[i](0, 0);
    const Eigen::Vector4d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd>(coherency(f)).eigenvalues();
    // Each eigenvalue moves by at most the norm of an error of the matrix, four times its largest element.
    EXPECT_GE(values(0), -4.0 * tolerance()) << text_of(points[i]);
    EXPECT_LE(values(2), 4.0 * tolerance()) << text_of(points[i]);
  }
}

std::string name_of(const testing::TestParamInfo<Case>& test) {
  constexpr std::array kMaskings = {"None", "VCavity", "Integral", "Smith"};
  const auto [kernel, distribution, masking] = test.param;
  return std::string(kernel.name) + (distribution == Distribution::kCauchy ? "Cauchy" : "Gaussian") +
         kMaskings[static_cast<std::size_t>(masking)];
}

INSTANTIATE_TEST_SUITE_P(Mueller, EveryKernel,
                         testing::Combine(testing::ValuesIn(kKernels),
                                          testing::Values(Distribution::kCauchy, Distribution::kGaussian),
                                          testing::Values(Masking::kNone, Masking::kVCavity, Masking::kIntegral,
                                                          Masking::kSmith)),
                         name_of);

}  // namespace
}  // namespace dolp
