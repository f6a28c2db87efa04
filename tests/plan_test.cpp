// The plan: digits and orders for a tolerance, loop bounds, error bounds and what the cut leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "evaluate/text/text.hpp"
#include "model/angles.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr std::array kHardDirectionsDeg = {0.0,  1e-6, 12.857142857, 12.9, 18.0,  30.0, 30.2,
                                           44.9, 45.0, 45.1,         60.0, 89.99, 90.0};
constexpr OpticalConstants kDielectric{1.508, 0.0};
constexpr OpticalConstants kTotallyReflecting{0.8, 0.0};

// An algebraic expression of a few operations.
constexpr double kRounding = 1e-15;
constexpr double kDoubleRoundoff = 0x1p-53;

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
  request.sigma = {0.3, 1e-3, 5.0};
  request.q = {2.0, 1.6, 45.0};
  request.indices = {kDielectric, {27.0, 90.0}};
  if (total_reflection) {
    for (const double n : {0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1}) request.indices.push_back({n, 0.0});
  }
  return request;
}

// All loops of an invocation count toward what a driver allows.
constexpr double kDriverLimit = 65535.0;

TEST(KernelDataOrders, EveryTolerance_StaysBelowTheDriversLoopLimit) {
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      for (const bool total_reflection : {false, true}) {
        double most = 0.0;
        for (int exponent = 2; exponent <= 15; ++exponent) {
          const double tolerance = std::pow(10.0, -exponent);
          const KernelData data = kernel_data(hard_request(distribution, masking, tolerance, total_reflection));
          const double iterations = worst_iterations(data);
          EXPECT_GT(iterations, 0.0);
          EXPECT_LT(iterations, kDriverLimit) << tolerance;
          const auto order = static_cast<std::size_t>(data.rule_order);
          for (const Pieces& pieces : data.pieces) {
            EXPECT_GE(pieces.most_nodes[0], 40U);
            EXPECT_LE(pieces.most_nodes[0], order);
          }
          EXPECT_LE(order, static_cast<std::size_t>(DOLP_MAX_ORDER));
          constexpr std::size_t kSections = 5;  // of shaders/physics/quadrature.glsl
          EXPECT_EQ(data.rule_nodes.size(), kSections * order * (order + 1) / 2);
          most = std::max(most, iterations);
        }
        std::printf("%s %s%s: at most %.0f iterations\n", name_of(distribution), name_of(masking),
                    total_reflection ? ", total reflection" : "", most);
      }
    }
  }
}

// With all bounces in grooves the bound is that of each piece, and what runs in lockstep has the same.
TEST(KernelDataOrders, AllBounces_StayBelowTheDriversLoopLimit) {
  for (const bool total_reflection : {false, true}) {
    for (int exponent = 2; exponent <= 15; ++exponent) {
      MomentsRequest request =
          hard_request(Distribution::kCauchy, Masking::kVCavity, std::pow(10.0, -exponent), total_reflection);
      request.scattering = Scattering::kMultiple;
      const KernelData data = kernel_data(request);
      EXPECT_LT(worst_iterations(data), kDriverLimit) << exponent;
      for (const Pieces& pieces : data.pieces) {
        for (std::uint32_t i = 0; i < pieces.count; ++i) EXPECT_GE(pieces.most_nodes[i], 20U) << exponent;
      }
    }
  }
}

// One loop over the nodes, in each of which a small Gauss rule, which is read from the nodes of the moments' rules even
// when no moments are asked for.
TEST(MaskingTable, ItsLoops_StayBelowTheDriversLimitAndHaveTheirNodes) {
  constexpr int kTableOrderAtMost = 8;
  EXPECT_LT(DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE) * (1.0 + kTableOrderAtMost), kDriverLimit);
  MomentsRequest request;
  request.sigma = {0.3};
  request.q = {2.0};
  request.indices = {kDielectric};
  EXPECT_GE(kernel_data(request).rule_order, kTableOrderAtMost);
}

// What the kernel in double says of one entry.
struct Computed {
  KernelData data;
  kernel::MomentsNode node;
  Moments moments() const { return moments_from_kernel(node, data, data[0], kDoubleRoundoff); }
};

MomentsRequest request_of(Masking masking, double tolerance, double theta_deg, const SlopeShape& shape,
                          const OpticalConstants& index, Distribution distribution) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.tolerance = tolerance;
  request.append({theta_deg, shape, index});
  return request;
}

Computed computed(Masking masking, double tolerance, double theta_deg, const SlopeShape& shape,
                  const OpticalConstants& index, Distribution distribution = Distribution::kCauchy) {
  Computed result{kernel_data(request_of(masking, tolerance, theta_deg, shape, index, distribution)), {}};
  const auto text = make_kernel_text_double(result.data);
  if (result.data.needs_masking_table()) text->build_masking_table(0);
  result.node = text->moments(result.data[0]);
  return result;
}

