// Moments are continuous: where a rule changes, at split lines, thresholds and steps of its orders, results jump by no
// more than they state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "properties_support.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kSeed = 20260404;
constexpr std::size_t kBases = 6;   // random positions in the other parameters, for each switch
constexpr std::size_t kSteps = 16;  // order steps looked for, for each parameter

// Steps across a switch, relative. A kernel in float sees the switch of the data that the host computed in double, and
// rounds what it reads of the step itself.
constexpr double kStep = 1e-7;
constexpr double kDoubleStep = 1e-10;
// The largest true rate of change of the moments: |d ln r / d ln x|; toward grazing and q = 3/2 they grow as the
// inverse distance.
constexpr double kSteepest = 100.0;

enum class Parameter { kTheta, kSigma, kQ, kN, kK };
constexpr std::array kParameters{Parameter::kTheta, Parameter::kSigma, Parameter::kQ, Parameter::kN, Parameter::kK};

double& parameter_of(Point& point, Parameter parameter) {
  switch (parameter) {
    case Parameter::kTheta:
      return point.theta_deg;
    case Parameter::kSigma:
      return point.shape.sigma;
    case Parameter::kQ:
      return point.shape.q;
    case Parameter::kN:
      return point.index.n;
    case Parameter::kK:
      break;
  }
  return point.index.k;
}

Point with(Point point, Parameter parameter, double value) {
  parameter_of(point, parameter) = value;
  return point;
}

/// Points on either side of a switch.
struct Pair {
  Point below, above;
  std::string what;
};

using Case = std::tuple<Kernel, Model, double>;

class Switches : public testing::TestWithParam<Case> {
 protected:
  Kernel kernel() const { return std::get<0>(GetParam()); }
  Model model() const { return std::get<1>(GetParam()); }
  double tolerance() const { return std::get<2>(GetParam()); }
  double step() const { return is_double(kernel()) ? kDoubleStep : kStep; }

  Random random() const {
    const std::uint64_t seed =
        kSeed + 2 * static_cast<std::uint64_t>(model().masking) + static_cast<std::uint64_t>(model().distribution);
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    return Random(seed);
  }

  // Away from grazing incidence and from q = 3/2 and 1, where kSteepest holds.
  Point base(Random& random) const {
    Point point = random.point(model());
    point.theta_deg = random.uniform(0.5, 89.0);
    const double least = model().masking == Masking::kSmith ? 1.55 : 1.05;
    point.shape.q = std::max(point.shape.q, least);
    return point;
  }

  Pair across(const Point& point, Parameter parameter, const std::string& what) const {
    Point copy = point;
    const double value = parameter_of(copy, parameter);
    return {with(point, parameter, value * (1.0 - step())), with(point, parameter, value * (1.0 + step())), what};
  }

  void expect_no_jump(const std::vector<Pair>& pairs) const;
};

void Switches::expect_no_jump(const std::vector<Pair>& pairs) const {
  ASSERT_FALSE(pairs.empty());
  std::vector<Point> below;
  std::vector<Point> above;
  for (const Pair& pair : pairs) {
    below.push_back(pair.below);
    above.push_back(pair.above);
  }
  const auto evaluator = make_evaluator(kernel());
  const std::vector<Moments> a = evaluator->evaluate(request_of(model(), below, tolerance()), {});
  const std::vector<Moments> b = evaluator->evaluate(request_of(model(), above, tolerance()), {});
  double worst = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const MomentField& quantity : kMomentFields) {
      const double jump = std::abs(a[i].*quantity.value - b[i].*quantity.value);
      const double scale = std::max(std::abs(a[i].*quantity.value), a[i].r_i);
      const double change = 2.0 * step() * kSteepest * scale;
      const double stated = a[i].*quantity.error + b[i].*quantity.error;
      EXPECT_LE(jump, stated + change) << quantity.name << ", " << pairs[i].what << " at " << text_of(pairs[i].below)
                                       << ": " << a[i].*quantity.value << " to " << b[i].*quantity.value
                                       << ", stated together " << stated;
      if (stated > 0.0) worst = std::max(worst, (jump - change) / stated);
    }
    // Two results that both claim the tolerance are within twice the tolerance of each other.
    const double claimed = tolerance() * (a[i].r_i + b[i].r_i);
    const bool claims = std::max(a[i].r_i_error, a[i].r_q_error) <= tolerance() * a[i].r_i &&
                        std::max(b[i].r_i_error, b[i].r_q_error) <= tolerance() * b[i].r_i;
    if (!claims) continue;
    const double change = 2.0 * step() * kSteepest * a[i].r_i;
    EXPECT_LE(std::abs(a[i].r_i - b[i].r_i), claimed + change) << pairs[i].what << " at " << text_of(pairs[i].below);
    EXPECT_LE(std::abs(a[i].r_q - b[i].r_q), claimed + change) << pairs[i].what << " at " << text_of(pairs[i].below);
  }
  std::printf("%zu switches, largest jump over what is stated: %.2f\n", pairs.size(), worst);
}

// 30, 45 and 18 degrees: split lines meet; 12.857 = 90/7: those of `integral`; 65, 80, 88, 89: the plan's factors.
constexpr std::array kThetas{12.857142857142858, 18.0, 22.5, 30.0, 36.0, 45.0, 60.0, 65.0, 80.0, 88.0, 89.0};
// The plan's and the kernel's thresholds.
constexpr std::array kQs{1.1, 1.5, 1.6, 2.0, 2.2, 2.5, 3.0, 4.0};
constexpr std::array kSigmas{0.5, 0.6, std::numbers::sqrt2 / 2.0, 1.0};

