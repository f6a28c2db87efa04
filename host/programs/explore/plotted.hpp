// Quantities that a curve or a map can show.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "explore/points.hpp"

namespace dolp::explore {

enum class Plotted { kDolp, kSignedDolp, kRhoS, kRhoP, kEmissivityS, kEmissivityP, kAlbedo };

struct PlottedDescription {
  Plotted quantity;
  const char* name;     ///< UTF-8
  const char* meaning;  ///< UTF-8, with the equation
  bool in_percent;      ///< shown times 100
  bool needs_rho;       ///< a plan that drops effects may not give it
};
std::span<const PlottedDescription> all_plotted();
const PlottedDescription& described(Plotted quantity);

/// The value of an entry; NaN where the model gives none.
double value_of(Plotted quantity, const Point& point);

/// The bound of its numerical error.
double error_of(Plotted quantity, const Point& point);

/// "good", or the meaning of its status bits, in few words.
std::string status_text(std::uint32_t status);

}  // namespace dolp::explore
