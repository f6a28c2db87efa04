// Entry point of libFuzzer.
#include "fuzz.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dolp::fuzz::read(std::string(data, data + size));
  return 0;
}
