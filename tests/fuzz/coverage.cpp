// Counts which code a fuzzer reaches. libFuzzer finds the counters by the name of their section in the program file.
// Code that GCC compiles calls the function below at each basic block.
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
