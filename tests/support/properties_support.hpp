// Random points from the whole range of scenes, and an evaluator for each compiled version of the kernels, for tests.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "draws.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "fixed_precision.hpp"

namespace dolp {

struct Model {
  Distribution distribution;
  Masking masking;
};

inline constexpr std::array<Model, 8> kModels{{{Distribution::kCauchy, Masking::kNone},
                                               {Distribution::kCauchy, Masking::kVCavity},
                                               {Distribution::kCauchy, Masking::kIntegral},
                                               {Distribution::kCauchy, Masking::kSmith},
                                               {Distribution::kGaussian, Masking::kNone},
                                               {Distribution::kGaussian, Masking::kVCavity},
                                               {Distribution::kGaussian, Masking::kIntegral},
                                               {Distribution::kGaussian, Masking::kSmith}}};

inline std::string to_name(const Model& model) {
  constexpr std::array kMaskings = {"None", "VCavity", "Integral", "Smith"};
  return std::string(model.distribution == Distribution::kCauchy ? "Cauchy" : "Gaussian") +
         kMaskings[static_cast<std::size_t>(model.masking)];
}

struct Point {
  double theta_deg = 60.0;
  SlopeShape shape{0.3, 2.0};
  OpticalConstants index{1.508, 0.0};
};

inline std::string text_of(const Point& p) {
  return fmt::format("theta {:.17g} sigma {:.17g} q {:.17g} n {:.17g} k {:.17g}", p.theta_deg, p.shape.sigma, p.shape.q,
                     p.index.n, p.index.k);
}

class Random : public Draws {
 public:
  using Draws::Draws;

  /// A zenith. About one in five is near 0, one in five near 90 degrees; 2 % are exactly 0, 2 % exactly 90 degrees.
  double theta_deg() {
    const double kind = uniform(0.0, 1.0);
    if (kind < 0.02) return 0.0;
    if (kind > 0.98) return 90.0;
    if (kind < 0.2) return log_uniform(1e-8, 10.0);
    if (kind < 0.4) return 90.0 - log_uniform(1e-6, 10.0);
    return uniform(0.0, 90.0);
  }

  /// A slope distribution with sigma from 1e-4 to 10, and q from 0.001 above its lower limit to about 1e4.
  SlopeShape shape(const Model& model) {
    const bool is_smith_cauchy = model.masking == Masking::kSmith && model.distribution == Distribution::kCauchy;
    return {log_uniform(1e-4, 10.0), (is_smith_cauchy ? 1.5 : 1.0) + log_uniform(1e-3, 9998.0)};
  }

  /// A refractive index. n is 0.7 to 1.5 in one of four cases, otherwise 0.001 to 1000. k is 0 or 1e-4 to 1000.
  OpticalConstants index() {
    const double n = chance(0.25) ? uniform(0.7, 1.5) : log_uniform(1e-3, 1000.0);
    return {n, chance(0.4) ? 0.0 : log_uniform(1e-4, 1000.0)};
  }

  Point point(const Model& model) {
    Point p;
    p.theta_deg = theta_deg();
    p.shape = shape(model);
    p.index = index();
    return p;
  }

  std::vector<Point> points(const Model& model, std::size_t count) {
    std::vector<Point> drawn;
    for (std::size_t i = 0; i < count; ++i) drawn.push_back(point(model));
    return drawn;
  }
};

inline MomentsRequest request_of(const Model& model, const std::vector<Point>& points, double tolerance) {
  MomentsRequest request;
  request.distribution = model.distribution;
  request.masking = model.masking;
  request.tolerance = tolerance;
  for (const Point& p : points) request.append({p.theta_deg, p.shape, p.index});
  return request;
}

/// The compiled versions of the kernel source.
enum class Kernel { kCpuFloat, kCpuDouble, kVulkanFloat, kVulkanDouble };

inline constexpr std::array kKernels{Kernel::kCpuFloat, Kernel::kCpuDouble, Kernel::kVulkanFloat,
                                     Kernel::kVulkanDouble};

inline std::string to_name(Kernel kernel) {
  constexpr std::array kNames = {"CpuFloat", "CpuDouble", "VulkanFloat", "VulkanDouble"};
  return kNames[static_cast<std::size_t>(kernel)];
}

inline bool is_double(Kernel kernel) { return kernel == Kernel::kCpuDouble || kernel == Kernel::kVulkanDouble; }

inline std::unique_ptr<ModelEvaluator> make_evaluator(Kernel kernel, VulkanOptions options = {}) {
  const Precision precision = is_double(kernel) ? Precision::kDouble : Precision::kFloat;
  if (kernel == Kernel::kCpuFloat || kernel == Kernel::kCpuDouble) return std::make_unique<FixedPrecision>(precision);
  options.needs_double = is_double(kernel);
  options.has_validation = true;
  return std::make_unique<FixedPrecision>(precision, std::make_unique<VulkanEvaluator>(options));
}

/// The parameter of tests that run each kernel with each model.
using KernelAndModel = std::tuple<Kernel, Model>;

inline std::string kernel_and_model_name(const testing::TestParamInfo<KernelAndModel>& test) {
  return to_name(std::get<0>(test.param)) + to_name(std::get<1>(test.param));
}

/// The four moments that are integrals over the hemisphere. The moments of the direct emission are not among them.
inline constexpr std::span<const MomentMember> kHemisphereMembers(kMomentMembers.data(), 4);

inline bool are_same(const Moments& a, const Moments& b) {
  const auto is_same = [&](const MomentMember& m) { return a.*m.value == b.*m.value && a.*m.error == b.*m.error; };
  return a.evaluations == b.evaluations && std::ranges::all_of(kHemisphereMembers, is_same);
}

/// Expects that each moment of `a` differs from the moment of `b` by at most a bound: the sum of both stated errors and
/// `slack`. Returns the largest ratio of a difference to its bound.
inline double expect_within_bounds(const Moments& a, const Moments& b, const std::string& where, double slack = 0.0) {
  double worst = 0.0;
  for (const auto& [value, error] : kMomentMembers) {
    const bool is_direct = value == &Moments::direct_i || value == &Moments::direct_q;
    if (is_direct && std::isnan(b.*value)) continue;  // b has no direct emission
    const double distance = std::abs(a.*value - b.*value);
    const double bound = a.*error + b.*error + slack;
    EXPECT_TRUE(distance <= bound) << where << ": " << a.*value << " states " << a.*error << ", " << b.*value
                                   << " states " << b.*error;
    if (distance > 0.0) worst = std::max(worst, distance / bound);
  }
  return worst;
}

}  // namespace dolp
