// Fuzzes the reader of measured data.
#include <dolp/fit.hpp>

#include "fuzz.hpp"

void dolp::fuzz::read(const std::string& text) {
  refused([&] { dolp::MeasuredData::from_csv(text, "measured.csv"); });
}
