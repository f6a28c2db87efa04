// Fuzzes the readers of files that give a quantity over the wavelength.
#include "fuzz.hpp"
#include "scene/spectral_data.hpp"

void dolp::fuzz::read(const std::string& text) {
  static const InputFile file(".csv");
  file.write(text);
  refused([&] { dolp::read_irradiance_file(file.path(), ""); });
  refused([&] { response_spectrum(parse_response(text, "r.csv"), ResponsePer::kPhoton); });
  refused([&] { parse_diffuse(text, "d.csv"); });
}
