// The shaders' split lines and arcs of azimuth, in float and in double: lines lie where the model says, arcs tile the
// azimuths and integrate what is known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "model/angles.hpp"
#include "physics_text.hpp"
#include "plan/rule.hpp"
#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr unsigned kSeed = 20250802;
constexpr int kPairs = 2000;

// Azimuth rule that is exact to rounding for the smooth integrands here: the nearest poles of 1 / (1 + tau^2) leave
// errors of 3^-40 even on an arc as long as can be.
constexpr int kExactOrder = 20;

constexpr ShapeCase kShape{Distribution::kCauchy, 0.3, 2.0};

// A direction in the text's precision, with the line b = pi/2 of `integral`; the arcs read nothing of its pieces.
template <class Text>
typename Text::ThetaNode direction(double theta_deg) {
  kernel::ThetaNode node{};
  node.c = cos_sin_deg(theta_deg).cos;
  node.s = cos_sin_deg(theta_deg).sin;
  node.has_line = 1.0;
  node.t_growth = 1.0;
  node.phi_narrowing = 1.0;
  node.phi_order = DOLP_MAX_ORDER;
  return theta_in<Text>(node);
}

// The plan's data for one shape and index, with the nodes of all orders.
KernelData whole_data(const ShapeCase& shape, Masking masking, const OpticalConstants& index) {
  KernelData data = data_of(shape, masking, index);
  data.rule_nodes = rule_nodes(DOLP_MAX_ORDER);
  data.rule.largest_order = DOLP_MAX_ORDER;
  return data;
}

// A rule that gives every arc the same order, because no digits are wanted beyond it.
template <class Text>
typename Text::RuleNode rule_of_order(int order) {
  kernel::RuleNode node = rule_node(Masking::kNone, 0.0);
  node.phi_half_nodes = node.phi_centre_nodes = node.phi_circle_nodes = order;
  node.cluster_below_q = 0.0;
  node.largest_order = DOLP_MAX_ORDER;
  return rule_in<Text>(node);
}

// The sums over the azimuths of one slope by arcs of one order.
template <class Text, class Real>
typename Text::AzimuthSums sums_of_order(Text& text, int order, const typename Text::ThetaNode& theta,
                                         const typename Text::ShapeNode& shape, const typename Text::IndexNode& index,
                                         Real slope) {
  const auto group = group_of<Text>(shape);
  return text.azimuth_sums(rule_of_order<Text>(order), theta, group, index, text.looked_up(group, theta.c, theta.s),
                           static_cast<RealOf<Text>>(slope), RealOf<Text>(0));
}

// A random direction and slope: steep, flat, near the normal and near grazing.
template <class Text>
struct Facets {
  typename Text::ThetaNode theta;
  RealOf<Text> slope;
};

template <class Text>
std::vector<Facets<Text>> random_facets() {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle_deg(0.0, 90.0);
  std::uniform_real_distribution<double> log_slope(std::log(1e-4), std::log(1e3));
  std::vector<Facets<Text>> facets;
  for (int i = 0; i < kPairs; ++i) {
    double theta_deg = angle_deg(random);
    if (i % 10 == 0) theta_deg = 90.0 - 1e-3 * theta_deg;
    if (i % 10 == 1) theta_deg = 1e-3 * theta_deg;
    facets.push_back({direction<Text>(theta_deg), static_cast<RealOf<Text>>(std::exp(log_slope(random)))});
  }
  return facets;
}

// The quantities of the model at cos(phi) = x, in double.
struct Facet {
  double c;
  double s;
  double t;

  template <class Text>
  explicit Facet(const Facets<Text>& facets)
      : c(static_cast<double>(facets.theta.c)),
        s(static_cast<double>(facets.theta.s)),
        t(static_cast<double>(facets.slope)) {}
  double e(double x) const { return c + s * t * x; }
  double cos_r(double x) const { return 2.0 * e(x) / (1.0 + t * t) - c; }
  double cos_beta(double x) const { return e(x) / std::sqrt(1.0 + t * t); }
};

template <class Half>
double cosine_of(const Half& half) {
  return (static_cast<double>(half.x) - static_cast<double>(half.y)) *
         (static_cast<double>(half.x) + static_cast<double>(half.y));
}

