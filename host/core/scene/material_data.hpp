#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The materials of host/data/materials.csv with their sources, in the order of host/data/materials_sources.csv.
const std::vector<Material>& built_in_materials();

/// The built-in material with this name. If there is none: the one whose name begins with the words `name`. If there is
/// none: the one whose name contains them. Null if no material or several materials fit.
const Material* match_material(std::string_view name);

/// Finds a built-in material by its name, or by whole words of the name: "water" finds "water 25C". Case is ignored.
/// Errors: InputError that begins with `prefix` and suggests names, if not exactly one material fits.
const Material& named_material(std::string_view name, const std::string& prefix);

Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix);

/// Reads a user's file of n and k, linear between the rows. Returns fit_to_spectrum() of the material in the file.
/// - A .yml or .yaml file is a "full database record" of refractiveindex.info: tables of n and k, or a formula for n.
/// - Any other file has one or more tables below lines of names, with the separators and comments of kDataFile.
///   Columns: a wavelength, wavenumber or energy (see CsvColumns), and n, k or both; or eps_1 and eps_2.
/// - An .lnk file of optool may lack the names wavelength_um, n and k, and may begin with its number of rows.
/// If the file has no k, k is 0. A k from -1e-5 to 0 is noise and counts as 0. If all k are negative, the file gives
/// n - ik. Rows with NaN are left out.
/// Errors: InputError with file and line. If the file cannot be opened, the message begins with `prefix`.
Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix);

/// The range of wavelengths in which a tabulated material has both n and k.
Spectrum known_range(const Material& material);

/// Refuses a tabulated material that lacks n or k in a part of the spectrum, or has NaN there. The message begins with
/// `prefix`.
void check_covers(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// Refuses a material whose formula gives an n out of range, for example near a pole. Checks 1001 points of a band.
void check_formula(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// For a band, returns `material`. For a single wavelength, returns a material whose constant index is the index at
/// this wavelength. Its member `tabulated` points to a copy of `material`. Errors: see check_covers, check_formula.
Material fit_to_spectrum(const Material& material, const Spectrum& spectrum, const std::string& prefix);

/// Reads a user's CSV with the columns beta_deg (angle of incidence, from 0 to 90), r_s and r_p. If the reflectances
/// depend on the wavelength, the file has a column wavelength_um too, and the same angles at each wavelength.
/// Domain: reflectances in [0, 1]. At 0 degrees r_s and r_p differ by at most 0.01; both are replaced by their mean.
/// Errors: InputError with file and line.
ReflectanceTable parse_reflectances(const std::string& text, const std::string& name);

}  // namespace dolp
