#include <dolp/number_range.hpp>

#include <fmt/format.h>

#include <cmath>

namespace dolp {
namespace {

std::string range_end_text(double value) {
  const std::string text = fmt::format("{:g}", value);
  const double exponent = std::log10(value);
  const bool is_large_power_of_ten = value >= 1e4 && exponent == std::round(exponent);
  return is_large_power_of_ten && std::isfinite(value) ? fmt::format("1e{}", static_cast<int>(exponent)) : text;
}

}  // namespace

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  const bool above = ends == Ends::kOpenBelow ? value > min : value >= min;
  const bool below = ends == Ends::kOpenAbove ? value < max : value <= max;
  return above && below;
}

std::string NumberRange::text() const {
  const bool open_below = ends == Ends::kOpenBelow || std::isinf(min);
  const bool open_above = ends == Ends::kOpenAbove || std::isinf(max);
  return fmt::format("{}{}, {}{}", open_below ? '(' : '[', range_end_text(min), range_end_text(max),
                     open_above ? ')' : ']');
}

}  // namespace dolp
