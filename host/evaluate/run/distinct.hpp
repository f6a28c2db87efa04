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
    if (is_empty_ || key != last_key_) {
      const auto [found, is_new] = positions_.try_emplace(key, static_cast<std::uint32_t>(values_.size()));
      if (is_new) values_.push_back(value);
      last_key_ = key;
      last_position_ = found->second;
      is_empty_ = false;
    }
    return last_position_;
  }

 private:
  struct Hash {
    std::size_t operator()(const Pair& key) const {
      constexpr std::size_t kOddMultiplier = 0x9e3779b97f4a7c15U;  // of Fibonacci hashing
      return std::hash<double>{}(key.first) * kOddMultiplier + std::hash<double>{}(key.second);
    }
  };
  std::unordered_map<Pair, std::uint32_t, Hash> positions_;
  std::vector<Value>& values_;
  // The axes of a grid repeat the same value many times over.
  Pair last_key_;
  std::uint32_t last_position_ = 0;
  bool is_empty_ = true;
};

}  // namespace dolp
