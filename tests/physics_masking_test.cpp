// The shaders' masking table, and the G1 of `integral` and the Lambda of smith that are read from it, in float and in
// double, against direct integration.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "evaluate/reference/attenuation.hpp"
#include "evaluate/reference/slopes.hpp"
#include "model/angles.hpp"
#include "physics_text.hpp"

namespace dolp {
namespace {

using reference::IntegralMasking;
using reference::Slopes;
using reference::Zenith;
using std::numbers::pi;

// What the plan states of an albedo of 1 whose two rules agree, at a tolerance of 0 and without a cut: the table's
// interpolation and rounding.
double stated_of_tables(KernelData data, double unit_roundoff) {
  data.tolerance = 0.0;
  data.shapes[0].cut = data.thetas[data[0].theta].end[DOLP_MAX_PIECES];
  kernel::MomentsNode node{};
  node.albedo = 1.0;
  return moments_from_kernel(node, data, data[0], unit_roundoff).albedo_error;
}

constexpr double kReferenceTolerance = 1e-13;

std::vector<ShapeCase> shape_cases(Masking masking) {
  std::vector<double> exponents = {1.53, 1.6, 2.0, 3.5, 10.0, 45.0, 100.0};
  if (masking == Masking::kIntegral) exponents.insert(exponents.end(), {1.01, 1.06, 1.2, 1.45, 1.5});
  std::vector<ShapeCase> cases;
  for (const double sigma : {1e-3, 0.01, 0.1, 0.3, 0.905, 2.0, 5.0}) {
    for (const double q : exponents) cases.push_back({Distribution::kCauchy, sigma, q});
    cases.push_back({Distribution::kGaussian, sigma, 2.0});
  }
  return cases;
}

// A text with the table of one shape, for directions and slopes in double that the text's precision holds exactly.
template <class Text>
class Table {
 public:
  using Real = RealOf<Text>;

  Table(const ShapeCase& shape, Masking masking) {
    const KernelData data = data_of(shape, masking);
    stated_ = stated_of_tables(data, 0.5 * kEpsilon<Text>);
    text_ = text_for<Text>(data);
    node_ = shape_in<Text>(data.shapes[0]);
    text_.build_masking_table(node_, 0U);
  }

  double shadowed(const CosSin& zenith, double slope) {
    return static_cast<double>(
        masked(text_, node_, static_cast<Real>(zenith.cos), static_cast<Real>(zenith.sin), static_cast<Real>(slope)));
  }
  double height_at_0() const { return static_cast<double>(text_.masking_node(0U).x); }
  double lambda(const CosSin& zenith) {
    return static_cast<double>(
        masked(text_, node_, static_cast<Real>(zenith.cos), static_cast<Real>(zenith.sin), Real(0)));
  }
  double stated() const { return stated_; }
  const typename Text::ShapeNode& node() const { return node_; }