// Every evaluation of the integrand is an iteration of the innermost loop of one of the pieces.
TEST(KernelDataOrders, WorstIterations_BoundTheEvaluationsOfEveryPiece) {
  for (const Masking masking : kMaskings) {
    double fullest = 0.0;
    for (const double tolerance : {1e-2, 1e-4, 1e-8, 1e-12}) {
      for (const SlopeShape& shape : {SlopeShape{1e-3, 1.6}, SlopeShape{0.3, 2.0}, SlopeShape{5.0, 1.6}}) {
        for (const double theta_deg : kHardDirectionsDeg) {
          for (const OpticalConstants& index : {kDielectric, kTotallyReflecting}) {
            const Computed entry = computed(masking, tolerance, theta_deg, shape, index);
            const double pieces = piece_count(entry.data, entry.data[0].theta, entry.data.shapes[0]);
            const double invocations = entry.data.needs_masking_table() ? pieces : 2.0 * pieces * entry.data.rule_order;
            const double bound = invocations * worst_iterations(entry.data);
            fullest = std::max(fullest, entry.node.evaluations / bound);
            EXPECT_LE(entry.node.evaluations, bound)
                << name_of(masking) << " tolerance " << tolerance << " sigma " << shape.sigma << " theta " << theta_deg;
          }
        }
      }
    }
    std::printf("%s: at most %.2f of the bound\n", name_of(masking), fullest);
  }
}

// Where the nodes of an arc are cut down, the bound says what that costs.
TEST(KernelDataOrders, EntryWithTooFewNodesAllowed_SaysSo) {
  for (const Masking masking : kMaskings) {
    const Computed whole = computed(masking, 1e-9, 60.0, {0.3, 2.0}, kTotallyReflecting);
    KernelData data = whole.data;
    for (const std::uint32_t most : {9U, 11U}) {
      data.pieces[data[0].theta].most_nodes.fill(static_cast<std::uint8_t>(most));
      const auto text = make_kernel_text_double(data);
      if (data.needs_masking_table()) text->build_masking_table(0);
      const kernel::MomentsNode node = text->moments(data[0]);
      EXPECT_LE(node.evaluations, whole.node.evaluations);
      const Moments moments = moments_from_kernel(node, data, data[0], kDoubleRoundoff);
      EXPECT_GE(moments.r_i_error, std::abs(moments.r_i - whole.moments().r_i)) << most;
      EXPECT_GE(moments.r_q_error, std::abs(moments.r_q - whole.moments().r_q)) << most;
    }
  }
}

// ---- Error bounds --------------------------------------------------------------------------------------------------

// The bound of a moment is at least the distance between the two rules, and never less than a share of the tolerance;
// what is better known of r_i and the deficit gives the other.
TEST(MomentsFromKernel, Bounds_AreNoLessThanTheDistanceOfTheRules) {
  const Computed entry = computed(Masking::kNone, 1e-4, 60.0, {0.3, 5.0}, kDielectric);
  kernel::MomentsNode node = entry.node;
  const auto bounds = [&] { return moments_from_kernel(node, entry.data, entry.data[0], kDoubleRoundoff); };
  node.reflected_difference = node.albedo_difference = node.deficit_difference = 0.0;
  const Moments agreed = bounds();
  EXPECT_GT(agreed.r_i_error, 0.0);
  EXPECT_LT(agreed.r_i_error, 1e-4 * agreed.r_i);
  constexpr double kDistance = 1e-3;
  node.reflected_difference = kDistance;
  EXPECT_GE(bounds().r_q_error, kDistance);
  EXPECT_GE(bounds().albedo_error, kDistance);
  EXPECT_EQ(bounds().r_i_error, bounds().deficit_error);
  EXPECT_NEAR(bounds().r_i + bounds().deficit, 0.5, kRounding);
  node.deficit_difference = 2.0 * kDistance;
  EXPECT_GE(bounds().r_i_error, kDistance);
  EXPECT_GE(bounds().deficit_error, kDistance);
  EXPECT_EQ(bounds().r_i, node.r_i);
}

