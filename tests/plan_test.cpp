// The plan: rules, pieces of the slope axis, loop bounds, and a scan that shows how often its orders are too low.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "evaluate/cpu/text.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Rule = std::vector<std::array<double, 2>>;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kMaskingNames = {"none", "v-cavity", "integral", "smith"};
constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr std::array kHardDirectionsDeg = {0.0, 1e-6, 12.857142857, 18.0, 30.0, 45.0, 60.0, 89.99, 90.0};
constexpr OpticalConstants kDielectric{1.508, 0.0};
constexpr OpticalConstants kTotallyReflecting{0.8, 0.0};

// Abscissae and weights carry a rounding or two each; a polynomial of size 1 and degree d oscillates d times and feels
// the abscissae's as often.
constexpr double kRuleTolerance = 1e-15;
double rule_tolerance(int degree) { return kRuleTolerance * (1.0 + 0.1 * degree); }

// ---- Rules ---------------------------------------------------------------------------------------------------------

// Chebyshev polynomial T_k: of size 1 on [-1, 1], so that no degree hides behind another.
double chebyshev(int k, double x) {
  return static_cast<double>(std::cos(k * std::acos(std::clamp(static_cast<long double>(x), -1.0L, 1.0L))));
}

// Integral of T_k over [-1, 1].
double chebyshev_integral(int k) { return k % 2 == 1 ? 0.0 : 2.0 / (1.0 - static_cast<double>(k) * k); }

template <class Function>
double integrate(const Rule& rule, const Function& function) {
  long double sum = 0.0L;
  for (const auto& [x, weight] : rule) sum += static_cast<long double>(weight) * function(x);
  return static_cast<double>(sum);
}

TEST(GaussLegendre, EveryOrder_IntegratesPolynomialsOfDegree2nMinus1) {
  double worst = 0.0;
  for (int order = 1; order <= 2 * DOLP_MAX_ORDER; ++order) {
    const Rule rule = gauss_legendre(order);
    ASSERT_EQ(rule.size(), static_cast<std::size_t>(order));
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = integrate(rule, [&](double x) { return chebyshev(degree, x); });
      worst = std::max(worst, std::abs(sum - chebyshev_integral(degree)) / rule_tolerance(degree));
    }
    EXPECT_TRUE(std::is_sorted(rule.begin(), rule.end()));
    for (std::size_t i = 0; i < rule.size(); ++i) {
      EXPECT_GT(rule[i][1], 0.0);
      EXPECT_EQ(rule[i][0], -rule[rule.size() - 1 - i][0]);
    }
  }
  std::printf("worst error %.2f of what is allowed\n", worst);
  EXPECT_LE(worst, 1.0);
}

TEST(GaussLegendre, Degree2n_IsNotIntegrated) {
  double sum = 0.0;
  for (const auto& [x, weight] : gauss_legendre(3)) sum += weight * std::pow(x, 6);
  EXPECT_GT(std::abs(sum - 2.0 / 7.0), 1e-3);
}

// The rule of one order in one section of rule_nodes().
Rule section_rule(int section, int order) {
  static const Rule nodes = rule_nodes();
  const int first = section * DOLP_MAX_ORDER * (DOLP_MAX_ORDER + 1) / 2 + order * (order - 1) / 2;
  return {nodes.begin() + first, nodes.begin() + first + order};
}

TEST(RuleNodes, AllSections_AreThere) {
  EXPECT_EQ(rule_nodes().size(), static_cast<std::size_t>(5 * DOLP_MAX_ORDER * (DOLP_MAX_ORDER + 1) / 2));
}

TEST(RuleNodes, Gauss_IntegratesPolynomialsOnTheUnitInterval) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = integrate(section_rule(0, order), [&](double x) { return chebyshev(degree, 2.0 * x - 1.0); });
      EXPECT_NEAR(sum, 0.5 * chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

TEST(RuleNodes, Centre_IntegratesPolynomialsOnTheSymmetricInterval) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = integrate(section_rule(1, order), [&](double x) { return chebyshev(degree, x); });
      EXPECT_NEAR(sum, chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

TEST(RuleNodes, Half_IntegratesEvenPolynomialsOfDegree4nMinus2) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 4 * order; degree += 2) {
      const double sum = integrate(section_rule(2, order), [&](double x) { return chebyshev(degree, x); });
      EXPECT_NEAR(sum, 0.5 * chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

TEST(RuleNodes, Circle_IntegratesCosinesOverTheHalfCircle) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int harmonic = 0; harmonic < 2 * order; ++harmonic) {
      const double sum = integrate(section_rule(3, order), [&](double tau) {
        return 4.0 / (1.0 + tau * tau) * std::cos(harmonic * 4.0 * std::atan(tau));
      });
      EXPECT_NEAR(sum, harmonic == 0 ? pi : 0.0, 4.0 * rule_tolerance(harmonic)) << order << " " << harmonic;
    }
  }
}

