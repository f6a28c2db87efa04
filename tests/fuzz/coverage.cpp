// Counts how often a fuzzer reaches each place in the code. libFuzzer finds the counters by the name of their section
// in the program file. GCC inserts a call of the function below into each basic block.
#include <array>
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kCounters = 1U << 16U;
[[gnu::section("__libfuzzer_extra_counters"), gnu::used]] std::array<std::uint8_t, kCounters> counters;

}  // namespace

// The linker redirects __sanitizer_cov_trace_pc to this function. libFuzzer has a function of that name, too, but it
// only reports an error.
extern "C" void __wrap___sanitizer_cov_trace_pc() {
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[place % kCounters];
}
