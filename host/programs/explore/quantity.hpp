// What a curve or a map can show of an entry.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "explore/points.hpp"

namespace dolp::explore {

enum class Quantity { kDolp, kSignedDolp, kRhoS, kRhoP, kEmissivityS, kEmissivityP, kAlbedo };

struct QuantityDescription {
  Quantity quantity;
  const char* name;     ///< UTF-8
  const char* meaning;  ///< UTF-8, with the equation
  bool in_percent;      ///< shown times 100
  bool needs_rho;       ///< a plan that drops effects may not give it
};
std::span<const QuantityDescription> quantities();
const QuantityDescription& described(Quantity quantity);

/// The value of an entry; NaN where the model gives none.
double value_of(Quantity quantity, const Point& point);

/// The bound of its numerical error.
double error_of(Quantity quantity, const Point& point);

/// "good", or what its status bits say, in few words.
std::string status_text(std::uint32_t status);

}  // namespace dolp::explore
