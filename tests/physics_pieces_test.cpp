// The pieces of the slope axis and the task words that say them: between two breakpoints the shaders' arcs of azimuth
// change smoothly, and every square root lies at an end that its pieces know of.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "model/choices.hpp"
#include "physics_text.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Text = tested_double::Text;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};

// Indices without and with total reflection.
constexpr std::array kIndices = {1.508, 0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1};

// Directions at which breakpoints coincide, and next to them.
constexpr std::array kCoincidencesDeg = {12.857142857, 12.9, 17.9, 18.0, 18.1, 22.5, 29.8, 30.0, 30.2,
                                         44.9,         45.0, 45.1, 54.0, 60.0, 60.1, 89.0, 89.99};

// A slope distribution that needs the line b = pi/2 of `integral`, and smith's cusp, at the tolerance of the tests.
constexpr ShapeCase kRough{Distribution::kCauchy, 1.0, 1.6};
constexpr double kTightTolerance = 1e-10;

std::vector<double> directions_deg() {
  std::vector<double> all(kCoincidencesDeg.begin(), kCoincidencesDeg.end());
  for (double theta_deg = 0.31; theta_deg < 90.0; theta_deg += 0.73) all.push_back(theta_deg);
  return all;
}

// One direction as an entry of the kernel sees it.
struct Direction {
  double theta_deg = 0.0;
  Masking masking = Masking::kNone;
  bool has_line = false;
  kernel::ThetaNode node{};
  Pieces pieces;
  kernel::IndexNode index{};
  std::string name() const {
    return std::string(name_of(masking)) + " theta " + std::to_string(theta_deg) + (has_line ? " with line" : "") +
           " critical cos " + std::to_string(index.critical_cos);
  }
};

// Directions for an index each, with or without line or cusp.
std::vector<Direction> directions(const std::vector<double>& theta_deg, const std::vector<double>& n, Masking masking,
                                  bool has_line) {
  MomentsRequest request;
  request.masking = masking;
  request.tolerance = has_line ? kTightTolerance : 1e-2;
  const SlopeShape shape = has_line ? SlopeShape{kRough.sigma, kRough.q} : SlopeShape{1e-3, 10.0};
  for (std::size_t i = 0; i < theta_deg.size(); ++i) request.append({theta_deg[i], shape, {n[i], 0.0}});
  const KernelData data = kernel_data(request);
  std::vector<Direction> result;
  for (std::size_t i = 0; i < theta_deg.size(); ++i) {
    const std::uint32_t theta = data[i].theta;
    result.push_back({theta_deg[i], masking, has_line, data.thetas[theta], data.pieces[theta], data.indices[i]});
    EXPECT_EQ(result.back().pieces.has_split_line, has_line) << result.back().name();
  }
  return result;
}

// Calls `check` for every direction of a list, masking and index, with and without line or cusp.
template <class Check>
void for_each_direction(const std::vector<double>& theta_deg, const Check& check) {
  for (const Masking masking : kMaskings) {
    const bool may_have_line = masking == Masking::kIntegral || masking == Masking::kSmith;
    for (const double n : kIndices) {
      const std::vector<double> same(theta_deg.size(), n);
      for (const Direction& d : directions(theta_deg, same, masking, false)) check(d);
      if (!may_have_line) continue;
      for (const Direction& d : directions(theta_deg, same, masking, true)) check(d);
    }
  }
}

// ---- Ends ----------------------------------------------------------------------------------------------------------

void expect_ascending_to_the_horizon(const Direction& d) {
  const kernel::ThetaNode& node = d.node;
  const std::size_t last = d.pieces.count;
  ASSERT_GE(last, 1U) << d.name();
  ASSERT_LE(last, static_cast<std::size_t>(DOLP_MAX_PIECES)) << d.name();
  EXPECT_EQ(node.end[0], 0.0);
  for (std::size_t i = 0; i < last; ++i) {
    EXPECT_LE(node.end[i], node.end[i + 1]) << d.name() << " piece " << i;
  }
  // beyond slope (1 + s) / c no reflected ray leaves
  if (node.c > 0.0) {
    EXPECT_DOUBLE_EQ(node.end[last], (1.0 + node.s) / node.c) << d.name();
  }
  EXPECT_EQ(node.end[DOLP_MAX_PIECES], node.end[last]) << d.name();
}

