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
/// Case does not matter, and a name may be cut at a blank where that leaves one material ("water" for "water 25C").
/// Errors: InputError that begins with `prefix`: unknown name, with the nearest.
const Material& named_material(std::string_view name, const std::string& prefix);

/// The same for use over `spectrum`. Errors: likewise, and for a spectrum that its table does not cover, with the range
/// of the table.
Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix);

/// A user's file of n and k over wavelength [um], linear in between, for use over `spectrum`.
///
/// `.yml`, `.yaml`: a "full database record" of refractiveindex.info whose DATA items are tabulated nk, n or k, or a
/// formula 1 to 9 for n, with or without tabulated k.
/// Anything else: CSV with a line of column names, `wl` or `wavelength_um` first, then n, k or both; a further such
/// line begins a further table, as in the CSV that refractiveindex.info exports. # begins a comment line. A file
/// without k has k = 0.
/// Errors: InputError with file and line; `prefix` begins the message when the file cannot be opened or does not cover
/// the spectrum.
Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix);

/// Appends n, k or both at one wavelength to the material's tables, after checking their ranges; `where` begins the
/// message.
void append_index(Material& material, double wavelength_um, std::optional<double> n, std::optional<double> k,
                  const std::string& where);

/// The wavelengths at which a tabulated material has both n and k.
Spectrum known_range(const Material& material);

/// Refuses a tabulated material that has no n and k over the whole spectrum; `prefix` begins the message.
void check_covers(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// A tabulated material as a scene uses it: over a band its tables, at a single wavelength the constant index there.
/// Errors: those of check_covers.
Material fit_to_spectrum(const Material& material, const Spectrum& spectrum, const std::string& prefix);

}  // namespace dolp
