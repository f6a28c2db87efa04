// The optical data of a surface as text, for tables that hold what they were computed from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// n and k of materials: CSV of number (from 1), quantity (name, n, k or formula), wavelength_um, value. Empty without
/// materials.
std::string materials_text(const std::vector<const Material*>& materials, bool has_wavelength_axis);

/// The same for the films of a coating, and for the grid's axis of materials.
std::string coating_text(const Surface& surface, bool has_wavelength_axis);
std::string axis_materials_text(const SceneModel& scene, bool has_wavelength_axis);

/// The materials of such a text. Errors: InputError that begins with `name`.
std::vector<std::optional<Material>> parse_materials(const std::string& text, const std::string& name);

/// Measured reflectances: CSV as read_reflectance_file takes it. Empty without them.
std::string reflectance_text(const Surface& surface);

/// Number and coefficients of a dispersion formula.
std::string formula_text(const Dispersion& formula);

/// Errors: InputError that begins with `where`.
Dispersion parse_formula(const std::string& text, const std::string& where);

}  // namespace dolp
