#include "base/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace dolp {

void append_number(std::string& text, double value) {
  if (std::isnan(value)) {  // whatever its sign
    text += "nan";
    return;
  }
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

}  // namespace dolp
