#include "run/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "model/status.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostChecked = 64;
constexpr std::size_t kManyMoments = std::size_t{1} << 22U;  // of which so many are checked
// A fiftieth of the run; an entry that is computed again takes about four times what it took, with two digits more and
// no neighbour to share with.
constexpr std::size_t kShare = 50;
constexpr std::size_t kCostOfOne = 4;

double ratio(double difference, double bounds) {
  if (!(std::abs(difference) > 0.0)) return 0.0;  // equal, or not a number in both
  return std::abs(difference) / bounds;
}

}  // namespace

void SelfCheck::add(const PointResult& result, const PointResult& again) {
  ++entries;
  if (promises_dolp(result.status)) {
    worst_ratio = std::max(worst_ratio, ratio(result.dolp - again.dolp, result.error_estimate + again.error_estimate));
  }
  const double rho =
      result.rho_error_estimate * std::abs(result.rho_i) + again.rho_error_estimate * std::abs(again.rho_i);
  worst_ratio = std::max({worst_ratio, ratio(result.rho_i - again.rho_i, rho), ratio(result.rho_q - again.rho_q, rho)});
}

void SelfCheck::add(const SelfCheck& other) {
  entries += other.entries;
  worst_ratio = std::max(worst_ratio, other.worst_ratio);
}

std::size_t checked_count(std::size_t moments) {
  return std::min(kMostChecked + kMostChecked * (moments / kManyMoments), moments / (kShare * kCostOfOne));
}

std::vector<std::size_t> checked_positions(std::size_t size, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::set<std::size_t> positions;
  while (positions.size() < std::min(count, size)) positions.insert(static_cast<std::size_t>(engine() % size));
  return {positions.begin(), positions.end()};
}

}  // namespace dolp