template <class Half>
double azimuth_of(const Half& half) {
  return 2.0 * std::atan2(static_cast<double>(half.y), static_cast<double>(half.x));
}

// A line lies where `residual`, which rises with cos(phi), vanishes; or at an end of [0, pi] when it does so nowhere.
template <class Half>
double distance_from_zero(const Half& line, const std::function<double(double)>& residual) {
  if (static_cast<double>(line.y) == 0.0) return std::max(0.0, residual(1.0));
  if (static_cast<double>(line.x) == 0.0) return std::max(0.0, -residual(-1.0));
  return std::abs(residual(cosine_of(line)));
}

template <class Text>
class ArcsText : public ::testing::Test {
 protected:
  void SetUp() override { std::printf("seed %u\n", kSeed); }
};
TYPED_TEST_SUITE(ArcsText, Texts, TextNames);

// Cosines are of order 1, and a line's position carries a few roundings and that of c^2 + s^2 = 1.
constexpr double kLineUlps = 6.0;

TYPED_TEST(ArcsText, SplitLines_LieWhereTheModelSays) {
  Worst worst;
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    const KernelData data = whole_data(kShape, masking, {0.8, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    for (const auto& facets : random_facets<TypeParam>()) {
      const auto lines = text.split_lines(facets.theta, index, facets.slope);
      const Facet facet(facets);
      const auto check = [&](const char* name, const auto& line, const std::function<double(double)>& residual) {
        worst.update(distance_from_zero(line, residual),
                     std::string(name) + " c " + std::to_string(facet.c) + " t " + std::to_string(facet.t));
      };
      check("horizon", lines.horizon, [&](double x) { return facet.cos_r(x); });
      const double critical = static_cast<double>(index.critical_cos);
      check("critical", lines.critical, [&](double x) { return facet.cos_beta(x) - critical; });
      if (masking == Masking::kIntegral) {
        check("same zenith", lines.first, [&](double x) { return facet.cos_r(x) - facet.c; });
        // b = pi/2, that is 2 theta_r = pi/2 + alpha, unless theta itself lies lower
        const double limit = std::min(std::cos(0.25 * pi + 0.5 * std::atan(facet.t)), facet.c);
        check("b = 90 degrees", lines.second, [&](double x) { return facet.cos_r(x) - limit; });
      }
      if (masking == Masking::kVCavity) {
        const bool open = facet.t < 1.0;
        check("G(theta) = 1", lines.first,
              [&](double x) { return open ? facet.e(x) - 2.0 * facet.c : facet.cos_r(x) - facet.c; });
        check("G(theta_r) = 1", lines.second,
              [&](double x) { return open ? 2.0 * facet.cos_r(x) - facet.e(x) : facet.cos_r(x) - facet.c; });
      }
    }
  }
  const double allowed = kLineUlps * kEpsilon<TypeParam>;
  std::printf("worst distance %.2g at %s (allowed %.2g)\n", worst.value, worst.where.c_str(), allowed);
  EXPECT_LE(worst.value, allowed) << worst.where;
}

TYPED_TEST(ArcsText, SplitLines_Ascend) {
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    const KernelData data = whole_data(kShape, masking, {1.5, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    for (const auto& facets : random_facets<TypeParam>()) {
      const auto lines = text.split_lines(facets.theta, index, facets.slope);
      const Facet facet(facets);
      // cos(theta_r) of coinciding lines agrees as in the test above; cos(phi) is that over 2 s t / (1 + t^2).
      const double allowed = kLineUlps * kEpsilon<TypeParam> *
                             (1.0 + 0.5 * (1.0 + facet.t * facet.t) / std::max(1e-30, facet.s * facet.t));
      EXPECT_GE(cosine_of(lines.first), cosine_of(lines.second) - allowed) << facet.c << " " << facet.t;
      EXPECT_GE(cosine_of(lines.second), cosine_of(lines.horizon) - allowed) << facet.c << " " << facet.t;
    }
  }
}

// Every facet's projection is reflected, absorbed, hidden or sent below the horizon: over all azimuths it adds up to
// the integral of e, pi cos(theta). That needs arcs that tile [0, phi_m] and integrate cos(phi) exactly.
TYPED_TEST(ArcsText, ReflectedAndNotReflected_AddUpToThePlaneOfAllFacets) {
  Worst worst;
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    for (const OpticalConstants& optical : {OpticalConstants{1.508, 0.0}, OpticalConstants{27.0, 90.0},
                                            OpticalConstants{0.8, 0.0}, OpticalConstants{0.2, 0.0}}) {
      const KernelData data = whole_data(kShape, masking, optical);
      TypeParam text = text_for<TypeParam>(data);
      const auto index = index_in<TypeParam>(data.indices[0]);
      const auto shape = shape_in<TypeParam>(data.shapes[0]);
      if (data.needs_masking_table()) text.build_masking_table(shape, 0U);
      for (const auto& facets : random_facets<TypeParam>()) {
        const auto sums = sums_of_order(text, kExactOrder, facets.theta, shape, index, facets.slope);
        const Facet facet(facets);
        const double total = static_cast<double>(sums.sum[0].r_i) + static_cast<double>(sums.sum[0].deficit);
        const double scale = pi * (facet.c + facet.s * facet.t);
        worst.update(std::abs(total - pi * facet.c) / scale, std::to_string(facet.c) + " t " + std::to_string(facet.t));
      }
    }
  }
  // A sum of up to 120 terms of either sign of rounding, over arcs whose ends are off by those of their lines.
  const double allowed = 10.0 * kEpsilon<TypeParam>;
  std::printf("worst %.2g at c %s (allowed %.2g)\n", worst.value, worst.where.c_str(), allowed);
  EXPECT_LE(worst.value, allowed) << worst.where;
}

// Without masking the albedo is the integral of e up to the horizon; that of v-cavity is e in the middle zone, 2 c
// before it and 2 cos(theta_r) behind it.
TYPED_TEST(ArcsText, Albedo_HasItsClosedForm) {
  for (const Masking masking : {Masking::kNone, Masking::kVCavity}) {
    Worst worst;
    const KernelData data = whole_data(kShape, masking, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    const auto shape = shape_in<TypeParam>(data.shapes[0]);
    for (const auto& facets : random_facets<TypeParam>()) {
      const Facet facet(facets);
      const auto lines = text.split_lines(facets.theta, index, facets.slope);
      const auto integral_of_e = [&](const auto& from, const auto& to) {
        return facet.c * (azimuth_of(to) - azimuth_of(from)) +
               facet.s * facet.t * (std::sin(azimuth_of(to)) - std::sin(azimuth_of(from)));
      };
      const typename TypeParam::ThetaNode& theta = facets.theta;
      const auto forward = decltype(lines.first)(RealOf<TypeParam>(1), RealOf<TypeParam>(0));
      double exact = integral_of_e(forward, lines.horizon);
      if (masking == Masking::kVCavity) {
        exact = 2.0 * facet.c * azimuth_of(lines.first) + integral_of_e(lines.first, lines.second) +
                4.0 / (1.0 + facet.t * facet.t) * integral_of_e(lines.second, lines.horizon) -
                2.0 * facet.c * (azimuth_of(lines.horizon) - azimuth_of(lines.second));
      }
      const auto sums = sums_of_order(text, kExactOrder, theta, shape, index, facets.slope);
      const double scale = pi * (facet.c + facet.s * facet.t);
      worst.update(std::abs(static_cast<double>(sums.sum[0].albedo) - exact) / scale,
                   "c " + std::to_string(facet.c) + " t " + std::to_string(facet.t));
    }
    const double allowed = 10.0 * kEpsilon<TypeParam>;  // as above
    std::printf("worst %.2g at %s (allowed %.2g)\n", worst.value, worst.where.c_str(), allowed);
    EXPECT_LE(worst.value, allowed) << worst.where;
  }
}

// What is seen of the projection of one facet, by the formula of a zone.
template <class Text>
class SeenProjection {
 public:
  SeenProjection(Text& text, const typename Text::ShapeNode& shape, const Facets<Text>& facets)
      : text_(text), shape_(shape), facets_(facets), facet_(facets) {
    if (text.kMasking == DOLP_MASKING_INTEGRAL) {
      shadow_ = masked(text, shape, facets.theta.c, facets.theta.s, facets.slope);
    }
  }

  double operator()(double x, int zone) const {
    using Real = RealOf<Text>;
    const Real cos_r = static_cast<Real>(std::clamp(facet_.cos_r(x), 0.0, 1.0));
    const Real e = static_cast<Real>(facet_.e(x));
    const Real sin_r = std::sqrt((Real(1) - cos_r) * (Real(1) + cos_r));
    const auto group = group_of<Text>(shape_);
    const Real of_ray = text_.masked_direction(group, cos_r, sin_r, facets_.slope, zone > 0).value[0];
    const auto part = text_.project(facets_.theta, e, cos_r, zone, shadow_, of_ray);
    EXPECT_NEAR(static_cast<double>(part.seen + part.hidden), facet_.e(x), 4.0 * kEpsilon<Text> * (1.0 + facet_.e(x)));
    return static_cast<double>(part.seen);
  }

 private:
  Text& text_;
  const typename Text::ShapeNode& shape_;
  const Facets<Text>& facets_;
  Facet facet_;
  RealOf<Text> shadow_{};
};

// The zones' formulas of G meet on their lines: the projection that is seen does not jump.
template <class Text>
void expect_continuous(Masking masking, const ShapeCase& slopes) {
  // Step in cos(phi) on either side of a line, and how fast a projection may change with it.
  const double step = std::sqrt(kEpsilon<Text>);
  constexpr double kSteepest = 20.0;
  constexpr double kTableError = 1e-5;  // of G: 1e-6, and up to ten times that toward grazing
  const KernelData data = whole_data(slopes, masking, {1.508, 0.0});
  Text text = text_for<Text>(data);
  const auto index = index_in<Text>(data.indices[0]);
  const auto shape = shape_in<Text>(data.shapes[0]);
  if (data.needs_masking_table()) text.build_masking_table(shape, 0U);
  int lines_met = 0;
  for (const auto& facets : random_facets<Text>()) {
    const Facet facet(facets);
    const SeenProjection<Text> seen(text, shape, facets);
    const auto lines = text.split_lines(facets.theta, index, facets.slope);
    for (int zone = 0; zone < 2; ++zone) {
      const double x = cosine_of(zone == 0 ? lines.first : lines.second);
      if (std::abs(x) > 1.0 - 2.0 * step || facet.cos_r(x - step) < 0.0) continue;
      ++lines_met;
      const double change = seen(x + step, zone) - seen(x - step, zone + 1);
      EXPECT_LE(std::abs(change), (1.0 + facet.s * facet.t) * (kSteepest * step + kTableError))
          << "zone " << zone << " c " << facet.c << " t " << facet.t << " " << name_of(slopes);
    }
  }
  EXPECT_GT(lines_met, kPairs / 10);
}

TYPED_TEST(ArcsText, Masking_IsContinuousAcrossItsSplitLines) {
  for (const ShapeCase& slopes :
       {ShapeCase{Distribution::kCauchy, 0.3, 2.0}, ShapeCase{Distribution::kCauchy, 0.3, 1.06},
        ShapeCase{Distribution::kCauchy, 0.05, 1.2}, ShapeCase{Distribution::kGaussian, 0.5, 2.0}}) {
    for (const Masking masking : {Masking::kVCavity, Masking::kIntegral}) expect_continuous<TypeParam>(masking, slopes);
  }
}

TYPED_TEST(ArcsText, ClampHalfAngle_IsTheClampOfTheAzimuths) {
  using Real = RealOf<TypeParam>;
  using Half = decltype(TypeParam{}.half_angle(RealOf<TypeParam>(1), RealOf<TypeParam>(1)));
  TypeParam text;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> azimuth(0.0, pi);
  const auto half = [](double phi) {
    return Half(static_cast<Real>(std::cos(0.5 * phi)), static_cast<Real>(std::sin(0.5 * phi)));
  };
  for (int i = 0; i < kPairs; ++i) {
    double from = i % 5 == 0 ? 0.0 : azimuth(random);
    double to = i % 5 == 1 ? from : azimuth(random);
    if (from > to) std::swap(from, to);
    const double phi = i % 7 == 0 ? 0.0 : azimuth(random);
    const Half clamped = text.clamp_half_angle(half(phi), half(from), half(to));
    EXPECT_NEAR(azimuth_of(clamped), std::clamp(phi, from, to), 4.0 * kEpsilon<TypeParam>);
  }
}

TYPED_TEST(ArcsText, CoincidingOrReversedEnds_MakeAnEmptyArc) {
  using Real = RealOf<TypeParam>;
  using Half = decltype(TypeParam{}.half_angle(RealOf<TypeParam>(1), RealOf<TypeParam>(1)));
  TypeParam text;
  const Half forward(Real(1), Real(0));
  const Half side(Real(0.8), Real(0.6));
  const Half back(Real(0), Real(1));
  for (const Half& end : {forward, side, back}) EXPECT_LE(text.make_arc(end, end).quarter, Real(0));
  EXPECT_LT(text.make_arc(side, forward).quarter, Real(0));
  EXPECT_LT(text.make_arc(back, side).quarter, Real(0));
  // and an empty arc adds nothing
  const KernelData data = whole_data(kShape, Masking::kNone, {1.508, 0.0});
  text = text_for<TypeParam>(data);
  const auto slice = typename TypeParam::Slice{Real(0.5), Real(0), {}, Real(0)};
  typename TypeParam::AzimuthSums sums{};
  text.add_arc(rule_of_order<TypeParam>(8), direction<TypeParam>(60.0),
               group_of<TypeParam>(shape_in<TypeParam>(data.shapes[0])), index_in<TypeParam>(data.indices[0]), slice,
               text.make_arc(side, forward), 0, sums);
  EXPECT_EQ(sums.evaluations, Real(0));
  EXPECT_EQ(sums.sum[0].r_i, Real(0));
  EXPECT_EQ(sums.doubt[0], Real(0));
}

TYPED_TEST(ArcsText, MakeArc_HasTheSectionOfItsEnds) {
  using Real = RealOf<TypeParam>;
  using Half = decltype(TypeParam{}.half_angle(RealOf<TypeParam>(1), RealOf<TypeParam>(1)));
  TypeParam text;
  const Half forward(Real(1), Real(0));
  const Half near(Real(0.8), Real(0.6));
  const Half far(Real(0.28), Real(0.96));
  const Half back(Real(0), Real(1));
  EXPECT_EQ(text.make_arc(forward, back).section, 3);
  EXPECT_EQ(text.make_arc(forward, near).section, 2);
  EXPECT_EQ(text.make_arc(far, back).section, 2);
  EXPECT_EQ(text.make_arc(near, far).section, 1);
  for (const bool at_end : {false, true}) EXPECT_EQ(text.make_root_arc(near, far, at_end).section, 4);
}

// ---- Orders --------------------------------------------------------------------------------------------------------

TYPED_TEST(ArcsText, ArcLength_IsAtMostAPercentTooLong) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  for (double quarter = 1e-3; quarter <= 1.0; quarter += 1e-3) {
    const double length = static_cast<double>(text.arc_length(static_cast<Real>(quarter)));
    EXPECT_LE(length, 1.01 * 4.0 * std::atan(quarter)) << quarter;
    EXPECT_GE(length, 0.99 * 4.0 * std::atan(quarter)) << quarter;
  }
}

// A rule of as many nodes as the digits ask for integrates 1 / (x^2 + d^2) over [-1, 1], whose poles are where the
// formula takes them to be, to that many digits and not to many more.
TEST(NodesPerDigit, PolesAtTheDistance_AreIntegratedToTheDigits) {
  using Text = tested_double::Text;
  constexpr double kLostDigits = 1.0;   // a factor in front of rho^-2n
  constexpr double kSpareDigits = 2.0;  // that, and rounding up to whole nodes
  Text text;
  for (const double distance : {0.3, 1.0, 3.0}) {
    const double exact = 2.0 / distance * std::atan(1.0 / distance);
    for (double digits = 2.0; digits <= 10.0; digits += 1.0) {
      const int order = static_cast<int>(std::ceil(digits * text.nodes_per_digit(distance)));
      double sum = 0.0;
      for (const auto& [x, weight] : gauss_legendre(order)) sum += weight / (x * x + distance * distance);
      const double reached = -std::log10(std::max(std::abs(sum / exact - 1.0), 1e-16));
      EXPECT_GE(reached, digits - kLostDigits) << distance << " " << order;
      const double one_node = 1.0 / text.nodes_per_digit(distance);
      EXPECT_LE(reached, digits + kSpareDigits + one_node) << distance << " " << order;
    }
  }
}

TYPED_TEST(ArcsText, OrderBetween_RoundsAndKeepsToItsLimits) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  EXPECT_EQ(text.order_between(Real(7.4), Real(20)), 7);
  EXPECT_EQ(text.order_between(Real(7.6), Real(20)), 8);
  EXPECT_EQ(text.order_between(Real(0.1), Real(20)), 1);
  EXPECT_EQ(text.order_between(Real(-5), Real(20)), 1);
  EXPECT_EQ(text.order_between(Real(1e6), Real(20)), 20);
}

