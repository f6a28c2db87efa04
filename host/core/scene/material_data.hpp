// Refractive indices: the materials that are built in, and the user's own files.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The materials of host/data/materials.csv, with their sources, in the order of host/data/materials_sources.csv.
const std::vector<Material>& built_in_materials();

/// The built-in material called `name`.
///
/// Case does not matter, and whole words of a name do where that leaves one material ("water" for "water 25C", "quartz"
/// for "SiO2 amorphous quartz").
/// Errors: InputError that begins with `prefix`: unknown name, with the nearest.
const Material& named_material(std::string_view name, const std::string& prefix);

/// The built-in material called `name`, for use over `spectrum`. Errors: errors of named_material and fit_to_spectrum.
Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix);

/// A user's file of n and k over wavelength [um], linear in between, for use over `spectrum`.
///
/// `.yml`, `.yaml`: a "full database record" of refractiveindex.info whose DATA items are tabulated nk, n or k, or a
/// formula 1 to 9 for n, with or without tabulated k.
/// Anything else: CSV with the columns `wavelength_um` (or `wl`), n, k or both; a further line of names begins a
/// further table, as in the CSV that refractiveindex.info exports. # begins a comment line. A file without k has k = 0,
/// and a k that is below 0 by up to 1e-5 counts as 0. append_rows takes the rows of a table.
/// Errors: InputError with file and line; `prefix` begins the message when the file cannot be opened; errors of
/// fit_to_spectrum.
Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix);

/// Appends n, k or both at one wavelength to the material's tables, after checking their ranges; `where` begins the
/// message.
void append_index(Material& material, double wavelength_um, std::optional<double> n, std::optional<double> k,
                  const std::string& where);

/// The wavelengths at which a tabulated material has both n and k.
Spectrum known_range(const Material& material);

/// Refuses a tabulated material that has no n and k over the whole spectrum; `prefix` begins the message.
void check_covers(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// Refuses a material whose formula has a pole in the spectrum. Looks at 1001 wavelengths of a band.
void check_formula(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// A tabulated material as a scene uses it: over a band its tables, at a single wavelength the constant index there.
/// Errors: InputError of check_covers and check_formula.
Material fit_to_spectrum(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// A user's CSV with the columns beta_deg (angle of incidence, from 0 to 90), r_s and r_p, and wavelength_um where the
/// reflectances depend on it: then each wavelength has the same angles.
///
/// Domain: reflectances in [0, 1], which agree at 0 degrees to 0.01 (their mean is taken).
/// Errors: InputError with file and line; `prefix` begins the message when the file cannot be opened.
ReflectanceTable read_reflectance_file(const std::string& path, const std::string& prefix);

/// Reads a text instead of a file; `name` begins messages. Errors: InputError with the line.
ReflectanceTable parse_reflectances(const std::string& text, const std::string& name);

}  // namespace dolp
