// The Gauss rules that the kernel reads: abscissae and weights integrate what they should, and the null weights take
// out the coefficients that they claim.
#include "plan/rule_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Nodes = std::vector<std::array<double, 4>>;

// Sections of shaders/physics/quadrature.glsl.
constexpr int kGauss = 0;
constexpr int kCentre = 1;
constexpr int kHalf = 2;
constexpr int kCircle = 3;
constexpr int kCluster = 4;
constexpr int kSections = 5;

// Abscissae and weights carry a rounding or two each; a polynomial of size 1 and degree d oscillates d times and feels
// the abscissae's as often.
constexpr double kRuleTolerance = 1e-15;
double rule_tolerance(int degree) { return kRuleTolerance * (1.0 + 0.1 * degree); }

// A null weight of degree k is 2k + 1 times as large as the weight, and its polynomial feels the abscissae's roundings
// k times, as does the polynomial of degree j that it is applied to.
double null_tolerance(int k, int j) { return 0.3 * kRuleTolerance * (2.0 * k + 1.0) * (1.0 + 0.1 * (k + j)); }

// Chebyshev polynomial T_k: of size 1 on [-1, 1], so that no degree hides behind another.
double chebyshev(int k, double x) {
  return static_cast<double>(std::cos(k * std::acos(std::clamp(static_cast<long double>(x), -1.0L, 1.0L))));
}

// Integral of T_k over [-1, 1].
double chebyshev_integral(int k) { return k % 2 == 1 ? 0.0 : 2.0 / (1.0 - static_cast<double>(k) * k); }

double legendre(int k, double x) { return std::legendre(static_cast<unsigned>(k), std::clamp(x, -1.0, 1.0)); }

// Sum of the values of a function at the nodes times one of their weights: 1 the weight, 2 and 3 the null weights.
template <class Node, class Function>
double apply(const std::vector<Node>& nodes, std::size_t weight, const Function& function) {
  long double sum = 0.0L;
  for (const Node& node : nodes) sum += static_cast<long double>(node[weight]) * function(node[0]);
  return static_cast<double>(sum);
}

// The rule of one order in one section of rule_nodes(largest_order).
Nodes section_of(const Nodes& nodes, int largest_order, int section, int order) {
  const int first = section * largest_order * (largest_order + 1) / 2 + order * (order - 1) / 2;
  return {nodes.begin() + first, nodes.begin() + first + order};
}

Nodes section_rule(int section, int order) {
  static const Nodes nodes = rule_nodes(DOLP_MAX_ORDER);
  return section_of(nodes, DOLP_MAX_ORDER, section, order);
}

// ---- Weights -------------------------------------------------------------------------------------------------------

TEST(GaussLegendre, EveryOrder_IntegratesPolynomialsOfDegree2nMinus1) {
  double worst = 0.0;
  for (int order = 1; order <= 2 * DOLP_MAX_ORDER; ++order) {
    const auto rule = gauss_legendre(order);
    ASSERT_EQ(rule.size(), static_cast<std::size_t>(order));
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = apply(rule, 1, [&](double x) { return chebyshev(degree, x); });
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
  const double sum = apply(gauss_legendre(3), 1, [](double x) { return std::pow(x, 6); });
  EXPECT_GT(std::abs(sum - 2.0 / 7.0), 1e-3);
}

TEST(RuleNodes, AllSections_AreThereAndDependOnTheirOrderAlone) {
  constexpr int kFew = 7;
  const Nodes few = rule_nodes(kFew);
  EXPECT_EQ(few.size(), static_cast<std::size_t>(kSections * kFew * (kFew + 1) / 2));
  EXPECT_EQ(rule_nodes(DOLP_MAX_ORDER).size(),
            static_cast<std::size_t>(kSections * DOLP_MAX_ORDER * (DOLP_MAX_ORDER + 1) / 2));
  for (int section = 0; section < kSections; ++section) {
    for (int order = 1; order <= kFew; ++order) {
      EXPECT_EQ(section_of(few, kFew, section, order), section_rule(section, order)) << section << " " << order;
    }
  }
}

TEST(RuleNodes, Gauss_IntegratesPolynomialsOnTheUnitInterval) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum =
          apply(section_rule(kGauss, order), 1, [&](double x) { return chebyshev(degree, 2.0 * x - 1.0); });
      EXPECT_NEAR(sum, 0.5 * chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

TEST(RuleNodes, Centre_IntegratesPolynomialsOnTheSymmetricInterval) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = apply(section_rule(kCentre, order), 1, [&](double x) { return chebyshev(degree, x); });
      EXPECT_NEAR(sum, chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

TEST(RuleNodes, Half_IntegratesEvenPolynomialsOfDegree4nMinus2) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int degree = 0; degree < 4 * order; degree += 2) {
      const double sum = apply(section_rule(kHalf, order), 1, [&](double x) { return chebyshev(degree, x); });
      EXPECT_NEAR(sum, 0.5 * chebyshev_integral(degree), rule_tolerance(degree)) << order << " " << degree;
    }
  }
}

// The half circle's integral of cos(harmonic psi), with the measure that quadrature.glsl gives its abscissae.
double circle_cosine(double tau, int harmonic) {
  return 4.0 / (1.0 + tau * tau) * std::cos(harmonic * 4.0 * std::atan(tau));
}

TEST(RuleNodes, Circle_IntegratesCosinesOverTheHalfCircle) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int harmonic = 0; harmonic < 2 * order; ++harmonic) {
      const double sum =
          apply(section_rule(kCircle, order), 1, [&](double tau) { return circle_cosine(tau, harmonic); });
      EXPECT_NEAR(sum, harmonic == 0 ? pi : 0.0, 4.0 * rule_tolerance(harmonic)) << order << " " << harmonic;
    }
  }
}

