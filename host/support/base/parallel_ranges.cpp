#include "base/parallel_ranges.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace dolp {

void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> must_stop = false;
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (std::size_t first = next.fetch_add(grain); first < count && !must_stop; first = next.fetch_add(grain)) {
        body(first, std::min(first + grain, count));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      must_stop = true;
    }
  };
  std::vector<std::jthread> threads;
  const std::size_t useful = (count + grain - 1) / grain;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  try {
    for (std::size_t i = 1; i < std::min(cores, useful); ++i) threads.emplace_back(work);
  } catch (const std::system_error&) {
    // The system refused to start another thread. The threads that have started do all the work.
  }
  work();
  threads.clear();  // waits until the threads have ended
  if (error) std::rethrow_exception(error);
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body,
                  const Progress& progress) {
  std::mutex mutex;
  std::size_t done = 0;
  parallel_ranges(count, grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i);
    if (!progress) return;
    const std::lock_guard lock(mutex);
    done += last - first;
    if (!progress(done, count)) throw Cancelled();
  });
}

}  // namespace dolp