TEST(RuleNodes, Cluster_IntegratesPolynomialsInTheSquareRoot) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int power = 0; power < 2 * order - 1; ++power) {
      const double sum = integrate(section_rule(4, order), [&](double x) { return std::pow(x, 0.5 * power); });
      EXPECT_NEAR(sum, 2.0 / (power + 2.0), rule_tolerance(power)) << order << " " << power;
    }
  }
}

// ---- Directions ----------------------------------------------------------------------------------------------------

TEST(CosSinDeg, MultiplesOf90_AreExact) {
  const std::array<std::array<double, 3>, 5> exact = {
      {{0.0, 1.0, 0.0}, {90.0, 0.0, 1.0}, {180.0, -1.0, 0.0}, {270.0, 0.0, -1.0}, {360.0, 1.0, 0.0}}};
  for (const auto& [angle_deg, cosine, sine] : exact) {
    EXPECT_EQ(cos_sin_deg(angle_deg).cos, cosine) << angle_deg;
    EXPECT_EQ(cos_sin_deg(angle_deg).sin, sine) << angle_deg;
  }
}

TEST(CosSinDeg, OtherAngles_AgreeWithTheLibrary) {
  constexpr double kTolerance = 5e-16;  // pi times the rounding of an angle over 180 degrees, and that of the result
  for (double angle_deg = -90.0; angle_deg <= 360.0; angle_deg += 0.37) {
    const long double angle = angle_deg * std::numbers::pi_v<long double> / 180.0L;
    EXPECT_NEAR(cos_sin_deg(angle_deg).cos, static_cast<double>(std::cos(angle)), kTolerance) << angle_deg;
    EXPECT_NEAR(cos_sin_deg(angle_deg).sin, static_cast<double>(std::sin(angle)), kTolerance) << angle_deg;
  }
}

// ---- Kernel data ---------------------------------------------------------------------------------------------------

// All hard directions with an ordinary, an absorbing and several totally reflecting indices.
MomentsRequest hard_request(Distribution distribution, Masking masking, double tolerance, bool total_reflection) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.tolerance = tolerance;
  request.theta_deg.assign(kHardDirectionsDeg.begin(), kHardDirectionsDeg.end());
  request.shapes = {{0.3, 2.0}, {1e-3, 1.6}, {5.0, 45.0}};
  request.indices = {kDielectric, {27.0, 90.0}};
  if (total_reflection) {
    for (const double n : {0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1}) request.indices.push_back({n, 0.0});
  }
  for (std::uint32_t theta = 0; theta < request.theta_deg.size(); ++theta) {
    for (std::uint32_t shape = 0; shape < request.shapes.size(); ++shape) {
      for (std::uint32_t index = 0; index < request.indices.size(); ++index) {
        request.entries.push_back({theta, shape, index});
      }
    }
  }
  return request;
}

TEST(KernelDataPieces, HardDirections_AscendFromZeroToTheHorizonWithinTheirRoom) {
  for (const Masking masking : kMaskings) {
    const KernelData data = kernel_data(hard_request(Distribution::kCauchy, masking, 1e-4, true));
    double most = 0.0;
    for (const kernel::ThetaNode& node : data.thetas) {
      most = std::max(most, node.piece_count);
      ASSERT_GE(node.piece_count, 1.0);
      ASSERT_LE(node.piece_count, static_cast<double>(DOLP_MAX_PIECES));
      const std::size_t last = static_cast<std::size_t>(node.piece_count);
      EXPECT_EQ(node.end[0], 0.0);
      for (std::size_t i = 0; i < last; ++i) {
        EXPECT_LE(node.end[i], node.end[i + 1]) << "c " << node.c << " piece " << i;
        EXPECT_TRUE(node.kind[i] >= 0.0 && node.kind[i] <= 3.0);
      }
      // beyond slope (1 + s) / c no reflected ray leaves
      const double horizon = node.c > 0.0 ? (1.0 + node.s) / node.c : 1e30;
      EXPECT_DOUBLE_EQ(node.end[last], horizon);
    }
    std::printf("%s: at most %g pieces of %d\n", kMaskingNames[static_cast<std::size_t>(masking)], most,
                DOLP_MAX_PIECES);
  }
}

