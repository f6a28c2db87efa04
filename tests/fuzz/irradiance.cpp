// Fuzzes the readers of files that give a quantity over the wavelength.
#include "fuzz.hpp"
#include "scene/spectral_data.hpp"

void dolp::fuzz::read(const std::string& text) {
  refused([&] { parse_irradiance(text, "e.csv"); });
  refused([&] { response_spectrum(parse_response(text, "r.csv"), ResponsePer::kPhoton); });
  refused([&] { parse_diffuse(text, "d.csv"); });
}