// Nodes are digits * growth, growth falling with each digit given up: the digits lost explain the nodes lost.
TYPED_TEST(ArcsText, LostDigits_AreThoseThatTheLimitDoesNotPayFor) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  for (const double digits : {1.0, 4.0, 9.0, 16.0}) {
    for (const double growth : {1.0, 2.5, 4.0}) {
      for (const double curvature : {0.0, 0.05, 0.2}) {
        const double nodes = 40.0;
        EXPECT_EQ(text.lost_digits(Real(digits), Real(growth), Real(curvature), Real(nodes), Real(nodes)), Real(0));
        double before = 0.0;
        for (const double limit : {39.0, 30.0, 15.0, 4.0}) {
          const double lost = static_cast<double>(
              text.lost_digits(Real(digits), Real(growth), Real(curvature), Real(nodes), Real(limit)));
          EXPECT_GT(lost, before);
          before = lost;
          const bool is_all = growth < curvature * digits;  // the parabola's top comes before its zero
          if (is_all) continue;
          const double left = (digits - lost) * (growth - curvature * lost) / (digits * growth);
          EXPECT_NEAR(left, limit / nodes, 40.0 * kEpsilon<TypeParam> * digits)
              << digits << " " << growth << " " << limit;
        }
      }
    }
  }
}

