// Profiles: slopes that serve every slope distribution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "properties_support.hpp"

namespace dolp {
namespace {

// Grids whose shapes span decades of sigma and of q - 1, hard directions and indices among them.
class RandomGrid {
 public:
  explicit RandomGrid(unsigned seed) : random_(seed) {}

  MomentsRequest operator()(Masking masking, Scattering scattering, double tolerance) {
    MomentsRequest request;
    request.layout = MomentsRequest::Layout::kGrid;
    request.masking = masking;
    request.scattering = scattering;
    request.distribution = share() < 0.3 ? Distribution::kGaussian : Distribution::kCauchy;
    request.wants_direct = masking == Masking::kVCavity && scattering == Scattering::kSingle && share() < 0.5;
    request.tolerance = tolerance;
    request.precision = Precision::kDouble;
    request.may_interpolate = false;
    request.theta_deg = {share() < 0.2 ? 0.0 : 90.0 * share(), 90.0 - std::pow(10.0, -1.0 + 1.5 * share())};
    const double least_sigma = 0.01 * std::exp(5.7 * share());
    const double sigma_step = std::exp(0.9 * share());
    const double least_q = 0.06 * std::exp(4.6 * share());
    const double q_step = std::exp(0.8 * share());
    for (int i = 0; i < 5; ++i) request.sigma.push_back(least_sigma * std::pow(sigma_step, i));
    for (int i = 0; i < 4; ++i) request.q.push_back(1.0 + least_q * std::pow(q_step, i));
    if (request.distribution == Distribution::kGaussian) request.q = {2.0};
    request.indices = {{1.0 + std::pow(10.0, -1.5 + 2.0 * share()), share() < 0.5 ? 0.0 : share()},
                       {0.3 + 26.0 * share(), 90.0 * share()}};
    if (share() < 0.3) request.indices.push_back({0.3 + 0.65 * share(), 0.0});
    return request;
  }

 private:
  double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  std::mt19937 random_;
};

constexpr std::pair<Masking, Scattering> kModels[] = {{Masking::kNone, Scattering::kSingle},
                                                      {Masking::kVCavity, Scattering::kSingle},
                                                      {Masking::kVCavity, Scattering::kMultiple}};

TEST(Profiles, SharedByManyShapes_StatedErrorsHoldAgainstEveryEntryByItself) {
  RandomGrid grid(20261123);
  CpuEvaluator cpu(Precision::kDouble);
  std::size_t compared = 0;
  for (const auto& [masking, scattering] : kModels) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      for (int round = 0; round < 3; ++round) {
        const MomentsRequest request = grid(masking, scattering, tolerance);
        const std::vector<Moments> shared = cpu.evaluate(request, {});
        MomentsRequest alone = request;
        alone.tolerance = std::min(1e-9, 1e-4 * tolerance);
        alone.theta_deg.clear();
        alone.sigma.clear();
        alone.q.clear();
        alone.indices.clear();
        constexpr std::size_t kEvery = 7;
        for (std::size_t i = 0; i < request.size(); i += kEvery) alone.append(request[i]);
        const std::vector<Moments> exact = cpu.evaluate(alone, {});
        for (std::size_t i = 0; i < exact.size(); ++i) {
          expect_within_bounds(shared[i * kEvery], exact[i], name_of(masking));
          compared += shared[i * kEvery].r_i_error < 1.0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(compared, 250U);
}

// Models a second pass over some entries of a grid: among light tails one heavy one, of a width between theirs.
TEST(Profiles, SomeShapesOfAGrid_HeaviestTailIsNotLost) {
  for (const auto& [masking, scattering] : kModels) {
    MomentsRequest request;
    request.masking = masking;
    request.scattering = scattering;
    request.precision = Precision::kDouble;
    request.theta_deg = {60.0};
    request.indices = {{1.5, 0.0}};
    request.sigma = {0.5, 0.55, 0.6};
    request.q = {1.2, 8.0};
    request.wanted = {0, 1, 1, 0, 0, 1};
    constexpr std::size_t kHeavy = 2;
    const Moments own = CpuEvaluator(Precision::kDouble).evaluate(request, {})[kHeavy];
    MomentsRequest alone = request;
    alone.wanted.clear();
    alone.sigma = {0.55};
    alone.q = {1.2};
    alone.tolerance = 1e-9;
    const Moments exact = CpuEvaluator(Precision::kDouble).evaluate(alone, {}).front();
    expect_within_bounds(own, exact, name_of(masking));
    EXPECT_LE(own.r_i_error, request.tolerance * own.r_i) << name_of(masking);
  }
}

}  // namespace
}  // namespace dolp
