// Measured reflectances of a smooth surface.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace dolp {

/// A user's CSV with the columns beta_deg (angle of incidence, from 0 to 90), r_s and r_p, and wavelength_um where the
/// reflectances depend on it: then each wavelength has the same angles.
///
/// Domain: reflectances in [0, 1], which agree at 0 degrees to 0.01 (their mean is taken).
/// Errors: InputError with file and line; `prefix` begins the message when the file cannot be opened.
ReflectanceTable read_reflectance_file(const std::string& path, const std::string& prefix);

/// Reads a text instead of a file; `name` begins messages. Errors: InputError with the line.
ReflectanceTable parse_reflectances(const std::string& text, const std::string& name);

}  // namespace dolp
