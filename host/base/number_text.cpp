#include "base/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace dolp {

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace dolp