// Every arc of every direction gets an order between 1 and its limit, and no fewer nodes for more digits.
TYPED_TEST(ArcsText, ArcOrder_GrowsWithTheDigitsWithinItsLimit) {
  using Real = RealOf<TypeParam>;
  constexpr int kLimit = 30;
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    const KernelData data = whole_data(kShape, masking, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    const auto rule = rule_in<TypeParam>(data.rule);
    auto all = random_facets<TypeParam>();
    for (const double theta_deg : {0.0, 1e-6, 90.0}) all.push_back({direction<TypeParam>(theta_deg), Real(0.3)});
    for (const auto& facets : all) {
      const auto lines = text.split_lines(facets.theta, index, facets.slope);
      const auto forward = decltype(lines.first)(Real(1), Real(0));
      const std::array ends = {forward, lines.first, lines.second, lines.horizon};
      for (int zone = 0; zone < 3; ++zone) {
        const auto arc = text.make_arc(ends[static_cast<std::size_t>(zone)], ends[static_cast<std::size_t>(zone) + 1]);
        if (!(arc.quarter > Real(0))) continue;
        int before = 1;
        for (int digits = 0; digits <= 16; ++digits) {
          const auto slice = typename TypeParam::Slice{facets.slope, static_cast<Real>(digits), {}, Real(0)};
          const int order =
              text.order_between(text.arc_nodes(rule, facets.theta, index, slice, arc, zone), Real(kLimit));
          EXPECT_GE(order, before) << "c " << facets.theta.c << " t " << facets.slope << " zone " << zone;
          EXPECT_LE(order, kLimit) << "c " << facets.theta.c << " t " << facets.slope << " zone " << zone;
          before = order;
        }
      }
    }
  }
}

