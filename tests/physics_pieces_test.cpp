// The pieces of the slope axis: between two breakpoints the shaders' arcs of azimuth change smoothly, and a piece takes
// up every square root at its ends, its own and those just beyond them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "physics_text.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Text = tested_double::Text;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kMaskingNames = {"none", "v-cavity", "integral", "smith"};

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
  kernel::IndexNode index{};
  std::size_t pieces() const { return static_cast<std::size_t>(node.piece_count); }
  std::string name() const {
    return std::string(kMaskingNames[static_cast<std::size_t>(masking)]) + " theta " + std::to_string(theta_deg) +
           (has_line ? " with line" : "") + " critical cos " + std::to_string(index.critical_cos);
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
    result.push_back({theta_deg[i], masking, has_line, data.thetas[data[i].theta], data.indices[i]});
    EXPECT_EQ(result.back().node.has_line, has_line ? 1.0 : 0.0) << result.back().name();
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
  const std::size_t last = d.pieces();
  ASSERT_GE(last, 1U) << d.name();
  ASSERT_LE(last, static_cast<std::size_t>(DOLP_MAX_PIECES)) << d.name();
  EXPECT_EQ(node.end[0], 0.0);
  for (std::size_t i = 0; i < last; ++i) {
    EXPECT_LE(node.end[i], node.end[i + 1]) << d.name() << " piece " << i;
    EXPECT_TRUE(node.kind[i] >= 0.0 && node.kind[i] <= 3.0) << d.name() << " piece " << i;
  }
  // beyond slope (1 + s) / c no reflected ray leaves
  EXPECT_DOUBLE_EQ(node.end[last], node.c > 0.0 ? (1.0 + node.s) / node.c : 1e30) << d.name();
}

TEST(Pieces, HardDirections_AscendFromZeroToTheHorizonWithinTheirRoom) {
  std::size_t most = 0;
  for_each_direction(directions_deg(), [&](const Direction& d) {
    most = std::max(most, d.pieces());
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
  const auto lines = text.split_lines(theta_in<Text>(d.node), index_in<Text>(d.index), slope);
  const auto place = [](const auto& line) { return line.y <= 0.0 ? 0 : (line.x <= 0.0 ? 2 : 1); };
  const double critical = azimuth_of(lines.critical);
  int place_of_critical = critical <= 0.0 ? 0 : (critical < azimuth_of(lines.horizon) ? 1 : 2);
  if (d.index.critical_cos <= 0.0) place_of_critical = 0;
  const int has_middle = azimuth_of(lines.second) > azimuth_of(lines.first) ? 1 : 0;
  return {place(lines.first), place(lines.second), place(lines.horizon), has_middle, place_of_critical};
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
    for (std::size_t i = 0; i < d.pieces(); ++i) {
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
  }
  std::erase_if(roots, [](const Root& root) { return root.slope <= 0.0 || root.slope >= 90.0; });
  for (Root& root : roots) root.slope = std::tan(root.slope * pi / 180.0);
  return roots;
}

// How far beyond an end of a piece a root is felt in it, as a share of the piece's extent in ln(slope): up to here it
// must be taken up, and beyond there it must not, because that costs nodes.
constexpr double kFelt = 0.2;
constexpr double kNotFelt = 0.3;
constexpr double kSameSlope = 1e-9;

// Whether a piece [from, to] has a root within `share` of its extent of its lower end, or of its upper.
bool is_near_start(const std::vector<Root>& roots, double from, double to, double share) {
  return std::ranges::any_of(roots, [&](const Root& root) {
    const double distance = std::log(from / root.slope);
    return root.above && distance > -kSameSlope && distance < share * std::log(to / from) + kSameSlope;
  });
}
bool is_near_end(const std::vector<Root>& roots, double from, double to, double share) {
  return std::ranges::any_of(roots, [&](const Root& root) {
    const double distance = std::log(root.slope / to);
    return root.below && distance > -kSameSlope && distance < share * std::log(to / from) + kSameSlope;
  });
}

void expect_roots(const Direction& d) {
  const std::vector<Root> roots = roots_of(d);
  for (std::size_t i = 0; i < d.pieces(); ++i) {
    const double from = d.node.end[i];
    const double to = d.node.end[i + 1];
    const bool root_at_start = std::fmod(d.node.kind[i], 2.0) == 1.0;
    const bool root_at_end = d.node.kind[i + 1] >= 2.0;
    const std::string where = d.name() + " piece " + std::to_string(from) + " to " + std::to_string(to);
    if (from == 0.0) {
      EXPECT_FALSE(root_at_start) << where;
      if (is_near_end(roots, to / 2.0, to, 0.0)) {
        EXPECT_TRUE(root_at_end) << where;
      }
      continue;
    }
    if (std::log(to / from) < kSameSlope) continue;
    if (is_near_start(roots, from, to, kFelt)) {
      EXPECT_TRUE(root_at_start) << where;
    }
    if (!is_near_start(roots, from, to, kNotFelt)) {
      EXPECT_FALSE(root_at_start) << where;
    }
    if (is_near_end(roots, from, to, kFelt)) {
      EXPECT_TRUE(root_at_end) << where;
    }
    if (!is_near_end(roots, from, to, kNotFelt)) {
      EXPECT_FALSE(root_at_end) << where;
    }
  }
}

TEST(Pieces, SquareRoots_AreTakenUpWhereTheyAreFelt) { for_each_direction(directions_deg(), expect_roots); }

// Without anything near, a first piece is smooth up to its end: nothing begins before slope cot(45 + theta/2).
TEST(Pieces, FirstPieceWithoutMasking_HasNoRoot) {
  const std::vector<double> theta_deg = {20.0, 45.0, 60.0, 75.0};  // nearer to the normal the horizon is felt
  const std::vector<double> n(theta_deg.size(), 1.508);
  for (const Direction& d : directions(theta_deg, n, Masking::kNone, false)) EXPECT_EQ(d.node.kind[1], 1.0) << d.name();
}

}  // namespace
}  // namespace dolp
