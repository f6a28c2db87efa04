#include "evaluate/cpu/parallel.hpp"

#include <mutex>

#include "base/parallel_ranges.hpp"

namespace dolp {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress) {
  constexpr std::size_t kBlock = 64;  // items between two reports of progress
  std::mutex mutex;
  std::size_t done = 0;
  parallel_ranges(count, kBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i);
    const std::lock_guard lock(mutex);
    done += last - first;
    if (progress && !progress(done, count)) throw Cancelled{};
  });
}

}  // namespace dolp