// r_q goes as cos(2 phi) about the normal, which one node cannot tell from a constant.
TYPED_TEST(ArcsText, WholeCircle_HasTheNodesThatItsSecondHarmonicNeeds) {
  using Real = RealOf<TypeParam>;
  const KernelData data = whole_data(kShape, Masking::kNone, {1.508, 0.0});
  TypeParam text = text_for<TypeParam>(data);
  const auto rule = rule_in<TypeParam>(data.rule);
  const auto index = index_in<TypeParam>(data.indices[0]);
  const auto forward = decltype(text.half_angle(Real(1), Real(1)))(Real(1), Real(0));
  const auto back = decltype(forward)(Real(0), Real(1));
  for (const double theta_deg : {0.0, 1e-6, 1e-3, 1.0, 10.0}) {
    for (double digits = 0.0; digits <= 12.0; digits += 0.5) {
      const auto slice = typename TypeParam::Slice{Real(0.1), static_cast<Real>(digits), {}, Real(0)};
      const int order = text.order_between(
          text.arc_nodes(rule, direction<TypeParam>(theta_deg), index, slice, text.make_arc(forward, back), 0),
          Real(64));
      EXPECT_GE(order, 2) << theta_deg << " " << digits;
    }
  }
}

TYPED_TEST(ArcsText, OrderT_GrowsWithDigitsExtentAndRoots) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    kernel::RuleNode node = rule_node(masking, 6.0);
    const auto rule = rule_in<TypeParam>(node);
    const auto theta = direction<TypeParam>(60.0);
    for (double extent = 0.01; extent < 20.0; extent *= 2.0) {
      Real before = Real(2);
      for (int digits = 0; digits <= 16; ++digits) {
        const Real order = text.nodes_t(rule, theta, static_cast<Real>(digits), static_cast<Real>(extent), Real(0));
        EXPECT_GE(order, before);
        EXPECT_GE(text.nodes_t(rule, theta, static_cast<Real>(digits), static_cast<Real>(2.0 * extent), Real(0)),
                  order);
        EXPECT_GE(text.nodes_t(rule, theta, static_cast<Real>(digits), static_cast<Real>(extent), Real(2)), order);
        before = order;
      }
    }
  }
}

