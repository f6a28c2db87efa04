// The shaders' split lines and arcs of azimuth, in float and in double: lines lie where the model says, arcs tile the
// azimuths whose ray leaves and integrate what is known, and rules converge as fast as their orders count on.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <complex>
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
constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};

// Azimuth rule that is exact to rounding for the smooth integrands here: the nearest poles of 1 / (1 + tau^2) leave
// errors of 3^-40 even on an arc as long as can be.
constexpr int kExactOrder = 20;

constexpr ShapeCase kShape{Distribution::kCauchy, 0.3, 2.0};

template <class Text>
typename Text::ThetaNode direction(double theta_deg) {
  kernel::ThetaNode node{};
  node.c = cos_sin_deg(theta_deg).cos;
  node.s = cos_sin_deg(theta_deg).sin;
  return theta_in<Text>(node);
}

// The plan's data for one shape and index, with the nodes of all orders.
KernelData whole_data(const ShapeCase& shape, Masking masking, const OpticalConstants& index) {
  KernelData data = data_of(shape, masking, index);
  data.rule_nodes = rule_nodes(DOLP_MAX_ORDER);
  data.rule_order = DOLP_MAX_ORDER;
  return data;
}

// A rule of so many nodes and digits of its own: without nodes an order is what the digits cost, with more than enough
// of them all arcs have the most nodes that a slope allows.
kernel::RuleNode rule_of_nodes(double nodes, const kernel::RuleNode& strips = {}) {
  kernel::RuleNode rule = strips;
  rule.t_nodes = rule.phi_nodes = nodes;
  rule.t_digits = rule.phi_digits = 0.0;
  rule.cluster_below_q = 0.0;
  rule.cluster_stretch = 1.0;
  return rule;
}

constexpr double kMoreThanEnough = 1e6;  // digits of a rule

