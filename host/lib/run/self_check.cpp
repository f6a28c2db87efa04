#include "run/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <dolp/status.hpp>

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

double rho_bound(const PointResult& result) {
  return result[Quantity::kRhoErrorEstimate] * std::abs(result[Quantity::kRhoI]);
}

}  // namespace

void SelfCheck::add(const PointResult& result, const PointResult& again) {
  ++entries;
  const auto difference = [&](Quantity quantity) { return result[quantity] - again[quantity]; };
  if (promises_dolp(result.status)) {
    worst_ratio = std::max(worst_ratio, ratio(difference(Quantity::kDolp),
                                              result[Quantity::kErrorEstimate] + again[Quantity::kErrorEstimate]));
  }
  const double rho = rho_bound(result) + rho_bound(again);
  for (const Quantity quantity : {Quantity::kRhoI, Quantity::kRhoQ})
    worst_ratio = std::max(worst_ratio, ratio(difference(quantity), rho));
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
