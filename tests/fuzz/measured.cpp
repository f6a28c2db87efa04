// Measured points.
#include "explore/measured.hpp"
#include "fuzz.hpp"

void dolp::fuzz::read(const std::string& text) {
  refused([&] { dolp::explore::parse_measured(text, "measured.csv"); });
}