TEST(RuleNodes, Cluster_IntegratesPolynomialsInTheSquareRoot) {
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    for (int power = 0; power < 2 * order - 1; ++power) {
      const double sum = apply(section_rule(kCluster, order), 1, [&](double x) { return std::pow(x, 0.5 * power); });
      EXPECT_NEAR(sum, 2.0 / (power + 2.0), rule_tolerance(power)) << order << " " << power;
    }
  }
}

// ---- Null weights --------------------------------------------------------------------------------------------------

// What a null weight of a section is to be: for each order the degrees whose coefficients it adds up, and the measure
// of the section's interval.
struct NullRule {
  int section;
  std::size_t weight;
  double measure;
};

// Applies it to the basis function of each degree from 0 to the highest that the nodes tell apart; `basis(degree, x)`
// is what the rule integrates, `has(order, degree)` whether the coefficient of that degree is claimed.
template <class Basis, class Has>
void expect_coefficients(const NullRule& rule, int step, const Basis& basis, const Has& has) {
  double worst = 0.0;
  for (int order = 2; order <= DOLP_MAX_ORDER; ++order) {
    const Nodes nodes = section_rule(rule.section, order);
    const int highest = step * (order - 1);
    for (int degree = 0; degree <= highest; degree += step) {
      const double value = apply(nodes, rule.weight, [&](double x) { return basis(degree, x); });
      const double exact = has(order, degree) ? rule.measure : 0.0;
      const double allowed = rule.measure * null_tolerance(highest, degree);
      EXPECT_NEAR(value, exact, allowed) << "order " << order << " degree " << degree;
      worst = std::max(worst, std::abs(value - exact) / allowed);
    }
  }
  std::printf("worst error %.2f of what is allowed\n", worst);
}

// Both of the two highest degrees beside the mean, which no null weight may see.
bool is_one_of_two_highest(int highest, int step, int degree) {
  return degree > 0 && (degree == highest || degree == highest - step);
}

TEST(NullWeights, GaussFirst_IsTheCoefficientOfTheHighestDegree) {
  expect_coefficients(
      {kGauss, 2, 1.0}, 1, [](int degree, double x) { return legendre(degree, 2.0 * x - 1.0); },
      [](int order, int degree) { return degree == order - 1; });
}

TEST(NullWeights, GaussSecond_IsTheCoefficientOfTheDegreeBelow) {
  expect_coefficients(
      {kGauss, 3, 1.0}, 1, [](int degree, double x) { return legendre(degree, 2.0 * x - 1.0); },
      [](int order, int degree) { return order > 2 && degree == order - 2; });
}

TEST(NullWeights, Centre_IsTheSumOfTheTwoHighestCoefficients) {
  expect_coefficients(
      {kCentre, 2, 2.0}, 1, [](int degree, double x) { return legendre(degree, x); },
      [](int order, int degree) { return is_one_of_two_highest(order - 1, 1, degree); });
}

TEST(NullWeights, Half_IsTheSumOfTheTwoHighestEvenCoefficients) {
  expect_coefficients(
      {kHalf, 2, 1.0}, 2, [](int degree, double x) { return legendre(degree, x); },
      [](int order, int degree) { return is_one_of_two_highest(2 * order - 2, 2, degree); });
}

TEST(NullWeights, Circle_IsTheSumOfTheTwoHighestHarmonicsButTheSecond) {
  expect_coefficients(
      {kCircle, 2, pi}, 1, [](int harmonic, double tau) { return circle_cosine(tau, harmonic); },
      [](int order, int degree) { return degree != 2 && is_one_of_two_highest(order - 1, 1, degree); });
}

// Of the function of v = sqrt(x) that the rule sees, f(v^2) v: the square root in the measure belongs to the integrand.
TEST(NullWeights, Cluster_IsTheSumOfTheTwoHighestCoefficientsInTheSquareRoot) {
  const auto basis = [](int degree, double x) {
    const double v = std::sqrt(x);
    return legendre(degree, 2.0 * v - 1.0) / v;
  };
  expect_coefficients({kCluster, 2, 2.0}, 1, basis,
                      [](int order, int degree) { return is_one_of_two_highest(order - 1, 1, degree); });
}

// A rule of one node tells nothing apart: on the azimuth all that it adds up is in doubt.
TEST(NullWeights, OneNode_DoubtsTheWholeSum) {
  for (const int section : {kCentre, kHalf, kCircle, kCluster}) {
    const std::array<double, 4> node = section_rule(section, 1).at(0);
    EXPECT_EQ(node[2], node[1]) << section;
  }
}

TEST(NullWeights, SectionsOfTheAzimuth_HaveNoSecond) {
  for (const int section : {kCentre, kHalf, kCircle, kCluster}) {
    for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
      for (const std::array<double, 4>& node : section_rule(section, order)) EXPECT_EQ(node[3], 0.0);
    }
  }
}

// What a null rule leaves of exp(x / 2) falls like the coefficients of its expansion, (x/2)^n / n! and faster; of
// |x|, whose coefficients fall like a power, it leaves far more.
TEST(NullWeights, SmoothIntegrand_LeavesNothingAndAKinkDoes) {
  const Nodes nodes = section_rule(kCentre, 12);
  EXPECT_LE(std::abs(apply(nodes, 2, [](double x) { return std::exp(0.5 * x); })), 1e-11);
  EXPECT_GE(std::abs(apply(nodes, 2, [](double x) { return std::abs(x); })), 1e-3);
}

}  // namespace
}  // namespace dolp