TEST(Pieces, HardDirections_AscendFromZeroToTheHorizonWithinTheirRoom) {
  std::size_t most = 0;
  for_each_direction(directions_deg(), [&](const Direction& d) {
    most = std::max<std::size_t>(most, d.pieces.count);
    expect_ascending_to_the_horizon(d);
  });
  for_each_direction({0.0, 1e-6, 90.0 - 1e-9, 90.0}, expect_ascending_to_the_horizon);
  std::printf("at most %zu pieces of %d\n", most, DOLP_MAX_PIECES);
}

TEST(Pieces, RandomDirectionsAndIndices_FitTheirRoom) {
  constexpr unsigned kSeed = 20250803;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle_deg(0.0, 90.0);
  std::uniform_real_distribution<double> n(0.01, 0.9999);
  for (const Masking masking : kMaskings) {
    const bool may_have_line = masking == Masking::kIntegral || masking == Masking::kSmith;
    std::vector<double> theta_deg(500);
    std::vector<double> index(500);
    for (double& angle : theta_deg) angle = angle_deg(random);
    for (double& one : index) one = n(random);
    for (const bool has_line : {false, true}) {
      if (has_line && !may_have_line) continue;
      for (const Direction& d : directions(theta_deg, index, masking, has_line)) expect_ascending_to_the_horizon(d);
    }
  }
}

// ---- Arcs ----------------------------------------------------------------------------------------------------------

template <class Half>
double azimuth_of(const Half& half) {
  return 2.0 * std::atan2(half.y, half.x);
}

// Which arcs there are at one slope: where a line has left the azimuths from 0 to pi, and whether the critical line is
// before the horizon.
std::array<int, 5> arrangement(Text& text, const Direction& d, double slope) {
  const auto lines = text.split_lines({}, theta_in<Text>(d.node), index_in<Text>(d.index), slope, d.has_line, 0);
  const auto place = [](const auto& line) { return line.y <= 0.0 ? 0 : (line.x <= 0.0 ? 2 : 1); };
  const double critical = azimuth_of(lines.critical);
  int place_of_critical = critical <= 0.0 ? 0 : (critical < azimuth_of(lines.horizon) ? 1 : 2);
  if (d.index.critical_cos <= 0.0) place_of_critical = 0;
  const int has_middle = azimuth_of(lines.end[1]) > azimuth_of(lines.end[0]) ? 1 : 0;
  return {place(lines.end[0]), place(lines.end[1]), place(lines.horizon), has_middle, place_of_critical};
}

// Slopes inside a piece, near its ends too, where the piece has any extent.
std::vector<double> slopes_inside(double from, double to) {
  constexpr std::array kShares = {1e-3, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 0.999};
  constexpr double kLeastExtent = 1e-6;  // below, the ends' rounding counts
  constexpr double kNoFacets = 1e-9;     // and so does that of slopes beside 0
  const double reached = std::min(to, 1e6 * std::max(from, 1.0));
  if (from > 0.0 && from < kNoFacets) from = kNoFacets;
  if (reached < kNoFacets) return {};
  std::vector<double> slopes;
  if (reached < from * (1.0 + kLeastExtent)) return slopes;
  for (const double share : kShares) {
    slopes.push_back(from > 0.0 ? from * std::pow(reached / from, share) : reached * share);
  }
  return slopes;
}

