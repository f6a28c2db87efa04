// The kernel source compiled for this processor. Several threads run the invocations that a Vulkan device would run.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "base/processor.hpp"
#include "base/stopwatch.hpp"
#include "methods/kernel/grouped_kernel.hpp"
#include "methods/method.hpp"

namespace dolp::bench {
namespace {

constexpr std::size_t kBlock = 64;  // number of invocations of the kernel that a thread takes at a time

/// Calls body(i) once for each i < count, in several threads. It does not use OpenMP: threads of OpenMP spin while they
/// wait, which is slow if other programs run.
void on_all_cores(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) body(i);
  };
  std::vector<std::jthread> threads;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 1; i < std::min(cores, count); ++i) threads.emplace_back(work);
  work();
}

class NativeText final : public Solver {
 public:
  Solution solve(const MomentsRequest& request, double setting) override {
    MomentsRequest wanted = request;
    wanted.tolerance = setting;
    const GroupedWork work(wanted);
    if (!has_kernel_for(work.data)) {
      throw Unavailable("it is compiled for the cauchy with integral or smith and without total reflection alone");
    }
    const std::unique_ptr<GroupedKernel> kernel = make_native_kernel(work);
    std::vector<kernel::MomentsNode> nodes(work.pieces.size() * work.rows.width);
    Solution solution;
    solution.kernel_s = run(work, *kernel, nodes);
    solution.evaluations = 0.0;
    for (std::size_t i = 0; i < nodes.size(); i += work.rows.width) *solution.evaluations += nodes[i].evaluations;
    for (const Moments& entry : moments_of(work, nodes)) {
      solution.answers.push_back({entry.r_i, entry.r_q, std::max(entry.r_i_error, entry.r_q_error) / entry.r_i});
    }
    return solution;
  }
  std::string where() const override { return processor_name() + ", " DOLP_NATIVE_FLAGS; }

 private:
  static double run(const GroupedWork& work, GroupedKernel& kernel, std::vector<kernel::MomentsNode>& nodes) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t size = work.rows.width;
    on_all_cores(work.rows.shapes.size(), [&](std::size_t shape) { kernel.build_masking_table(shape); });
    on_all_cores((work.pieces.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t first = block * kBlock;
      const std::size_t count = std::min(kBlock, work.pieces.size() - first);
      kernel.run_pieces(first, std::span(nodes).subspan(first * size, count * size));
    });
    return seconds_since(start);
  }
};

}  // namespace

std::unique_ptr<Solver> make_native() { return std::make_unique<NativeText>(); }

}  // namespace dolp::bench
