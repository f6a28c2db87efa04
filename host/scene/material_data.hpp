// Refractive indices: the materials that are built in, and the user's own files.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// A material that is tabulated at a single wavelength may be used this far from it. Units: um.
/// 0.1% of 10.6 um: the CO2 laser line and its rounding, not a claim that n and k are flat.
inline constexpr double kSingleWavelengthReachUm = 0.01;

/// The names in host/materials.csv, in the file's order.
std::vector<std::string> material_names();

/// The built-in material called `name`, for use over `spectrum`.
///
/// Case does not matter, and a name may be cut at a blank where that leaves one material ("water" for "water 25C").
/// Errors: InputError that begins with `prefix`: unknown name (with the nearest), or tabulated elsewhere: a table must
/// cover the spectrum, a single wavelength must be within kSingleWavelengthReachUm of it.
Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix);

/// A user's file of n and k over wavelength [um], linear in between, for use over `spectrum`.
///
/// `.yml`, `.yaml`: a "full database record" of refractiveindex.info whose DATA items are tabulated nk, n or k, or a
/// formula 1 to 9 for n, with or without tabulated k.
/// Anything else: CSV with a line of column names, `wl` or `wavelength_um` first, then n, k or both; a further such
/// line begins a further table, as in the CSV that refractiveindex.info exports. # begins a comment line. Without k, k
/// = 0. Errors: InputError with file and line; `prefix` begins the message when the file cannot be opened or does not
/// cover the spectrum.
Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix);

/// Appends n, k or both at one wavelength to the material's tables, after checking their ranges; `where` begins the
/// message.
void append_index(Material& material, double wavelength_um, std::optional<double> n, std::optional<double> k,
                  const std::string& where);

/// The material as a scene uses it: constant where a single wavelength is all there is, and covering the spectrum.
/// Errors: InputError that begins with `prefix`.
Material fit_to_spectrum(Material material, const Spectrum& spectrum, const std::string& prefix);

}  // namespace dolp
