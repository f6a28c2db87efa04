// The attributes of a table that hold its scene and its optical data, and the scene that follows from them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// The attribute "scene_overrides" of a table: one setting a line, KEY=VALUE. A setting whose value contains line ends
/// stays whole, because only a scene key begins a new one.
std::string settings_text(const std::vector<Setting>& settings);
std::vector<Setting> settings_of(const std::string& text);

/// The attribute "scene_hash": FNV-1a, 64 bits, over the scene's text and settings. It only tells whether two tables
/// come from one scene.
std::string scene_hash(const SceneValues& scene);
std::uint64_t scene_seed(const SceneValues& scene);  ///< the number itself

/// Refuses a file that is not there, or is of a format that does not hold its scene. Errors: InputError.
void check_may_hold_scene(const std::string& path);

/// Reads a table file that holds its scene. Errors: errors of check_may_hold_scene and read_table.
TableValues load_table(const std::string& path);

/// The sources of the n, k and E0 that a scene names.
enum class NamedData {
  kOfTable,  ///< only the table; no file is opened
  kOfFiles,  ///< what the names stand for now: files are looked for beside the scene as the table's attribute
             ///< "scene_path" has it, from the folder where the program runs
};

/// The scene of a table, whose settings are applied.
///
/// Errors: InputError that begins with `name`: no scene in the table, a scene that was changed after the table was
/// made, or a scene that the reader refuses.
SceneValues table_scene(const TableHead& table, const std::string& name, NamedData named_data = NamedData::kOfTable);

/// The scene's position of a value on an axis with labels, by its label.
/// Errors: InputError that begins with `name` for a label that the scene lacks.
double scene_position(const TableHead& table, Axis axis, double value, const SceneValues& scene,
                      const std::string& name);

/// Turns the table's values on axes with labels into the scene's positions, which a part of a table numbers otherwise.
/// Errors: InputError that begins with `name` for a label that the scene lacks.
void use_scene_labels(TableHead& table, const SceneValues& scene, const std::string& name);

/// n and k of materials: CSV of number (from 1), quantity (name, n, k or formula), wavelength_um, value. Empty without
/// materials.
std::string materials_text(const std::vector<const Material*>& materials, bool has_wavelength_axis);

/// materials_text of the films of a coating, and of the grid's materials.
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
