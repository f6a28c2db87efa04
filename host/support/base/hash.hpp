// A 64-bit hash like FNV-1a, but numbers enter as whole 64-bit words. It only serves to tell whether inputs are equal.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace dolp {

inline constexpr std::uint64_t kHashStart = 0xcbf29ce484222325U;

constexpr std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) { return (hash ^ word) * 0x100000001b3U; }
constexpr std::uint64_t hashed(std::uint64_t hash, std::string_view bytes) {
  for (const char byte : bytes) hash = hashed(hash, std::uint64_t{static_cast<unsigned char>(byte)});
  return hash;
}
constexpr std::uint64_t hashed(std::uint64_t hash, std::span<const double> values) {
  hash = hashed(hash, std::uint64_t{values.size()});
  for (const double value : values) hash = hashed(hash, std::bit_cast<std::uint64_t>(value));
  return hash;
}

}  // namespace dolp
