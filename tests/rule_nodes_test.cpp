// The Gauss rules that the kernel reads: abscissae and weights integrate what they should.
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
using Nodes = std::vector<std::array<double, 2>>;

// Sections of shaders/physics/quadrature.glsl.
constexpr int kGauss = 0;
constexpr int kCentre = 1;
constexpr int kHalf = 2;
constexpr int kCircle = 3;
constexpr int kCluster = 4;

// Abscissae and weights carry a rounding or two each; a polynomial of size 1 and degree d oscillates d times and feels
// the abscissae's as often.
constexpr double kRuleTolerance = 1e-15;
double rule_tolerance(int degree) { return kRuleTolerance * (1.0 + 0.1 * degree); }

// Chebyshev polynomial T_k: of size 1 on [-1, 1], so that no degree hides behind another.
double chebyshev(int k, double x) {
  return static_cast<double>(std::cos(k * std::acos(std::clamp(static_cast<long double>(x), -1.0L, 1.0L))));
}

// Integral of T_k over [-1, 1].
double chebyshev_integral(int k) { return k % 2 == 1 ? 0.0 : 2.0 / (1.0 - static_cast<double>(k) * k); }

// Sum of the weights times the values of a function at the nodes.
template <class Function>
double summed(const Nodes& nodes, const Function& function) {
  long double sum = 0.0L;
  for (const auto& [x, weight] : nodes) sum += static_cast<long double>(weight) * function(x);
  return static_cast<double>(sum);
}

// The rule of one order in one section of rule_nodes(largest_order).
Nodes section_of(const Nodes& nodes, int largest_order, int section, int order) {
  const int first = section * largest_order * (largest_order + 1) / 2 + order * (order - 1) / 2;
  return {nodes.begin() + first, nodes.begin() + first + order};
}

Nodes section_rule(int section, int order) {
  return section_of(rule_nodes(DOLP_MAX_ORDER), DOLP_MAX_ORDER, section, order);
}

TEST(GaussLegendre, EveryOrder_IntegratesPolynomialsOfDegree2nMinus1) {
  double worst = 0.0;
  for (int order = 1; order <= 2 * DOLP_MAX_ORDER; ++order) {
    const auto rule = gauss_legendre(order);
    ASSERT_EQ(rule.size(), static_cast<std::size_t>(order));
    for (int degree = 0; degree < 2 * order; ++degree) {
      const double sum = summed(rule, [&](double x) { return chebyshev(degree, x); });
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

// What a section's rule of `order` nodes integrates: the functions of each number below `exact`, and their integrals.
struct Basis {
  int section;
  const char* name;
  int (*exact)(int order);
  double (*function)(int number, double x);
  double (*integral)(int number);
};

constexpr std::array<Basis, 5> kBases{{
    {kGauss, "polynomials on [0, 1]", [](int order) { return 2 * order; },
     [](int degree, double x) { return chebyshev(degree, 2.0 * x - 1.0); },
     [](int degree) { return 0.5 * chebyshev_integral(degree); }},
    {kCentre, "polynomials on [-1, 1]", [](int order) { return 2 * order; }, chebyshev, chebyshev_integral},
    {kHalf, "even polynomials on [0, 1]", [](int order) { return 2 * order; },
     [](int half_degree, double x) { return chebyshev(2 * half_degree, x); },
     [](int half_degree) { return 0.5 * chebyshev_integral(2 * half_degree); }},
    // With the measure that quadrature.glsl gives the abscissae tan(psi/4).
    {kCircle, "cosines over the half circle", [](int order) { return 2 * order; },
     [](int harmonic, double tau) { return 4.0 / (1.0 + tau * tau) * std::cos(harmonic * 4.0 * std::atan(tau)); },
     [](int harmonic) { return harmonic == 0 ? pi : 0.0; }},
    {kCluster, "polynomials in the root", [](int order) { return 2 * order - 1; },
     [](int power, double x) { return std::pow(x, 0.5 * power); }, [](int power) { return 2.0 / (power + 2.0); }},
}};

TEST(RuleNodes, EverySection_IntegratesItsFunctions) {
  for (const Basis& basis : kBases) {
    // The half's polynomials have twice the degree, the circle's function has the measure 4.
    const double scale = basis.section == kHalf ? 2.0 : (basis.section == kCircle ? 4.0 : 1.0);
    double worst = 0.0;
    for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
      const Nodes rule = section_rule(basis.section, order);
      for (int number = 0; number < basis.exact(order); ++number) {
        const double sum = summed(rule, [&](double x) { return basis.function(number, x); });
        worst = std::max(worst, std::abs(sum - basis.integral(number)) / (scale * rule_tolerance(number)));
      }
    }
    std::printf("%s: worst error %.2f of what is allowed\n", basis.name, worst);
    EXPECT_LE(worst, 1.0) << basis.name;
  }
}

}  // namespace
}  // namespace dolp