TEST(KernelDataPieces, RandomDirectionsAndIndices_FitTheirRoom) {
  constexpr unsigned kSeed = 20250803;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle_deg(0.0, 90.0);
  std::uniform_real_distribution<double> n(0.01, 0.9999);
  for (const Masking masking : kMaskings) {
    MomentsRequest request;
    request.masking = masking;
    request.shapes = {{0.3, 2.0}};
    for (std::uint32_t i = 0; i < 500; ++i) {
      request.theta_deg.push_back(angle_deg(random));
      request.indices.push_back({n(random), 0.0});
      request.entries.push_back({i, 0U, i});
    }
    for (const kernel::ThetaNode& node : kernel_data(request).thetas) {
      ASSERT_LE(node.piece_count, static_cast<double>(DOLP_MAX_PIECES));
      const std::size_t last = static_cast<std::size_t>(node.piece_count);
      EXPECT_TRUE(std::is_sorted(node.end, node.end + last + 1)) << "c " << node.c;
    }
  }
}

TEST(KernelDataOrders, EveryTolerance_StaysBelowTheDriversLoopLimit) {
  constexpr double kDriverLimit = 65535.0;
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      for (const bool total_reflection : {false, true}) {
        double most = 0.0;
        for (int exponent = 2; exponent <= 10; ++exponent) {
          const double tolerance = std::pow(10.0, -exponent);
          const KernelData data = kernel_data(hard_request(distribution, masking, tolerance, total_reflection));
          const double iterations = worst_iterations(data);
          EXPECT_GT(iterations, 0.0);
          EXPECT_LT(iterations, kDriverLimit) << tolerance;
          for (const kernel::ThetaNode& node : data.thetas) {
            EXPECT_GE(node.order_t, 3.0);
            EXPECT_LE(node.order_limit, static_cast<double>(DOLP_MAX_ORDER));
            EXPECT_GE(node.order_phi, 2.0);
            EXPECT_LE(node.order_phi, static_cast<double>(DOLP_MAX_ORDER));
          }
          most = std::max(most, iterations);
        }
        std::printf("%s %s%s: at most %.0f iterations\n", distribution == Distribution::kCauchy ? "cauchy" : "gaussian",
                    kMaskingNames[static_cast<std::size_t>(masking)], total_reflection ? ", total reflection" : "",
                    most);
      }
    }
  }
}

// Every evaluation of the integrand is an iteration of the innermost loop.
TEST(KernelDataOrders, WorstIterations_BoundTheEvaluationsOfEveryEntry) {
  for (const Masking masking : kMaskings) {
    for (const double tolerance : {1e-2, 1e-4, 1e-10}) {
      double fullest = 0.0;
      for (const SlopeShape& shape : {SlopeShape{1e-3, 1.6}, SlopeShape{0.3, 2.0}, SlopeShape{5.0, 1.6}}) {
        for (const double theta_deg : kHardDirectionsDeg) {
          for (const OpticalConstants& index : {kDielectric, kTotallyReflecting}) {
            MomentsRequest request;
            request.masking = masking;
            request.tolerance = tolerance;
            request.theta_deg = {theta_deg};
            request.shapes = {shape};
            request.indices = {index};
            request.entries = {{0U, 0U, 0U}};
            const KernelData data = kernel_data(request);
            const auto text = make_kernel_text_double(data);
            if (data.needs_masking_table()) text->build_masking_table(0);
            const double evaluations = text->moments(data.entries[0]).evaluations;
            const double bound = worst_iterations(data);
            fullest = std::max(fullest, evaluations / bound);
            EXPECT_LE(evaluations, bound)
                << kMaskingNames[static_cast<std::size_t>(masking)] << " tolerance " << tolerance << " sigma "
                << shape.sigma << " theta " << theta_deg << " n " << index.n;
          }
        }
      }
      std::printf("%s, tolerance %g: at most %.2f of the bound\n", kMaskingNames[static_cast<std::size_t>(masking)],
                  tolerance, fullest);
    }
  }
}

TEST(KernelDataTotalReflection, ItsEntries_HaveDirectionsOfTheirOwn) {
  MomentsRequest request;
  request.theta_deg = {20.0, 70.0};
  request.shapes = {{0.3, 2.0}, {0.6, 3.0}};
  request.indices = {kDielectric, kTotallyReflecting, {0.5, 0.0}};
  // two entries with the same direction and index, one with another index, one with another direction
  request.entries = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 0, 2}, {1, 0, 1}, {1, 1, 0}};
  const KernelData data = kernel_data(request);
  ASSERT_EQ(data.entries.size(), request.entries.size());
  ASSERT_EQ(data.thetas.size(), 5U);
  for (const std::size_t plain : {0U, 5U}) EXPECT_EQ(data.entries[plain].theta, request.entries[plain].theta);
  EXPECT_EQ(data.entries[1].theta, data.entries[2].theta);
  std::vector<std::uint32_t> own = {data.entries[1].theta, data.entries[3].theta, data.entries[4].theta};
  std::sort(own.begin(), own.end());
  EXPECT_EQ(own, (std::vector<std::uint32_t>{2, 3, 4}));
  for (std::size_t i = 0; i < data.entries.size(); ++i) {
    const kernel::ThetaNode& node = data.thetas[data.entries[i].theta];
    EXPECT_EQ(node.c, cos_sin_deg(request.theta_deg[request.entries[i].theta]).cos);
    EXPECT_EQ(data.entries[i].shape, request.entries[i].shape);
    EXPECT_EQ(data.entries[i].index, request.entries[i].index);
  }
  EXPECT_GT(data.thetas[data.entries[1].theta].piece_count, data.thetas[0].piece_count);
  EXPECT_NEAR(data.indices[1].critical_cos, 0.6, kRuleTolerance);
  EXPECT_EQ(data.indices[0].critical_cos, 0.0);
}

