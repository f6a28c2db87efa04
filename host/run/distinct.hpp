#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace dolp {

/// Positions of values in a list of distinct ones, each named by two numbers.
template <class Value>
class Distinct {
 public:
  using Pair = std::pair<double, double>;
  explicit Distinct(std::vector<Value>& values) : values_(values) {}

  std::uint32_t position(const Pair& key, const Value& value) {
    // A grid repeats the value of one axis many times over, and goes through those of another again and again.
    if (is_at(last_position_, key)) return last_position_;
    const std::uint32_t next = last_position_ + 1 < keys_.size() ? last_position_ + 1 : 0;
    last_position_ = is_at(next, key) ? next : looked_up(key, value);
    return last_position_;
  }

 private:
  struct Hash {
    std::size_t operator()(const Pair& key) const {
      constexpr std::size_t kOddMultiplier = 0x9e3779b97f4a7c15U;  // of Fibonacci hashing
      return std::hash<double>{}(key.first) * kOddMultiplier + std::hash<double>{}(key.second);
    }
  };

  bool is_at(std::uint32_t position, const Pair& key) const {
    return position < keys_.size() && keys_[position] == key;
  }

  std::uint32_t looked_up(const Pair& key, const Value& value) {
    const auto [found, is_new] = positions_.try_emplace(key, static_cast<std::uint32_t>(values_.size()));
    if (is_new) {
      values_.push_back(value);
      keys_.push_back(key);
    }
    return found->second;
  }

  std::unordered_map<Pair, std::uint32_t, Hash> positions_;
  std::vector<Pair> keys_;  ///< of the values
  std::vector<Value>& values_;
  std::uint32_t last_position_ = 0;
};

}  // namespace dolp
