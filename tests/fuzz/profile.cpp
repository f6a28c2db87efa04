// Fuzzes the reader of sky profiles.
#include "fuzz.hpp"
#include "scene/sky_profile.hpp"

void dolp::fuzz::read(const std::string& text) {
  refused([&] { dolp::parse_sky_profile(text, "sky.csv"); });
}