TEST_P(Switches, SplitLinesAndThresholds_MakeNoJump) {
  Random draws = random();
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < kBases; ++i) {
    for (const double theta : kThetas) {
      pairs.push_back(across(with(base(draws), Parameter::kTheta, theta), Parameter::kTheta, "split lines in theta"));
    }
    for (const double sigma : kSigmas) {
      pairs.push_back(across(with(base(draws), Parameter::kSigma, sigma), Parameter::kSigma, "threshold in sigma"));
    }
    for (const double q : kQs) {
      if (model().masking == Masking::kSmith && q < 1.55) continue;
      pairs.push_back(across(with(base(draws), Parameter::kQ, q), Parameter::kQ, "threshold in q"));
    }
  }
  expect_no_jump(pairs);
}

// Total reflection begins at sin(beta) = n; its line meets phi = 0, the horizon and theta_r = theta where theta is the
// critical angle, its complement, and twice the critical angle less 90 degrees; it ends where n reaches 1, and with
// 2 n k.
TEST_P(Switches, TotalReflection_MakesNoJump) {
  constexpr double kSoftCriticalLine = 0.3;  // 2 n k above which the plan takes total reflection for smooth
  Random draws = random();
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < 2 * kBases; ++i) {
    const double n = draws.uniform(0.3, 0.97);
    const double critical_deg = std::asin(n) * 180.0 / std::numbers::pi;
    for (const double theta : {critical_deg, 90.0 - critical_deg, std::abs(2.0 * critical_deg - 90.0)}) {
      Point point = base(draws);
      point.theta_deg = std::clamp(theta, 0.5, 89.0);
      point.index = {n, 0.0};
      pairs.push_back(across(point, Parameter::kTheta, "critical angle"));
    }
    Point soft = base(draws);
    soft.index = {n, 0.5 * kSoftCriticalLine / n};
    pairs.push_back(across(soft, Parameter::kK, "end of the sharp critical line"));
    Point vacuum = base(draws);
    vacuum.index = {1.0, draws.log_uniform(0.05, 1.0)};  // beside k = 0, where r vanishes
    pairs.push_back(across(vacuum, Parameter::kN, "n = 1"));
  }
  expect_no_jump(pairs);
}

/// Evaluations of the points by the kernel's plan, in double.
std::vector<double> evaluations_of(const Model& model, const std::vector<Point>& points, double tolerance) {
  std::vector<double> evaluations;
  for (const Moments& m : make_evaluator(Kernel::kCpuDouble)->evaluate(request_of(model, points, tolerance), {})) {
    evaluations.push_back(m.evaluations);
  }
  return evaluations;
}

// A place where the number of evaluations differs on either side of a small interval, closed in on by bisection of all
// places at a time.
TEST_P(Switches, StepsOfTheOrders_MakeNoJump) {
  constexpr double kStart = 3e-3;  // relative width at first
  Random draws = random();
  std::vector<Pair> pairs;
  for (const Parameter parameter : kParameters) {
    for (std::size_t i = 0; i < kSteps; ++i) {
      Point low = base(draws);
      if (parameter == Parameter::kK && low.index.k == 0.0) low.index.k = 0.01;
      const double value = parameter_of(low, parameter);
      pairs.push_back({low, with(low, parameter, value * (1.0 + kStart)),
                       "step of the orders by parameter " + std::to_string(static_cast<int>(parameter))});
    }
  }
  const auto points_of = [&](auto member) {
    std::vector<Point> points;
    for (const Pair& pair : pairs) points.push_back(pair.*member);
    return points;
  };
  std::vector<double> low = evaluations_of(model(), points_of(&Pair::below), tolerance());
  const std::vector<double> high = evaluations_of(model(), points_of(&Pair::above), tolerance());
  for (double width = kStart; width > 2.0 * step(); width *= 0.5) {
    std::vector<Point> middle;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Parameter parameter = kParameters[i / kSteps];
      Point point = pairs[i].below;
      parameter_of(point, parameter) =
          0.5 * (parameter_of(pairs[i].below, parameter) + parameter_of(pairs[i].above, parameter));
      middle.push_back(point);
    }
    const std::vector<double> evaluations = evaluations_of(model(), middle, tolerance());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      (evaluations[i] == low[i] ? pairs[i].below : pairs[i].above) = middle[i];
    }
  }
  std::vector<Pair> steps;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (low[i] != high[i]) steps.push_back(pairs[i]);
  }
  // The few nodes of the coarsest tolerance seldom change.
  if (tolerance() > 1e-3 && steps.empty()) return;
  expect_no_jump(steps);
}

std::string case_name(const testing::TestParamInfo<Case>& test) {
  const auto [kernel, model, tolerance] = test.param;
  return name_of(kernel) + name_of(model) + "OneEMinus" + std::to_string(std::lround(-std::log10(tolerance)));
}

INSTANTIATE_TEST_SUITE_P(Kernels, Switches,
                         testing::Combine(testing::ValuesIn(kKernels), testing::ValuesIn(kModels),
                                          testing::Values(1e-2, 1e-4)),
                         case_name);

INSTANTIATE_TEST_SUITE_P(TightTolerance, Switches,
                         testing::Combine(testing::Values(Kernel::kCpuDouble), testing::ValuesIn(kModels),
                                          testing::Values(1e-6)),
                         case_name);

}  // namespace
}  // namespace dolp
