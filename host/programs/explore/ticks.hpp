// Positions of an axis's tick marks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::explore {

/// Round values between `low` and `high`, at most `most` of them: multiples of 1, 2 or 5 times a power of ten.
/// Domain: low < high, both finite; `most` at least 2.
std::vector<double> linear_ticks(double low, double high, std::size_t most);

/// Powers of ten, with 2 and 5 between them where that leaves at most `most`.
/// Domain: 0 < low < high.
std::vector<double> log_ticks(double low, double high, std::size_t most);

/// A tick as text, as short as it is exact.
std::string tick_text(double value);

}  // namespace dolp::explore
