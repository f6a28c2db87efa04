// Adaptive cubature by libcubature. It integrates over the directions of one beam; the other beam keeps its direction.
#include <cubature.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/processor.hpp"
#include "methods/direct_brdf.hpp"
#include "methods/method.hpp"

namespace dolp::bench {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostEvaluations = 10'000'000;  // limit per entry, reached after a few seconds

struct Integral {
  const DirectSurface& surface;
  std::size_t evaluations = 0;
};

int integrand(unsigned, const double* x, void* data, unsigned, double* values) {
  auto& integral = *static_cast<Integral*>(data);
  ++integral.evaluations;
  const RunningBeam beam = integral.surface.beam(std::cos(x[0]), std::sin(x[0]));
  const Reflected value = beam_integrand(integral.surface, beam, std::cos(x[1]));
  values[0] = value.i;
  values[1] = value.q;
  return 0;
}

using Routine = decltype(&hcubature);

class Cubature final : public Solver {
 public:
  explicit Cubature(Routine routine) : routine_(routine) {}

  Solution solve(const MomentsRequest& request, double setting) override {
    constexpr double kLow[] = {0.0, 0.0};
    constexpr double kHigh[] = {0.5 * pi, pi};
    Solution solution{.evaluations = 0.0};
    for (std::size_t i = 0; i < request.size(); ++i) {
      const DirectSurface surface(entry_of(request, i), DirectSurface::SmithBy::kTable);
      Integral integral{surface};
      double values[2];
      double errors[2];
      // With ERROR_LINF libcubature stops when both errors are at most setting * max(|r_i|, |r_q|). The maximum is r_i,
      // because |r_q| <= r_i. So `setting` limits the error divided by r_i, which the studies measure.
      const int status =
          routine_(2, integrand, &integral, 2, kLow, kHigh, kMostEvaluations, 0.0, setting, ERROR_LINF, values, errors);
      if (status != 0) throw Unavailable("libcubature gave up");
      solution.answers.push_back({values[0], values[1], std::max(errors[0], errors[1]) / values[0]});
      *solution.evaluations += static_cast<double>(integral.evaluations);
    }
    return solution;
  }
  std::string where() const override { return processor_name(); }

 private:
  Routine routine_;
};

}  // namespace

std::unique_ptr<Solver> make_hcubature() { return std::make_unique<Cubature>(hcubature); }
std::unique_ptr<Solver> make_pcubature() { return std::make_unique<Cubature>(pcubature); }

}  // namespace dolp::bench
