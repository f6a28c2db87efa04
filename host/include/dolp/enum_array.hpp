#pragma once

#include <array>
#include <cstddef>

namespace dolp {

/// An array with one value per enumerator. The enumerators must have the values 0, 1, 2, ...
template <class Key, class Value, std::size_t kCount>
struct EnumArray : std::array<Value, kCount> {
  using std::array<Value, kCount>::operator[];
  constexpr Value& operator[](Key key) { return (*this)[static_cast<std::size_t>(key)]; }
  constexpr const Value& operator[](Key key) const { return (*this)[static_cast<std::size_t>(key)]; }
};

template <class Key, std::size_t kCount>
constexpr std::array<Key, kCount> enumerators() {
  std::array<Key, kCount> all{};
  for (std::size_t i = 0; i < kCount; ++i) all[i] = static_cast<Key>(i);
  return all;
}

}  // namespace dolp