 private:
  double stated_ = 0.0;
  Text text_;
  typename Text::ShapeNode node_;
};

template <class Text>
CosSin rounded_direction(double theta_deg) {
  using Real = RealOf<Text>;
  const CosSin a = cos_sin_deg(theta_deg);
  return {static_cast<double>(static_cast<Real>(a.cos)), static_cast<double>(static_cast<Real>(a.sin))};
}

Zenith zenith_of(const CosSin& a) {
  const double length = std::hypot(a.cos, a.sin);
  return {std::atan2(a.cos, a.sin), a.cos / length, a.sin / length};
}

std::vector<double> directions_deg() {
  return {0.0,  1e-6, 1e-3, 0.1,  3.0,  12.857142857, 18.0, 30.0, 44.9, 45.1,
          55.0, 63.0, 71.0, 78.0, 83.0, 87.0,         89.0, 89.9, 89.99};
}

const std::vector<double> kSlopeAnglesDeg = {1e-4, 0.1, 2.0, 9.0, 20.0, 31.0, 45.0, 58.0, 70.0, 80.0, 88.0, 89.9};

// A heavy tail reaches beyond the end of its table, where the tail is a power law; pointwise that is felt here, 2e-10
// of G1 at facets and directions next to the horizon, while no moment in double is (tests/accuracy_test.cpp).
constexpr double kBeyondTheTable = 2e-10;
constexpr double kHeavyTailQ = 1.1;
constexpr double kHeavyTailSmithQ = 1.7;
constexpr double kBesideTheNormalDeg = 1e-4;
double end_error(const ShapeCase& shape) {
  return shape.distribution == Distribution::kCauchy && shape.q < kHeavyTailQ ? kBeyondTheTable : 0.0;
}

// G1 counts for the lower of two directions, and a facet steeper than its zenith angle reflects it to a lower one yet:
// there the table's end may show, where heavy tails have not ended.
constexpr double kUnusedError = 1e-6;
double unused(double theta_deg, double alpha_deg) { return alpha_deg > theta_deg ? kUnusedError : 0.0; }

// `integral` with both the direction and the facet within w of the horizontal and the vertical, w the width of the
// slopes: 1 - G1 is kappa ~ 1 / (cot(theta) + t) times a difference of nearly equal heights l ~ l(0) ~ w, whose own
// errors it amplifies. That is pointwise only: over the facets of any shape kappa l(0) has a mean near 1.
constexpr double kHeightRoundings = 8.0;
template <class Text>
double allowed_error(const Table<Text>& table, const ShapeCase& shape, const CosSin& zenith, double slope) {
  const double kappa = zenith.sin * std::hypot(1.0, slope) / (zenith.cos + zenith.sin * slope);
  return end_error(shape) + table.stated() +
         kappa * table.height_at_0() * (table.stated() + kHeightRoundings * 0.5 * kEpsilon<Text>);
}

template <class Text>
class MaskingText : public ::testing::Test {};
TYPED_TEST_SUITE(MaskingText, Texts, TextNames);

TYPED_TEST(MaskingText, IntegralG1_AgreesWithDirectIntegration) {
  using Real = RealOf<TypeParam>;
  Worst worst;
  Worst worst_share;
  for (const ShapeCase& shape : shape_cases(Masking::kIntegral)) {
    Table<TypeParam> table(shape, Masking::kIntegral);
    const Slopes slopes(shape.distribution, shape.sigma, shape.q);
    for (const double theta_deg : directions_deg()) {
      const CosSin a = rounded_direction<TypeParam>(theta_deg);
      const IntegralMasking exact(slopes, zenith_of(a), kReferenceTolerance);
      for (const double alpha_deg : kSlopeAnglesDeg) {
        const double slope = static_cast<double>(static_cast<Real>(std::tan(alpha_deg * pi / 180.0)));
        const double error = std::abs((1.0 - table.shadowed(a, slope)) - exact(std::atan(slope)));
        const std::string where =
            name_of(shape) + " theta " + std::to_string(theta_deg) + " alpha " + std::to_string(alpha_deg);
        const double allowed = allowed_error(table, shape, a, slope) + unused(theta_deg, alpha_deg);
        EXPECT_LE(error, allowed) << where;
        worst.update(error, where);
        worst_share.update(error / allowed, where);
      }
    }
  }
  std::printf("worst share of what is allowed %.2f at %s\n", worst_share.value, worst_share.where.c_str());
  std::printf("worst error of G1 %.2g at %s\n", worst.value, worst.where.c_str());
}

TYPED_TEST(MaskingText, SmithLambda_AgreesWithTheClosedForm) {
  Worst worst;
  Worst worst_share;
  for (const ShapeCase& shape : shape_cases(Masking::kSmith)) {
    Table<TypeParam> table(shape, Masking::kSmith);
    const Slopes slopes(shape.distribution, shape.sigma, shape.q);
    for (const double theta_deg : directions_deg()) {
      const CosSin a = rounded_direction<TypeParam>(theta_deg);
      const double exact = reference::smith_lambda(slopes, zenith_of(a));
      // relative error of G1 = 1 / (1 + Lambda); that of G is no larger
      const double error = std::abs(table.lambda(a) - exact) / (1.0 + exact);
      const std::string where = name_of(shape) + " theta " + std::to_string(theta_deg);
      // Next to the normal the table ends before cot(theta).
      const double beyond = theta_deg < kBesideTheNormalDeg && shape.q < kHeavyTailSmithQ ? kBeyondTheTable : 0.0;
      const double allowed = beyond + table.stated();
      EXPECT_LE(error, allowed) << where;
      worst.update(error, where);
      worst_share.update(error / allowed, where);
    }
  }
  std::printf("worst share of what is allowed %.2f at %s\n", worst_share.value, worst_share.where.c_str());
  std::printf("worst relative error of G1 %.2g at %s\n", worst.value, worst.where.c_str());
}

TYPED_TEST(MaskingText, GrazingDirection_HidesHalfForIntegralAndAllForSmith) {
  for (const ShapeCase& shape :
       {ShapeCase{Distribution::kCauchy, 0.3, 2.0}, ShapeCase{Distribution::kGaussian, 0.905, 2.0}}) {
    // At 90 degrees a = 0, b = alpha: G1 = 1/2 + p(0) alpha/2 + O(alpha^3), what is left being the facets below 0.
    constexpr double kSlope = 1e-3;
    Table<TypeParam> integral(shape, Masking::kIntegral);
    const CosSin grazing = cos_sin_deg(90.0);
    const double density = static_cast<double>(integral.node().marginal_norm);
    EXPECT_NEAR(integral.shadowed(grazing, kSlope), 0.5 - 0.5 * density * kSlope,
                kSlope * kSlope * kSlope / shape.sigma + allowed_error(integral, shape, grazing, kSlope));
    Table<TypeParam> smith(shape, Masking::kSmith);
    EXPECT_GT(smith.lambda(cos_sin_deg(90.0)), 1e20);
    EXPECT_LE(smith.lambda(cos_sin_deg(0.0)), smith.stated());
  }
}

}  // namespace
}  // namespace dolp
