// Fuzzes the reader of irradiance files.
#include "fuzz.hpp"
#include "scene/spectral_data.hpp"

void dolp::fuzz::read(const std::string& text) {
  static const InputFile file(".csv");
  file.write(text);
  refused([&] { dolp::read_irradiance_file(file.path(), ""); });
}
