// Monte Carlo integration over random facets. A moment is the integral of half_vector_integrand() times the density of
// slopes. The facets are drawn from this density, so the moment is the mean of half_vector_integrand() over the facets.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "base/processor.hpp"
#include "methods/direct_brdf.hpp"
#include "methods/method.hpp"

namespace dolp::bench {
namespace {

/// A uniform random number in (0, 1). Unlike std::uniform_real_distribution it does not depend on the library.
double uniform(std::mt19937_64& random) {
  constexpr double kUnit = 0x1p-53;
  return (static_cast<double>(random() >> 11U) + 0.5) * kUnit;
}

Answer sample_mean(const DirectSurface& surface, std::uint64_t samples, std::mt19937_64& random) {
  double sum_i = 0.0;
  double sum_q = 0.0;
  double sum_ii = 0.0;
  for (std::uint64_t i = 0; i < samples; ++i) {
    const double slope = surface.sampled_slope(uniform(random));
    const Reflected value = half_vector_integrand(surface, slope, std::cos(std::numbers::pi * uniform(random)));
    sum_i += value.i;
    sum_q += value.q;
    sum_ii += value.i * value.i;
  }
  const auto count = static_cast<double>(samples);
  Answer answer{sum_i / count, sum_q / count, std::nullopt};
  const double variance = std::max(0.0, sum_ii / count - answer.r_i * answer.r_i);
  if (answer.r_i > 0.0) answer.stated_error = std::sqrt(variance / count) / answer.r_i;
  return answer;
}

class MonteCarlo final : public Solver {
 public:
  Solution solve(const MomentsRequest& request, double setting) override {
    const auto samples = static_cast<std::uint64_t>(setting);
    Solution solution;
    for (std::size_t i = 0; i < request.size(); ++i) {
      solution.answers.push_back(
          sample_mean(DirectSurface(entry_of(request, i), DirectSurface::SmithBy::kTable), samples, random_));
    }
    solution.evaluations = setting * static_cast<double>(request.size());
    return solution;
  }
  std::string where() const override { return processor_name(); }

 private:
  std::mt19937_64 random_{20'250'808};  // repeated calls of solve() get other random numbers
};

}  // namespace

std::unique_ptr<Solver> make_monte_carlo() { return std::make_unique<MonteCarlo>(); }

}  // namespace dolp::bench
