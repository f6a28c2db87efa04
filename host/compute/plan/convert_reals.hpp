// Converts the structures of shaders/interface.glsl between precisions.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <type_traits>

namespace dolp {

/// Converts the structure `From`, which holds only FromReal, to the same structure `To` of ToReal.
template <class ToReal, class To, class FromReal, class From>
To convert_reals(const From& from) {
  constexpr std::size_t kCount = sizeof(From) / sizeof(FromReal);
  static_assert(kCount * sizeof(FromReal) == sizeof(From) && kCount * sizeof(ToReal) == sizeof(To));
  static_assert(std::is_trivially_copyable_v<From> && std::is_trivially_copyable_v<To>);
  const auto numbers = std::bit_cast<std::array<FromReal, kCount>>(from);
  std::array<ToReal, kCount> converted{};
  for (std::size_t i = 0; i < kCount; ++i) converted[i] = static_cast<ToReal>(numbers[i]);
  return std::bit_cast<To>(converted);
}

}  // namespace dolp