template <class Node>
bool same_bytes(const std::vector<Node>& a, const std::vector<Node>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Node)) == 0;
}

TEST(KernelDataOfARequest, Twice_IsTheSame) {
  for (const Masking masking : kMaskings) {
    const MomentsRequest request = hard_request(Distribution::kCauchy, masking, 1e-6, true);
    const KernelData a = kernel_data(request);
    const KernelData b = kernel_data(request);
    EXPECT_TRUE(same_bytes(a.thetas, b.thetas));
    EXPECT_TRUE(same_bytes(a.shapes, b.shapes));
    EXPECT_TRUE(same_bytes(a.indices, b.indices));
    EXPECT_TRUE(same_bytes(a.entries, b.entries));
    EXPECT_TRUE(same_bytes(a.rule_nodes, b.rule_nodes));
    EXPECT_FALSE(same_bytes(a.thetas, kernel_data(hard_request(Distribution::kCauchy, masking, 1e-5, true)).thetas));
  }
}

// ---- The orders, by a scan -----------------------------------------------------------------------------------------

constexpr unsigned kScanSeed = 20250804;
constexpr std::uint32_t kScanEntries = 300;
constexpr double kScanTolerance = 1e-4;

// Entries over the domain of ordinary surfaces: sigma 0.001 to 5, q 1.01 to 45 (smith: from 1.53), theta to 89.9
// degrees, dielectrics and metals.
MomentsRequest scan_request(Distribution distribution, Masking masking) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.tolerance = kScanTolerance;
  std::mt19937 random(kScanSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto logarithmic = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
  const double smallest_q = masking == Masking::kSmith ? 1.53 : 1.01;
  for (std::uint32_t i = 0; i < kScanEntries; ++i) {
    request.theta_deg.push_back(89.9 * unit(random));
    request.shapes.push_back({logarithmic(1e-3, 5.0), 1.0 + logarithmic(smallest_q - 1.0, 44.0)});
    const bool metal = unit(random) < 0.5;
    const double n = metal ? logarithmic(0.2, 30.0) : 1.0 + logarithmic(0.05, 3.0);
    request.indices.push_back({n, metal ? logarithmic(1.0, 100.0) : 0.0});
    request.entries.push_back({i, i, i});
  }
  return request;
}

TEST(PlannedOrders, ScanOfOrdinarySurfaces_MissesTheToleranceRarely) {
  constexpr double kMostMissed = 0.03;
  std::printf("seed %u, %u entries each, tolerance %g\n", kScanSeed, kScanEntries, kScanTolerance);
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      const KernelData data = kernel_data(scan_request(distribution, masking));
      const auto text = make_kernel_text_double(data);
      int missed = 0;
      double evaluations = 0.0;
      double worst = 0.0;
      for (const MomentsEntry& entry : data.entries) {
        if (data.needs_masking_table()) text->build_masking_table(entry.shape);
        const Moments moments = moments_from_kernel(text->moments(entry), data, entry, 0x1p-53);
        ASSERT_GT(moments.r_i, 0.0);
        const double error = std::max(moments.r_i_error, moments.r_q_error) / moments.r_i;
        ASSERT_TRUE(std::isfinite(error) || data.shapes[entry.shape].q_minus_1 <= 0.5);
        if (!(error <= kScanTolerance)) ++missed;
        worst = std::max(worst, error);
        evaluations += moments.evaluations;
      }
      std::printf("%-8s %-8s missed %d, worst estimate %.2g, mean evaluations %.0f\n",
                  distribution == Distribution::kCauchy ? "cauchy" : "gaussian",
                  kMaskingNames[static_cast<std::size_t>(masking)], missed, worst, evaluations / kScanEntries);
      EXPECT_LE(missed, kMostMissed * kScanEntries) << kMaskingNames[static_cast<std::size_t>(masking)];
    }
  }
}

}  // namespace
}  // namespace dolp