TEST(Pieces, BetweenBreakpoints_TheArrangementOfTheArcsStays) {
  Text text;
  int checked = 0;
  int changed = 0;
  std::string first;
  for_each_direction(directions_deg(), [&](const Direction& d) {
    text.kMasking = static_cast<glm::uint>(d.masking);
    for (std::size_t i = 0; i < d.pieces.count; ++i) {
      const std::vector<double> slopes = slopes_inside(d.node.end[i], d.node.end[i + 1]);
      for (const double slope : slopes) {
        ++checked;
        if (arrangement(text, d, slope) == arrangement(text, d, slopes[slopes.size() / 2])) continue;
        if (changed++ == 0) {
          first = d.name() + " slope " + std::to_string(slope) + " of " + std::to_string(d.node.end[i]) + " to " +
                  std::to_string(d.node.end[i + 1]);
        }
      }
    }
  });
  EXPECT_EQ(changed, 0) << "of " << checked << " slopes, the first " << first;
  EXPECT_GT(checked, 10'000);
}

// ---- Roots ---------------------------------------------------------------------------------------------------------

// A slope next to which the moments' integrand over the azimuth has a square root.
struct Root {
  double slope;
  bool above;
  bool below;
};

// Angles of the facets, in degrees, at which a line of equal cos(beta) or theta_r enters or leaves the azimuths; the
// root is on the side where the line is.
std::vector<Root> masking_roots_deg(const Direction& d) {
  const double theta = d.theta_deg;
  // theta_r = 90: from alpha with theta + 2 alpha = 90 on phi = pi to that with 2 alpha - theta = 90 on phi = 0
  std::vector<Root> roots = {{45.0 - 0.5 * theta, true, false}, {45.0 + 0.5 * theta, false, true}};
  // theta_r = theta: up to 2 alpha - theta = theta
  if (d.masking == Masking::kIntegral) roots.push_back({theta, false, true});
  if (d.has_line && d.masking == Masking::kIntegral) {
    // theta_r = 45 + alpha / 2: from theta + 2 alpha on phi = pi, or from theta_r = theta, to 2 alpha - theta
    const bool from_back = theta < 45.0;
    roots.push_back({from_back ? 30.0 - theta * 2.0 / 3.0 : 2.0 * theta - 90.0, true, !from_back});
    roots.push_back({30.0 + theta * 2.0 / 3.0, false, true});
  }
  if (d.has_line && d.masking == Masking::kSmith) roots.push_back({0.5 * theta, true, true});  // theta_r = 0
  if (d.masking == Masking::kVCavity) {
    // 2 cos(alpha) cos(theta_r) = cos(beta), from theta + 2 alpha on phi = pi: cos(theta + alpha) = 2 cos(alpha)
    // cos(theta + 2 alpha) at alpha = 30 - theta / 3; on phi = 0 at 30 + theta / 3, before the line of theta begins
    roots.push_back({30.0 - theta / 3.0, true, false});
    if (theta < 45.0) roots.push_back({30.0 + theta / 3.0, false, true});
    // 2 cos(alpha) cos(theta) = cos(beta): from tan(alpha) = cot(theta); then theta_r = theta up to alpha = theta
    if (theta >= 45.0) roots.push_back({90.0 - theta, true, false});
    if (theta >= 45.0) roots.push_back({theta, false, true});
  }
  return roots;
}

std::vector<Root> roots_of(const Direction& d) {
  std::vector<Root> roots = masking_roots_deg(d);
  const double critical = d.index.critical_cos;
  if (critical > 0.0) {
    const double critical_deg = std::acos(critical) * 180.0 / pi;
    const double cosine = std::cos(d.theta_deg * pi / 180.0);
    roots.push_back({std::abs(d.theta_deg - critical_deg), true, true});  // beta = critical on phi = 0
    roots.push_back({d.theta_deg + critical_deg, true, true});            // and on phi = pi
    if (0.5 * cosine < critical) roots.push_back({std::acos(0.5 * cosine / critical) * 180.0 / pi, true, true});
    if (cosine < critical) roots.push_back({std::acos(cosine / critical) * 180.0 / pi, true, true});
    if (d.masking == Masking::kVCavity) {
      // The lines of slopes below 1: cos(beta) = 2 cos(alpha) cos(theta), and cos(beta) = 2 cos(alpha) cos(theta_r)
      // with cos(theta_r) = 2 cos(alpha) cos(beta) - cos(theta).
      const double on_theta = 0.5 * critical / cosine;
      const double on_ray = (cosine + std::sqrt(cosine * cosine + 4.0 * critical * critical)) / (4.0 * critical);
      if (on_theta < 1.0 && on_theta > std::sqrt(0.5)) roots.push_back({std::acos(on_theta) * 180.0 / pi, true, true});
      if (on_ray < 1.0 && on_ray > std::sqrt(0.5)) roots.push_back({std::acos(on_ray) * 180.0 / pi, true, true});
    }
  }
  std::erase_if(roots, [](const Root& root) { return root.slope <= 0.0 || root.slope >= 90.0; });
  for (Root& root : roots) root.slope = std::tan(root.slope * pi / 180.0);
  return roots;
}

constexpr double kSameSlope = 1e-9;

// Whether a root lies at a slope, facing the facets above or below it.
bool has_root(const std::vector<Root>& roots, double slope, bool above) {
  return std::ranges::any_of(roots, [&](const Root& root) {
    return (above ? root.above : root.below) && std::abs(std::log(slope / root.slope)) < kSameSlope;
  });
}

void expect_roots(const Direction& d) {
  const std::vector<Root> roots = roots_of(d);
  const auto expected = [&](std::uint32_t end, bool above) {
    return end <= d.pieces.count && d.node.end[end] > 0.0 && has_root(roots, d.node.end[end], above);
  };
  const auto is_same = [&](std::uint32_t end) { return std::log(d.node.end[end + 1] / d.node.end[end]) < kSameSlope; };
  const auto coincides = [&](std::uint32_t end) {
    return (end > 0 && is_same(end - 1)) || (end < d.pieces.count && is_same(end));
  };
  for (std::uint32_t i = 0; i < d.pieces.count; ++i) {
    // Where ends coincide, one of them has the root that others would have.
    if (coincides(i) || coincides(i + 1)) continue;
    const auto task = Text().task_of(task_word(d.pieces, i, 1));
    const std::string where = d.name() + " piece " + std::to_string(i);
    EXPECT_EQ(task.root_at_start, expected(i, true)) << where;
    EXPECT_EQ(task.root_at_end, expected(i + 1, false)) << where;
    if (i > 0 && !coincides(i - 1)) {
      EXPECT_EQ(task.root_before_start, expected(i - 1, true)) << where;
    }
    if (i + 2 <= d.pieces.count && !coincides(i + 2)) {
      EXPECT_EQ(task.root_after_end, expected(i + 2, false)) << where;
    }
  }
}

TEST(Pieces, SquareRoots_AreKnownAtTheirEndsAndNowhereElse) { for_each_direction(directions_deg(), expect_roots); }

// ---- Task words ----------------------------------------------------------------------------------------------------

TEST(TaskWord, EveryField_ComesBack) {
  constexpr unsigned kSeed = 20250804;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const auto below = [&](unsigned end) { return static_cast<std::uint32_t>(random() % end); };
  for (int i = 0; i < 10'000; ++i) {
    Pieces pieces;
    pieces.count = 1 + below(DOLP_MAX_PIECES);
    for (std::uint8_t& root : pieces.roots) root = static_cast<std::uint8_t>(below(4));
    pieces.has_split_line = below(2) == 1;
    for (std::uint8_t& most : pieces.most_nodes) most = static_cast<std::uint8_t>(1 + below(DOLP_MAX_ORDER));
    const std::uint32_t piece = below(pieces.count);
    const std::uint32_t members = 1 + below(16);
    const auto task = Text().task_of(task_word(pieces, piece, members));
    EXPECT_EQ(task.members, static_cast<int>(members));
    EXPECT_EQ(task.piece, static_cast<int>(piece));
    EXPECT_EQ(task.has_split_line, pieces.has_split_line);
    EXPECT_EQ(task.most_azimuths, static_cast<int>(pieces.most_nodes[piece]));
    // Bit 0 of an end: a root above it; bit 1: below.
    EXPECT_EQ(task.root_at_start, (pieces.roots[piece] & 1) != 0);
    EXPECT_EQ(task.root_at_end, (pieces.roots[piece + 1] & 2) != 0);
    EXPECT_EQ(task.root_before_start, piece > 0 && (pieces.roots[piece - 1] & 1) != 0);
    EXPECT_EQ(task.root_after_end, piece + 2 <= pieces.count && (pieces.roots[piece + 2] & 2) != 0);
  }
}

}  // namespace
}  // namespace dolp
