// Numbers for tests: random numbers, the same on every machine, and equally spaced numbers.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

namespace dolp {

/// How many random draws a test makes: the value of the environment variable, or `otherwise` if it is not set.
inline std::size_t draws_wanted(std::size_t otherwise, const char* variable = "DOLP_PROPERTY_DRAWS") {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::strtoul(text, nullptr, 10) : otherwise;
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(engine_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  std::size_t count(std::size_t low, std::size_t high) { return low + engine_() % (high - low + 1); }

 private:
  std::mt19937_64 engine_;
};

inline std::vector<double> spaced(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return values;
}

}  // namespace dolp
