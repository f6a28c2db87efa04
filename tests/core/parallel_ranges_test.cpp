// parallel_ranges has the same ranges on all machines, and passes exceptions on.
#include "base/parallel_ranges.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

namespace dolp::parallel_ranges_test {
namespace {

constexpr std::size_t kGrain = 16;

TEST(ParallelRanges, Ranges_FollowFromTheCountAlone) {
  constexpr std::size_t kCount = 10 * kGrain + 5;
  std::set<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t first = 0; first < kCount; first += kGrain)
    expected.emplace(first, std::min(first + kGrain, kCount));
  std::mutex mutex;
  std::set<std::pair<std::size_t, std::size_t>> ranges;
  parallel_ranges(kCount, kGrain, [&](std::size_t first, std::size_t last) {
    const std::lock_guard lock(mutex);
    ranges.emplace(first, last);
  });
  EXPECT_EQ(ranges, expected);
}

TEST(ParallelRanges, AnErrorInOneRange_StopsTheLoopAndIsThrown) {
  std::atomic<std::size_t> ranges = 0;
  constexpr std::size_t kMany = 1'000'000;
  const auto fail_first = [&](std::size_t first, std::size_t) {
    ++ranges;
    if (first == 0) throw std::runtime_error("the first range");
  };
  EXPECT_THROW(parallel_ranges(kMany, 1, fail_first), std::runtime_error);
  EXPECT_LT(ranges, kMany);
}

}  // namespace
}  // namespace dolp::parallel_ranges_test
