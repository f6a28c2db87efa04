#include "methods/arithmetic_peak.hpp"

#include <algorithm>

#include "device/buffer.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "methods/bench_device.hpp"
#include "spirv.hpp"

namespace dolp::bench {
namespace {

// arithmetic_peak.comp has this many chains of operations, each with this many steps. A step is one * and one +.
constexpr double kChains = 12.0;
constexpr double kSteps = 8.0 * DOLP_PEAK_TURNS;
constexpr double kFlops = 2.0 * kChains * kSteps;  // floating-point operations per invocation

constexpr std::uint32_t kInvocations = 1U << 15U;
constexpr double kEnoughTime = 0.02;  // seconds; a measurement takes at least this long
constexpr double kTimeout = 60.0;

}  // namespace

std::vector<double> arithmetic_peak(const std::string& device, std::size_t repeats) {
  BenchDevice bench(device);
  vulkan::Kernels kernels(bench.device, false);
  const vulkan::UniquePipeline pipeline = kernels.create(spirv::arithmetic_peak_float, vulkan::KernelVariant{});
  const vulkan::Buffer results(bench.device, kInvocations * sizeof(float), vulkan::MemoryUse::kDeviceOnly);
  vulkan::Kernels::Bindings bindings;
  bindings.buffers[DOLP_BINDING_MOMENTS] = results.get();
  kernels.bind(bindings);
  const auto run = [&](std::size_t dispatches) {
    bench.stream.begin();
    for (std::size_t i = 0; i < dispatches; ++i) {
      if (i > 0) bench.stream.barrier(vulkan::Barrier::kKernelToKernel);
      bench.stream.dispatch(kernels, pipeline.get(), 0, kInvocations, 0);
    }
    return bench.stream.submit_and_wait(kTimeout);
  };
  run(1);  // compiles
  std::size_t dispatches = 1;
  while (run(dispatches) < kEnoughTime) dispatches *= 2;
  std::vector<double> rates;
  for (std::size_t i = 0; i < repeats; ++i) {
    rates.push_back(kFlops * kInvocations * static_cast<double>(dispatches) / run(dispatches));
  }
  bench.check_messages();
  std::ranges::sort(rates);
  return rates;
}

}  // namespace dolp::bench
