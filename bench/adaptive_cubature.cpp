// Adaptive cubature over slope and azimuth of the facet, the azimuth ending exactly where the reflected ray meets the
// horizon.
#include <cubature.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bench/direct_brdf.hpp"
#include "bench/method.hpp"
#include "evaluate/processor.hpp"

namespace dolp::bench {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostEvaluations = 30'000'000;  // of one entry: a few seconds

/// The map of the unit square to slope and azimuth: t = w sinh(X), X linear up to the last slope that reflects upwards.
struct FacetIntegral {
  const DirectSurface& surface;
  double width;
  double length;  ///< of X
  std::size_t evaluations = 0;

  explicit FacetIntegral(const DirectSurface& of)
      : surface(of),
        width(std::min(1.0, of.width())),
        length(std::asinh((1.0 + of.sin_theta()) / of.cos_theta() / width)) {}

  double last_azimuth(double slope) const {
    const double steepness = surface.cos_theta() * (slope * slope - 1.0);
    const double reach = 2.0 * surface.sin_theta() * slope;
    return steepness <= -reach ? pi : std::acos(std::min(1.0, steepness / reach));
  }

  Reflected at(double x, double y) {
    ++evaluations;
    const double slope = width * std::sinh(length * x);
    const double azimuth = last_azimuth(slope);
    const double measure = 2.0 * surface.slope_density(slope * slope) * slope * azimuth * length *
                           std::sqrt(width * width + slope * slope);
    const Reflected value = half_vector_integrand(surface, slope, std::cos(azimuth * y));
    return {measure * value.i, measure * value.q};
  }
};

int integrand(unsigned, const double* x, void* data, unsigned, double* values) {
  const Reflected value = static_cast<FacetIntegral*>(data)->at(x[0], x[1]);
  values[0] = value.i;
  values[1] = value.q;
  return 0;
}

class Cubature final : public Solver {
 public:
  Solution solve(const MomentsRequest& request, double setting) override {
    Solution solution{.evaluations = 0.0};
    for (const MomentsEntry& entry : request.entries) {
      const DirectSurface surface(entry_of(request, entry));
      FacetIntegral integral(surface);
      constexpr double kLow[] = {0.0, 0.0};
      constexpr double kHigh[] = {1.0, 1.0};
      double values[2];
      double errors[2];
      // The largest error over the largest value, which is r_i: the very error of this study.
      if (hcubature(2, integrand, &integral, 2, kLow, kHigh, kMostEvaluations, 0.0, setting, ERROR_LINF, values,
                    errors) != 0) {
        throw Unavailable("hcubature failed");
      }
      solution.answers.push_back({values[0], values[1], std::max(errors[0], errors[1]) / values[0]});
      *solution.evaluations += static_cast<double>(integral.evaluations);
    }
    return solution;
  }
  std::string where() const override { return processor_name(); }
};

}  // namespace

std::unique_ptr<Solver> make_cubature() { return std::make_unique<Cubature>(); }

}  // namespace dolp::bench
