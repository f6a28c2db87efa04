// Counts which instrumented code runs. libFuzzer reads the counters in this section.
#include <array>
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kCounters = 1U << 16U;
[[gnu::section("__libfuzzer_extra_counters"), gnu::used]] std::array<std::uint8_t, kCounters> counters;

}  // namespace

// Called instead of __sanitizer_cov_trace_pc: libFuzzer has that function only to refuse it.
extern "C" void __wrap___sanitizer_cov_trace_pc() {
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[place % kCounters];
}