// The sums over the azimuths of one slope by arcs of one order.
template <class Text>
typename Text::AzimuthSums sums_of_order(Text& text, int order, const typename Text::ThetaNode& theta,
                                         const typename Text::ShapeNode& shape, const typename Text::IndexNode& index,
                                         RealOf<Text> t, double digits = 0.0) {
  const auto row = row_of<Text>(shape);
  auto of_theta = text.masking_of_direction(row, theta.c, theta.s);
  if (text.kMasking == DOLP_MASKING_INTEGRAL) of_theta = text.shadows(row, of_theta, theta.c, theta.s, t);
  const typename Text::Slope slope{t, static_cast<RealOf<Text>>(digits), of_theta, true, order, false};
  auto rule = rule_of_nodes(0.0);
  rule.phi_digits = kMoreThanEnough;
  return text.azimuth_sums(rule_in<Text>(rule), theta, row, index, slope,
                           text.split_lines({}, theta, index, t, true, 0));
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
  for (const Masking masking : kMaskings) {
    const KernelData data = whole_data(kShape, masking, {0.8, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    for (const auto& facets : random_facets<TypeParam>()) {
      const auto lines = text.split_lines({}, facets.theta, index, facets.slope, true, 0);
      const Facet facet(facets);
      const auto check = [&](const char* name, const auto& line, const std::function<double(double)>& residual) {
        worst.update(distance_from_zero(line, residual),
                     std::string(name) + " c " + std::to_string(facet.c) + " t " + std::to_string(facet.t));
      };
      check("horizon", lines.horizon, [&](double x) { return facet.cos_r(x); });
      const double critical = static_cast<double>(index.critical_cos);
      check("critical", lines.critical, [&](double x) { return facet.cos_beta(x) - critical; });
      if (masking == Masking::kIntegral) {
        check("same zenith", lines.end[0], [&](double x) { return facet.cos_r(x) - facet.c; });
        // b = pi/2, that is 2 theta_r = pi/2 + alpha, unless theta itself lies lower
        const double limit = std::min(std::cos(0.25 * pi + 0.5 * std::atan(facet.t)), facet.c);
        check("b = 90 degrees", lines.end[1], [&](double x) { return facet.cos_r(x) - limit; });
      }
      if (masking == Masking::kVCavity) {
        const bool open = facet.t < 1.0;
        check("G(theta) = 1", lines.end[0],
              [&](double x) { return open ? facet.e(x) - 2.0 * facet.c : facet.cos_r(x) - facet.c; });
        check("G(theta_r) = 1", lines.end[1],
              [&](double x) { return open ? 2.0 * facet.cos_r(x) - facet.e(x) : facet.cos_r(x) - facet.c; });
      }
    }
  }
  const double allowed = kLineUlps * kEpsilon<TypeParam>;
  std::printf("worst distance %.2g at %s (allowed %.2g)\n", worst.value, worst.where.c_str(), allowed);
  EXPECT_LE(worst.value, allowed) << worst.where;
}

TYPED_TEST(ArcsText, SplitLines_Ascend) {
  for (const Masking masking : kMaskings) {
    const KernelData data = whole_data(kShape, masking, {1.5, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    for (const auto& facets : random_facets<TypeParam>()) {
      const auto lines = text.split_lines({}, facets.theta, index, facets.slope, true, 0);
      const Facet facet(facets);
      // cos(theta_r) of coinciding lines agrees as in the test above; cos(phi) is that over 2 s t / (1 + t^2).
      const double allowed = kLineUlps * kEpsilon<TypeParam> *
                             (1.0 + 0.5 * (1.0 + facet.t * facet.t) / std::max(1e-30, facet.s * facet.t));
      EXPECT_GE(cosine_of(lines.end[0]), cosine_of(lines.end[1]) - allowed) << facet.c << " " << facet.t;
      EXPECT_GE(cosine_of(lines.end[1]), cosine_of(lines.horizon) - allowed) << facet.c << " " << facet.t;
    }
  }
}

// What of a facet's projection reflects upward is seen or hidden: over all arcs it adds up to the integral of e up to
// the horizon, so that arcs tile those azimuths and no others. Without masking all is seen; of v-cavity e in the middle
// zone, 2 c before it and 2 cos(theta_r) behind it.
TYPED_TEST(ArcsText, Arcs_CoverTheAzimuthsWhoseRayLeaves) {
  Worst worst;
  for (const Masking masking : kMaskings) {
    for (const OpticalConstants& optical : {OpticalConstants{1.508, 0.0}, OpticalConstants{27.0, 90.0},
                                            OpticalConstants{0.8, 0.0}, OpticalConstants{0.2, 0.0}}) {
      const KernelData data = whole_data(kShape, masking, optical);
      TypeParam text = text_for<TypeParam>(data);
      const auto index = index_in<TypeParam>(data.indices[0]);
      const auto shape = shape_in<TypeParam>(data.shapes[0]);
      if (data.needs_masking_table()) text.build_masking_table(shape, 0U);
      for (const auto& facets : random_facets<TypeParam>()) {
        const Facet facet(facets);
        const auto sums = sums_of_order(text, kExactOrder, facets.theta, shape, index, facets.slope).member[0];
        const auto lines = text.split_lines({}, facets.theta, index, facets.slope, true, 0);
        const auto integral_of_e = [&](double from, double to) {
          return facet.c * (to - from) + facet.s * facet.t * (std::sin(to) - std::sin(from));
        };
        const double first = azimuth_of(lines.end[0]);
        const double second = azimuth_of(lines.end[1]);
        const double horizon = azimuth_of(lines.horizon);
        const double scale = pi * (facet.c + facet.s * facet.t);
        const std::string where =
            name_of(masking) + std::string(" c ") + std::to_string(facet.c) + " t " + std::to_string(facet.t);
        worst.update(std::abs(static_cast<double>(sums.x + sums.w) - integral_of_e(0.0, horizon)) / scale, where);
        double seen = integral_of_e(0.0, horizon);
        if (masking == Masking::kVCavity) {
          seen = 2.0 * facet.c * first + integral_of_e(first, second) +
                 4.0 / (1.0 + facet.t * facet.t) * integral_of_e(second, horizon) - 2.0 * facet.c * (horizon - second);
        } else if (masking != Masking::kNone) {
          continue;
        }
        worst.update(std::abs(static_cast<double>(sums.z) - seen) / scale, where + " albedo");
      }
    }
  }
  // A sum of up to 120 terms of either sign of rounding, over arcs whose ends are off by those of their lines.
  const double allowed = 10.0 * kEpsilon<TypeParam>;
  std::printf("worst %.2g at %s (allowed %.2g)\n", worst.value, worst.where.c_str(), allowed);
  EXPECT_LE(worst.value, allowed) << worst.where;
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
    typename Text::Facet facet{};
    facet.e = static_cast<Real>(facet_.e(x));
    facet.cos_r = static_cast<Real>(std::clamp(facet_.cos_r(x), 0.0, 1.0));
    const Real of_ray = text_.masking_of_ray(row_of<Text>(shape_), facet.cos_r, facets_.slope, zone).value[0];
    const auto part = text_.project(facets_.theta, facet, zone, shadow_, of_ray);
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
    const auto lines = text.split_lines({}, facets.theta, index, facets.slope, true, 0);
    for (int zone = 0; zone < 2; ++zone) {
      const double x = cosine_of(zone == 0 ? lines.end[0] : lines.end[1]);
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

TYPED_TEST(ArcsText, MakeArc_HasTheSectionOriginAndSpanOfItsEnds) {
  using Real = RealOf<TypeParam>;
  using Half = decltype(TypeParam{}.half_angle(RealOf<TypeParam>(1), RealOf<TypeParam>(1)));
  TypeParam text;
  constexpr double kAllowed = 8.0 * kEpsilon<TypeParam>;  // of angles up to pi
  const auto half = [](double phi) {
    return Half(static_cast<Real>(std::cos(0.5 * phi)), static_cast<Real>(std::sin(0.5 * phi)));
  };
  const Half forward(Real(1), Real(0));
  const Half back(Real(0), Real(1));
  const Half near = half(0.7);
  const Half far = half(2.1);
  const auto expect = [&](const auto& arc, int section, double origin, double span) {
    EXPECT_EQ(arc.section, section);
    EXPECT_NEAR(static_cast<double>(arc.origin), origin, kAllowed);
    EXPECT_NEAR(static_cast<double>(arc.span), span, kAllowed);
  };
  expect(text.make_arc(forward, back), TypeParam::kSectionCircle, 0.0, pi);
  expect(text.make_arc(forward, near), TypeParam::kSectionHalf, 0.0, 0.7);
  expect(text.make_arc(far, back), TypeParam::kSectionHalf, pi, pi - 2.1);
  expect(text.make_arc(near, far), TypeParam::kSectionCentre, 0.7, 1.4);
  expect(text.make_root_arc(near, far, false), TypeParam::kSectionCluster, 0.7, 1.4);
  expect(text.make_root_arc(near, far, true), TypeParam::kSectionCluster, 2.1, 1.4);
  EXPECT_TRUE(text.is_before(near, far));
  for (const Half& end : {forward, near, back}) EXPECT_FALSE(text.is_before(end, end));
  EXPECT_FALSE(text.is_before(back, near));
}

// Whatever its section, an arc's nodes lie on it and their weights add up to its length.
TYPED_TEST(ArcsText, Azimuths_LieOnTheirArcAndWeighItsLength) {
  using Real = RealOf<TypeParam>;
  using Half = decltype(TypeParam{}.half_angle(RealOf<TypeParam>(1), RealOf<TypeParam>(1)));
  TypeParam text = text_for<TypeParam>(whole_data(kShape, Masking::kNone, {1.508, 0.0}));
  constexpr double kAllowed = 20.0 * kEpsilon<TypeParam>;  // sums of kExactOrder terms
  const auto half = [](double phi) {
    return phi == pi ? Half(Real(0), Real(1))
                     : Half(static_cast<Real>(std::cos(0.5 * phi)), static_cast<Real>(std::sin(0.5 * phi)));
  };
  for (const auto& [from, to] :
       {std::array{0.0, pi}, std::array{0.0, 1.1}, std::array{1.1, pi}, std::array{0.4, 2.9}}) {
    for (const int root : {-1, 0, 1}) {
      const auto arc =
          root < 0 ? text.make_arc(half(from), half(to)) : text.make_root_arc(half(from), half(to), root == 1);
      double length = 0.0;
      for (int i = 0; i < kExactOrder; ++i) {
        const auto at =
            text.azimuth(arc, text.place_on_arc(arc, text.rule_node(text.rule_offset(arc.section, kExactOrder) + i)));
        // Beyond pi the integrand is what it is before.
        const double phi = std::abs(std::atan2(static_cast<double>(at.sin_phi), static_cast<double>(at.x)));
        EXPECT_GE(phi, from - kAllowed);
        EXPECT_LE(phi, to + kAllowed);
        length += static_cast<double>(at.weight);
      }
      EXPECT_NEAR(length, to - from, kAllowed) << from << " " << to << " " << root;
    }
  }
}

// A square root that absorption has smoothed, Re sqrt(x + i eps) and sqrt(x^2 + eps^2), which the cluster alone misses.
TEST(PlaceOnArc, SmoothedRoots_AreIntegratedToManyDigits) {
  using Text = tested_double::Text;
  constexpr double kAllowed = 1e-12;
  constexpr int kOrder = 48;
  Text text = text_for<Text>(whole_data(kShape, Masking::kNone, {0.8, 0.0}));
  ASSERT_TRUE(text.kTotalReflection);
  Text::Arc arc{};
  arc.section = Text::kSectionCluster;
  const int first = text.rule_offset(arc.section, kOrder);
  for (const double eps : {1e-8, 1e-5, 1e-3, 0.1, 1.0}) {
    const auto summed = [&](double resolution, const std::function<double(double)>& f) {
      arc.resolution = resolution;
      double sum = 0.0;
      for (int i = 0; i < kOrder; ++i) {
        const auto node = text.place_on_arc(arc, text.rule_node(first + i));
        sum += node.y * f(node.x);
      }
      return sum;
    };
    const std::complex<double> i_eps(0.0, eps);
    const double of_root = (2.0 / 3.0 * (std::pow(1.0 + i_eps, 1.5) - std::pow(i_eps, 1.5))).real();
    const double of_modulus = 0.5 * (std::hypot(1.0, eps) + eps * eps * std::asinh(1.0 / eps));
    const auto root = [&](double x) { return std::sqrt(x + i_eps).real(); };
    const auto modulus = [&](double x) { return std::hypot(x, eps); };
    EXPECT_NEAR(summed(eps, [](double) { return 1.0; }), 1.0, kAllowed) << eps;
    EXPECT_NEAR(summed(eps, root), of_root, kAllowed) << eps;
    EXPECT_NEAR(summed(eps, modulus), of_modulus, kAllowed) << eps;
    if (eps == 1e-5) {
      EXPECT_GT(std::abs(summed(0.0, root) - of_root), 100.0 * kAllowed);
    }
  }
}

// ---- Orders --------------------------------------------------------------------------------------------------------

TYPED_TEST(ArcsText, OrderBetween_RoundsAndKeepsToItsLimits) {
  using Real = RealOf<TypeParam>;
  TypeParam text;
  for (const auto& [nodes, order] : {std::array{7.4, 7.0}, std::array{7.6, 8.0}, std::array{0.1, 1.0},
                                     std::array{-5.0, 1.0}, std::array{1e6, 20.0}}) {
    EXPECT_EQ(text.order_between(static_cast<Real>(nodes), 20), static_cast<int>(order)) << nodes;
  }
}

// Two equal rules would say that there is no error.
TEST(CoarseOrder, AnyOrder_IsAnother) {
  tested_double::Text text;
  for (int order = 1; order <= DOLP_MAX_ORDER; ++order) {
    const int coarse = text.coarse_order(order);
    EXPECT_NE(coarse, order);
    EXPECT_GE(coarse, 2);  // one node tells nothing apart
    EXPECT_LE(coarse, DOLP_MAX_ORDER);
    if (coarse < order) {
      EXPECT_NEAR(coarse, kCoarseShare * order, 0.51) << order;
    }
  }
}

TEST(SingularityAt, AnyCosine_IsItsComplexArcCosine) {
  constexpr double kAllowed = 1e-6;
  constexpr int kDraws = 20'000;
  tested_double::Text text;
  std::mt19937 random(kSeed);
  std::printf("seed %u\n", kSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < kDraws; ++i) {
    const double size = std::pow(10.0, 8.0 * unit(random) - 5.0);
    const double a = i % 2 == 0 ? 2.0 * unit(random) - 1.0 : (i % 4 == 1 ? 1.0 : -1.0) * (1.0 + size);
    const double b = i % 10 < 2 ? 0.0 : std::pow(10.0, 8.0 * unit(random) - 5.0);
    const auto at = text.singularity_at(a, b);
    const std::complex<double> exact = std::acos(std::complex<double>(a, b));
    EXPECT_NEAR(at.re, exact.real(), kAllowed) << a << " " << b;
    EXPECT_NEAR(at.im, std::abs(exact.imag()), kAllowed * std::max(1.0, std::abs(exact.imag()))) << a << " " << b;
  }
}

constexpr double kFirstDigit = 3.0;
constexpr double kLastDigit = 13.0;

// Digits that a node adds to a sum, between the orders at which its error is small and at which it is rounding. Of two
// neighbouring orders the worse counts, because single errors may vanish by chance. 0: too few orders to tell.
template <class Error>
double digits_per_node(const Error& error) {
  const double small = std::pow(10.0, -kFirstDigit);
  const double rounding = std::pow(10.0, -kLastDigit);
  constexpr int kMostNodes = 60;
  constexpr int kLeastNodes = 4;
  std::vector<double> digits;
  for (int order = 2; order <= kMostNodes; ++order) {
    const double worse = std::max(error(order), error(order + 1));
    if (worse < rounding) break;
    if (worse < small) digits.push_back(-std::log10(worse));
  }
  if (digits.size() <= kLeastNodes) return 0.0;
  return (digits.back() - digits.front()) / static_cast<double>(digits.size() - 1);
}

// Digits gained per node over what orders.glsl says, of many arcs or pieces. The law is asymptotic; what stands before
// it changes the digits by a part of one, and a rare one happens upon it.
class SharesOfLaw {
 public:
  void add(double gained, double cost, const std::string& where) {
    if (gained <= 0.0) return;
    shares_.push_back(gained * cost);
    worst_.update(1.0 / shares_.back(), where);
  }
  void expect_at_least(double least, std::size_t count) {
    std::printf("%zu sums, least share of the law %.2f at %s\n", shares_.size(), 1.0 / worst_.value,
                worst_.where.c_str());
    ASSERT_GE(shares_.size(), count);
    std::ranges::sort(shares_);
    EXPECT_GE(shares_[shares_.size() / 100], least) << worst_.where;
    EXPECT_GE(shares_.front(), kRareShare * least) << worst_.where;
  }

 private:
  static constexpr double kRareShare = 0.8;
  std::vector<double> shares_;
  Worst worst_;
};

constexpr double kLeastShare = 0.75;
// The law knows where the poles of the cauchy's density lie but not their order, q; and a root beside an end, which
// counts as the end's own, leaves a singularity behind.
constexpr double kLeastShareOfPieces = 0.65;
// The gaussian has no singularity: nodes for its fall stand in for one, and no more of them than it falls in all, so
// that the last digits get too few.
constexpr double kLeastShareWithoutSingularity = 0.5;

constexpr double kManyDigits = 1000.0;  // beside which what a rule has whatever its digits is nothing

// Larger error of r_i and r_q over the albedo.
template <class Sums>
double error_of(const Sums& sums, const Sums& exact) {
  return std::max(std::abs(sums.x - exact.x), std::abs(sums.y - exact.y)) / exact.z;
}

// Without masking an arc is smooth.
TEST(ArcCost, SmoothArcs_GainTheDigitsPerNodeThatItSays) {
  using Text = tested_double::Text;
  SharesOfLaw shares;
  for (const OpticalConstants& optical :
       {OpticalConstants{1.508, 0.0}, OpticalConstants{4.0, 0.0}, OpticalConstants{2.0, 0.7},
        OpticalConstants{27.0, 90.0}, OpticalConstants{0.3, 2.0}}) {
    const KernelData data = whole_data(kShape, Masking::kNone, optical);
    Text text = text_for<Text>(data);
    const auto index = index_in<Text>(data.indices[0]);
    const auto row = row_of<Text>(shape_in<Text>(data.shapes[0]));
    const auto rule = rule_in<Text>(rule_of_nodes(0.0));
    for (double theta_deg = 5.0; theta_deg < 90.0; theta_deg += 6.5) {
      for (double t = 0.03; t < 5.0; t *= 1.4) {
        const auto theta = direction<Text>(theta_deg);
        const auto lines = text.split_lines({}, theta, index, t, false, 0);
        const auto forward = decltype(lines.horizon)(1.0, 0.0);
        if (!text.is_before(forward, lines.horizon)) continue;
        const auto arc = text.make_arc(forward, lines.horizon);
        const Text::Slope slope{t, kManyDigits, text.unmasked(), false, DOLP_MAX_ORDER, false};
        const auto sums = [&](int order) {
          return text.arc_sums({}, theta, row, index, slope, arc, 0, true, order).member[0];
        };
        const auto exact = sums(DOLP_MAX_ORDER);
        const double gained = digits_per_node([&](int order) { return error_of(sums(order), exact); });
        const double nodes = text.arc_nodes(rule, theta, row.shape[0], index, false, t, kManyDigits, arc, 0);
        shares.add(
            gained, nodes / kManyDigits,
            "n " + std::to_string(optical.n) + " theta " + std::to_string(theta_deg) + " t " + std::to_string(t));
      }
    }
  }
  shares.expect_at_least(kLeastShare, 300);
}

// The pieces of one direction and shape, with the azimuths summed to rounding.
template <class Add>
void measure_pieces(KernelData data, const Add& add) {
  using Text = tested_double::Text;
  constexpr double kAzimuths = 60.0;
  data.rule_nodes = rule_nodes(DOLP_MAX_ORDER);
  data.rule_order = DOLP_MAX_ORDER;
  Text text = text_for<Text>(data);
  const auto theta = theta_in<Text>(data.thetas[0]);
  const auto index = index_in<Text>(data.indices[0]);
  const auto row = row_of<Text>(shape_in<Text>(data.shapes[0]));
  const auto full = rule_in<Text>(rule_of_nodes(kAzimuths, data.rule));
  for (std::uint32_t i = 0; i < piece_count(data, 0, data.shapes[0]); ++i) {
    auto task = text.with_slopes(text.task_of(task_word(data.pieces[0], i, 1)), theta);
    task.most_azimuths = DOLP_MAX_ORDER;
    auto piece = text.make_piece(full, theta, row, index, task);
    const auto nodes = [&](double digits) {
      piece.digits = digits;
      // of nodes beyond the least, so that the digits' own count
      return text.slope_nodes(rule_in<Text>(rule_of_nodes(2.0, data.rule)), theta, row.shape[0], index, false, piece);
    };
    // Of the digits that digits_per_node looks at: how far the density's fall has to be resolved grows with them, to an
    // end.
    const double cost = (nodes(kLastDigit) - nodes(kFirstDigit)) / (kLastDigit - kFirstDigit);
    const auto sums = [&](int order) {
      piece.order = order;
      piece.digits = 0.0;
      return text.piece_sums(full, theta, row, index, task, piece, text.unmasked(), false).member[0];
    };
    const auto exact = sums(DOLP_MAX_ORDER);
    const double gained = digits_per_node([&](int order) { return error_of(sums(order), exact); });
    add(gained, cost);
  }
}

TEST(PieceCost, Pieces_GainTheDigitsPerNodeThatItSays) {
  SharesOfLaw cauchy;
  SharesOfLaw gaussian;
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    for (const SlopeShape& slopes :
         {SlopeShape{0.1, 2.0}, SlopeShape{0.3, 3.5}, SlopeShape{0.7, 1.5}, SlopeShape{0.5, 8.0}}) {
      for (double theta_deg = 4.0; theta_deg < 90.0; theta_deg += 4.5) {
        MomentsRequest request = request_of({distribution, slopes.sigma, slopes.q}, Masking::kNone, {2.0, 0.7});
        request.theta_deg = {theta_deg};
        request.tolerance = 1e-12;
        const std::string where =
            name_of({distribution, slopes.sigma, slopes.q}) + " theta " + std::to_string(theta_deg);
        measure_pieces(kernel_data(request), [&](double gained, double cost) {
          (distribution == Distribution::kGaussian ? gaussian : cauchy).add(gained, cost, where);
        });
      }
    }
  }
  cauchy.expect_at_least(kLeastShareOfPieces, 100);
  gaussian.expect_at_least(kLeastShareWithoutSingularity, 50);
}

// Every arc gets more nodes for more digits, and the whole circle never fewer than the two that its second harmonic
// needs.
TYPED_TEST(ArcsText, ArcNodes_GrowWithTheDigits) {
  using Real = RealOf<TypeParam>;
  for (const Masking masking : kMaskings) {
    const KernelData data = whole_data(kShape, masking, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    const auto shape = shape_in<TypeParam>(data.shapes[0]);
    const auto rule = rule_in<TypeParam>(data.rule);
    auto all = random_facets<TypeParam>();
    for (const double theta_deg : {0.0, 1e-6, 90.0}) all.push_back({direction<TypeParam>(theta_deg), Real(0.3)});
    for (const auto& facets : all) {
      const auto lines = text.split_lines({}, facets.theta, index, facets.slope, true, 0);
      const auto forward = decltype(lines.horizon)(Real(1), Real(0));
      const std::array ends = {forward, lines.end[0], lines.end[1], lines.horizon};
      for (int zone = 0; zone < 3; ++zone) {
        const auto from = ends[static_cast<std::size_t>(zone)];
        const auto to = ends[static_cast<std::size_t>(zone) + 1];
        if (!text.is_before(from, to)) continue;
        Real before = Real(0);
        for (int digits = 0; digits <= 20; ++digits) {
          const auto arc = text.make_arc(from, to);
          const Real nodes = text.arc_nodes(rule, facets.theta, shape, index, true, facets.slope,
                                            static_cast<Real>(digits), arc, zone);
          EXPECT_TRUE(std::isfinite(nodes) && nodes >= before)
              << "c " << facets.theta.c << " t " << facets.slope << " zone " << zone;
          if (arc.section == TypeParam::kSectionCircle) {
            EXPECT_GE(nodes, Real(2));
          }
          before = nodes;
        }
      }
    }
  }
}

// A piece with all facets wants all digits, one with a thousandth of another's three fewer, and an empty one none.
TYPED_TEST(ArcsText, DigitsOfPiece_FallWithTheShareOfTheFacets) {
  using Real = RealOf<TypeParam>;
  const KernelData data = whole_data(kShape, Masking::kNone, {1.508, 0.0});
  TypeParam text = text_for<TypeParam>(data);
  const auto shape = shape_in<TypeParam>(data.shapes[0]);
  kernel::RuleNode node{};
  node.digits = 8.0;
  constexpr double kLogarithm = 1e-5;  // of a float's ln(1e-3), times its rounding
  for (const double theta_deg : {0.0, 45.0, 89.0}) {
    const auto digits = [&](double mass) {
      return static_cast<double>(text.digits_of_piece(rule_in<TypeParam>(node), direction<TypeParam>(theta_deg), shape,
                                                      Real(0.1), Real(0.2), static_cast<Real>(mass)));
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
  for (const double q : {2.0, 1.6}) {
    const KernelData data = whole_data({Distribution::kCauchy, 1.0, q}, Masking::kSmith, {1.508, 0.0});
    TypeParam text = text_for<TypeParam>(data);
    const auto index = index_in<TypeParam>(data.indices[0]);
    const auto shape = shape_in<TypeParam>(data.shapes[0]);
    double before = 0.0;
    for (const double away : {1.0, 0.3, 0.1, 0.01}) {
      const Real t = static_cast<Real>(std::tan(pi / 6.0) * (1.0 + away));
      const auto lines = text.split_lines({}, theta, index, t, true, 0);
      const auto arc = text.make_arc(decltype(lines.horizon)(Real(1), Real(0)), lines.horizon);
      const double nodes = static_cast<double>(text.cusp_nodes(theta, shape, t, Real(12), arc));
      EXPECT_TRUE(q == 2.0 ? nodes == 0.0 : nodes > before) << q << " " << away;
      before = nodes;
    }
  }
}

// Azimuth integrals of r_i and r_q of a facet without masking: adaptive, in the root of the distance from the critical
// line.
std::array<double, 2> adaptive_integrals(tested_double::Text& text, const tested_double::Text::ThetaNode& theta,
                                         const tested_double::Text::IndexNode& index, double slope) {
  const auto lines = text.split_lines({}, theta, index, slope, false, 0);
  const double horizon = azimuth_of(lines.horizon);
  const double critical = std::min(azimuth_of(lines.critical), horizon);
  const auto integral = [&](auto member) {
    double sum = 0.0;
    for (const double length : {-critical, horizon - critical}) {
      const auto integrand = [&](double v) {
        const double phi = critical + length * v * v;
        const auto f = text.facet(theta, index, slope, std::cos(phi), std::sin(phi));
        return 2.0 * v * std::abs(length) * f.e * f.*member;
      };
      if (length != 0.0)
        sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, 0.0, 1.0, 15, 1e-14);
    }
    return sum;
  };
  return {integral(&tested_double::Text::Facet::m00), integral(&tested_double::Text::Facet::m01)};
}

// The square roots at the line of total reflection are taken up by the arcs, sharp or smoothed by absorption.
TEST(TotalReflection, AzimuthSums_AgreeWithAdaptiveQuadrature) {
  using Text = tested_double::Text;
  constexpr double kAllowed = 1e-12;  // rounding of a sum of about 100 terms of order 1 to 10
  constexpr double kAllDigits = 16.0;
  Worst worst;
  int with_line = 0;
  for (const OpticalConstants& optical : {OpticalConstants{0.8, 0.0}, OpticalConstants{0.2, 0.0},
                                          OpticalConstants{0.8, 1e-3}, OpticalConstants{0.5, 0.05}}) {
    const KernelData data = whole_data(kShape, Masking::kNone, optical);
    Text text = text_for<Text>(data);
    const auto index = index_in<Text>(data.indices[0]);
    const auto shape = shape_in<Text>(data.shapes[0]);
    for (const double theta_deg : {5.0, 30.0, 55.0, 75.0, 87.0}) {
      for (const double slope : {0.02, 0.1, 0.5, 1.0, 3.0}) {
        const auto theta = direction<Text>(theta_deg);
        const auto lines = text.split_lines({}, theta, index, slope, false, 0);
        if (cosine_of(lines.critical) < 1.0 && cosine_of(lines.critical) > cosine_of(lines.horizon)) ++with_line;
        const auto sums = sums_of_order(text, DOLP_MAX_ORDER, theta, shape, index, slope, kAllDigits).member[0];
        const auto exact = adaptive_integrals(text, theta, index, slope);
        const std::string where = "n " + std::to_string(optical.n) + " k " + std::to_string(optical.k) + " theta " +
                                  std::to_string(theta_deg) + " t " + std::to_string(slope);
        worst.update(std::abs(sums.x - exact[0]), where + " r_i");
        worst.update(std::abs(sums.y - exact[1]), where + " r_q");
      }
    }
  }
  std::printf("%d slopes meet the line; worst error %.2g at %s\n", with_line, worst.value, worst.where.c_str());
  EXPECT_GE(with_line, 20);
  EXPECT_LE(worst.value, kAllowed) << worst.where;
}

}  // namespace
}  // namespace dolp