// A piece with all facets wants all digits, one with a thousandth three fewer, and an empty one none.
TYPED_TEST(ArcsText, DigitsOfPiece_FallWithTheShareOfTheFacets) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  const KernelData data = whole_data(kShape, Masking::kNone, {1.508, 0.0});
  const auto shape = shape_in<TypeParam>(data.shapes[0]);
  const auto rule = rule_in<TypeParam>(rule_node(Masking::kNone, 8.0));
  constexpr double kLogarithm = 1e-5;  // of a float's ln(1e-3), times its rounding
  for (const double theta_deg : {0.0, 45.0, 89.0}) {
    const auto theta = direction<TypeParam>(theta_deg);
    const auto digits = [&](double mass) {
      return static_cast<double>(
          text.digits_of_piece(rule, theta, shape, Real(0.1), Real(0.2), static_cast<Real>(mass)));
    };
    EXPECT_LE(digits(1.0), 8.0);
    EXPECT_GE(digits(1.0), 7.0);
    EXPECT_NEAR(digits(1e-1) - digits(1e-4), 3.0, kLogarithm);
    EXPECT_EQ(digits(0.0), 0.0);
  }
}

// Smith's L is not smooth where theta_r = 0, the less the nearer the slope is to tan(theta/2).
TYPED_TEST(ArcsText, CuspNodes_GrowTowardTheCuspAndNeedOne) {
  using Real = RealOf<TypeParam>;
  const auto theta = direction<TypeParam>(60.0);
  const double cusp_slope = std::tan(pi / 6.0);
  for (const double q : {2.0, 1.6}) {
    const KernelData data = whole_data({Distribution::kCauchy, 1.0, q}, Masking::kSmith, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto rule = rule_in<TypeParam>(data.rule);
    const auto shape = shape_in<TypeParam>(data.shapes[0]);
    double before = 0.0;
    for (const double away : {10.0, 0.5, 0.1, 0.01, 0.001}) {
      const double nodes = static_cast<double>(text.cusp_nodes(
          rule, theta, shape, static_cast<Real>(cusp_slope * (1.0 + away)), Real(12), static_cast<Real>(pi)));
      EXPECT_TRUE(std::isfinite(nodes));
      if (q == 2.0) {
        EXPECT_EQ(nodes, 0.0);
      } else {
        EXPECT_GT(nodes, before);
      }
      before = nodes;
    }
  }
}

// Where the rule has the nodes that it needs, the null rules' sums vanish beside the sums; with three nodes they do
// not.
TYPED_TEST(ArcsText, NullSums_ShowTooFewNodes) {
  for (const Masking masking : {Masking::kNone, Masking::kVCavity}) {
    const KernelData data = whole_data(kShape, masking, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    const auto shape = shape_in<TypeParam>(data.shapes[0]);
    for (const double theta_deg : {30.0, 60.0, 80.0}) {
      for (const double slope : {0.1, 0.4, 1.0}) {
        const auto theta = direction<TypeParam>(theta_deg);
        const auto fine = sums_of_order(text, 40, theta, shape, index, slope);
        const auto coarse = sums_of_order(text, 3, theta, shape, index, slope);
        const double scale = static_cast<double>(fine.sum[0].r_i);
        if (!(scale > 0.0)) continue;
        // Without digits the doubt of an arc is the geometric mean of sum and null sum, the null weights up to 81 times
        // as large as the weights, of either sign.
        const auto null = [](const auto& sums) {
          return static_cast<double>(sums.doubt[0]) * static_cast<double>(sums.doubt[0]) /
                 static_cast<double>(sums.sum[0].r_i);
        };
        EXPECT_LE(null(fine), 600.0 * kEpsilon<TypeParam> * scale + 1e-12) << theta_deg;
        EXPECT_GE(null(coarse), 0.1 * std::abs(static_cast<double>(coarse.sum[0].r_i) - scale))
            << theta_deg << " " << slope;
        EXPECT_GT(null(coarse), 100.0 * null(fine)) << theta_deg;
      }
    }
  }
}

// Azimuth integral of r_i or r_q of a facet without masking, by a rule for singularities at the ends of an interval.
double double_exponential(tested_double::Text& text, const tested_double::Text::ThetaNode& theta,
                          const tested_double::Text::IndexNode& index, double slope,
                          double tested_double::Text::FacetSums::*member) {
  using Text = tested_double::Text;
  boost::math::quadrature::tanh_sinh<double> rule;
  const auto lines = text.split_lines(theta, index, slope);
  const double horizon = azimuth_of(lines.horizon);
  const double critical = std::min(azimuth_of(lines.critical), horizon);
  const auto integrand = [&](double phi) {
    const double e = theta.c + theta.s * slope * std::cos(phi);
    const double r2 = 1.0 / (1.0 + slope * slope);
    const auto reflected = text.reflection(theta, index, slope, r2, std::cos(phi), std::sin(phi), e);
    return text.facet(reflected, Text::Projection{e, 0.0}).*member;
  };
  double sum = 0.0;
  if (critical > 0.0) sum += rule.integrate(integrand, 0.0, critical);
  if (critical < horizon) sum += rule.integrate(integrand, critical, horizon);
  return sum;
}

// The square roots at the line of total reflection are taken up by the arcs.
TEST(TotalReflection, AzimuthSums_AgreeWithDoubleExponentialQuadrature) {
  using Text = tested_double::Text;
  constexpr double kAllowed = 1e-13;  // rounding of a sum of about 100 terms of order 1 to 10
  Worst worst;
  int with_line = 0;
  for (const double n : {0.8, 0.2}) {
    const KernelData data = whole_data(kShape, Masking::kNone, {n, 0.0});
    Text text = text_for<Text>(data);
    const auto index = index_in<Text>(data.indices[0]);
    const auto shape = shape_in<Text>(data.shapes[0]);
    for (const double theta_deg : {5.0, 30.0, 55.0, 75.0, 87.0}) {
      for (const double slope : {0.02, 0.1, 0.5, 1.0, 3.0}) {
        const auto theta = direction<Text>(theta_deg);
        const auto lines = text.split_lines(theta, index, slope);
        if (cosine_of(lines.critical) < 1.0 && cosine_of(lines.critical) > cosine_of(lines.horizon)) ++with_line;
        const auto sums = sums_of_order(text, DOLP_MAX_ORDER, theta, shape, index, slope);
        for (const auto member : {&Text::FacetSums::r_i, &Text::FacetSums::r_q}) {
          worst.update(
              std::abs(sums.sum[0].*member - double_exponential(text, theta, index, slope, member)),
              "n " + std::to_string(n) + " theta " + std::to_string(theta_deg) + " t " + std::to_string(slope));
        }
      }
    }
  }
  std::printf("%d slopes meet the line; worst error %.2g at %s\n", with_line, worst.value, worst.where.c_str());
  EXPECT_GE(with_line, 10);
  EXPECT_LE(worst.value, kAllowed) << worst.where;
}

}  // namespace
}  // namespace dolp