TEST(AddPiece, EveryMember_IsTheSum) {
  kernel::MomentsNode sum{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  add_piece(sum, {10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130});
  const kernel::MomentsNode expected{11, 22, 33, 44, 55, 66, 77, 88, 99, 110, 121, 132, 143};
  EXPECT_EQ(std::memcmp(&sum, &expected, sizeof sum), 0);
}

// ---- Rules ---------------------------------------------------------------------------------------------------------

// The coarser rule has what the tolerance asks: its distance from the finer is the bound.
TEST(RuleDigits, EachDecadeOfTheTolerance_IsADigitOfTheCoarserRule) {
  for (const Masking masking : kMaskings) {
    const RuleModel& model = rule_model(masking);
    for (int exponent = 2; exponent <= 12; ++exponent) {
      const double tolerance = std::pow(10.0, -exponent);
      const double digits = rule_digits(model, tolerance);
      EXPECT_GE(kCoarseShare * digits, static_cast<double>(exponent));
      EXPECT_NEAR(kCoarseShare * (rule_digits(model, 0.1 * tolerance) - digits), 1.0, 20.0 * kRounding);
      EXPECT_EQ(rule_node(model, tolerance).digits, digits);
      EXPECT_GE(largest_order(rule_digits(model, 0.1 * tolerance)), largest_order(digits));
      EXPECT_LE(largest_order(digits), DOLP_MAX_ORDER);
    }
  }
}

// The scale of X does not change with the tolerance, but the cut does, and with it the pieces.
TEST(KernelDataOrders, TighterTolerance_NeverCostsLess) {
  constexpr double kAlmost = 0.95;
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      for (const double theta_deg : {12.0, 35.0, 60.0, 85.0}) {
        for (const SlopeShape& shape : {SlopeShape{0.05, 3.0}, SlopeShape{0.5, 2.0}}) {
          double before = 0.0;
          double first = 0.0;
          for (int exponent = 2; exponent <= 10; ++exponent) {
            const double tolerance = std::pow(10.0, -exponent);
            const double evaluations =
                computed(masking, tolerance, theta_deg, shape, {2.0, 0.7}, distribution).node.evaluations;
            EXPECT_GE(evaluations, kAlmost * before)
                << name_of(masking) << " theta " << theta_deg << " sigma " << shape.sigma << " tolerance " << tolerance;
            if (first == 0.0) first = evaluations;
            before = evaluations;
          }
          EXPECT_GT(before, 2.0 * first) << theta_deg << " " << shape.sigma;
        }
      }
    }
  }
}

// An index with total reflection splits the slopes elsewhere: of each of its directions there is one more.
TEST(KernelDataTotalReflection, ItsIndices_HaveDirectionsOfTheirOwn) {
  constexpr std::array kCriticalCos = {0.0, 0.6, 0.0, 0.5 * std::numbers::sqrt3};
  MomentsRequest request;
  request.masking = Masking::kVCavity;
  request.theta_deg = {20.0, 70.0};
  request.indices = {kDielectric, kTotallyReflecting, {2.0, 0.7}, {0.5, 0.0}};
  request.sigma = {0.3, 0.6};
  request.q = {2.0, 3.0};
  const KernelData data = kernel_data(request);
  ASSERT_EQ(data.size(), request.size());
  ASSERT_EQ(data.thetas.size(), 6U);  // without total reflection and for either of two lines
  for (std::size_t i = 0; i < data.size(); ++i) {
    const MomentsEntry entry = data[i];
    EXPECT_EQ(data.thetas[entry.theta].c, cos_sin_deg(request[i].theta_deg).cos) << i;
    EXPECT_NEAR(data.indices[entry.index].critical_cos, kCriticalCos[entry.index], kRounding);
    EXPECT_EQ(request.indices[entry.index], request[i].index);
    EXPECT_EQ(data.shapes[entry.shape].m, slope_width(request[i].shape));
    for (std::size_t j = 0; j < i; ++j) {
      const bool is_same =
          request[i].theta_deg == request[j].theta_deg && kCriticalCos[entry.index] == kCriticalCos[data[j].index];
      EXPECT_EQ(entry.theta == data[j].theta, is_same) << i << " " << j;
    }
    const bool is_total = kCriticalCos[entry.index] > 0.0;
    const std::uint32_t plain = data.theta_of(request[i].theta_deg == 20.0 ? 0 : 1, 0, entry.shape);
    EXPECT_EQ(data.pieces[entry.theta].count > data.pieces[plain].count, is_total) << i;
  }
}

TEST(KernelDataOfPoints, EachPoint_HasADirectionAndAnIndexOfItsOwn) {
  MomentsRequest request;
  request.masking = Masking::kVCavity;
  request.append({20.0, {0.3, 2.0}, kDielectric});
  request.append({20.0, {0.3, 2.0}, kTotallyReflecting});
  request.append({70.0, {0.6, 3.0}, kTotallyReflecting});
  request.append({70.0, {0.3, 2.0}, kTotallyReflecting});
  const KernelData data = kernel_data(request);
  ASSERT_EQ(data.size(), request.size());
  ASSERT_EQ(data.shapes.size(), 3U);  // neighbours share theirs
  for (std::size_t i = 0; i < data.size(); ++i) {
    const MomentsEntry entry = data[i];
    EXPECT_EQ(entry.theta, i);
    EXPECT_EQ(entry.index, i);
    EXPECT_EQ(data.thetas[entry.theta].c, cos_sin_deg(request[i].theta_deg).cos);
    EXPECT_EQ(data.shapes[entry.shape].m, slope_width(request[i].shape));
  }
  EXPECT_EQ(data[0].shape, data[1].shape);
  EXPECT_GT(data.pieces[1].count, data.pieces[0].count);
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
    EXPECT_EQ(a.needs_line, b.needs_line);
    EXPECT_EQ(a.index_variant, b.index_variant);
    EXPECT_TRUE(same_bytes(a.rule_nodes, b.rule_nodes));
    EXPECT_EQ(std::memcmp(&a.rule, &b.rule, sizeof a.rule), 0);
    const KernelData other = kernel_data(hard_request(Distribution::kCauchy, masking, 1e-5, true));
    EXPECT_NE(std::memcmp(&a.rule, &other.rule, sizeof a.rule), 0);
  }
}

// ---- The cut --------------------------------------------------------------------------------------------------------

// Integral over the azimuths of the projection without masking of the facets of slope t whose reflected ray leaves.
double seen_at(double c, double s, double t) {
  const double level = s * t > 0.0 ? (0.5 * c * (1.0 + t * t) - c) / (s * t) : 2.0;
  if (level >= 1.0) return 0.0;
  const double horizon = std::acos(std::max(level, -1.0));
  return 2.0 * (c * horizon + s * t * std::sin(horizon));
}

// The albedo (times cos theta) without masking of the facets steeper than the cut.
double albedo_beyond(const KernelData& data) {
  const kernel::ShapeNode& shape = data.shapes[0];
  const kernel::ThetaNode& node = data.thetas[data[0].theta];
  const double horizon = node.end[DOLP_MAX_PIECES];
  if (shape.cut >= horizon) return 0.0;
  const auto integrand = [&](double log_slope) {
    const double t = std::exp(log_slope);
    const double u = t / shape.m;
    const double profile = data.distribution == Distribution::kCauchy
                               ? shape.q_minus_1 * std::exp(-(shape.q_minus_1 + 1.0) * std::log1p(u * u))
                               : std::exp(-u * u);
    return profile * u * u / pi * seen_at(node.c, node.s, t);
  };
  double sum = 0.0;
  const double last = std::log(std::min(horizon, 1e4 * shape.cut));
  for (double from = std::log(shape.cut); from < last; from += 0.5) {
    sum += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(integrand, from, std::min(from + 0.5, last), 5,
                                                                         1e-12);
  }
  return sum;
}

// What is left out is no more than its bound, which alone is left when the kernel returns nothing; and that is a small
// part of the tolerance. v-cavity and smith hide part of it.
TEST(Cut, WhatItLeavesOut_IsBelowItsBoundAndAShareOfTheTolerance) {
  constexpr double kLargestShare = 0.4;
  int with_cut = 0;
  double fullest = 0.0;
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      for (const double tolerance : {1e-2, 1e-4, 1e-8, 1e-10}) {
        for (const SlopeShape& shape : {SlopeShape{0.02, 3.0}, SlopeShape{0.05, 10.0}, SlopeShape{0.3, 5.0},
                                        SlopeShape{0.3, 50.0}, SlopeShape{1e-3, 2.0}}) {
          for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 89.0, 90.0}) {
            const Computed entry = computed(masking, tolerance, theta_deg, shape, {1000.0, 1000.0}, distribution);
            const double beyond = albedo_beyond(entry.data);
            if (beyond == 0.0) continue;
            ++with_cut;
            const Moments nothing = moments_from_kernel({}, entry.data, entry.data[0], kDoubleRoundoff);
            const double bound = nothing.albedo_error;
            const std::string where = std::string(name_of(masking)) + " theta " + std::to_string(theta_deg) +
                                      " sigma " + std::to_string(shape.sigma) + " q " + std::to_string(shape.q) +
                                      " tolerance " + std::to_string(tolerance);
            // v-cavity hides all but 2 cos(theta) of a facet, smith a share that depends on theta
            if (masking == Masking::kNone || masking == Masking::kIntegral) {
              EXPECT_LE(beyond, bound * (1.0 + 1e-9)) << where;
              fullest = std::max(fullest, beyond / bound);
            }
            EXPECT_LE(bound, kLargestShare * tolerance * entry.node.albedo) << where;
          }
        }
      }
    }
  }
  std::printf("%d entries with a cut, bound used up to %.2f\n", with_cut, fullest);
  EXPECT_GT(with_cut, 300);
  EXPECT_GT(fullest, 0.3);
}

}  // namespace
}  // namespace dolp
