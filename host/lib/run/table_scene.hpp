// The attributes of a table that store its scene and the scene's optical data, and functions that restore the scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// The text of the attribute "scene_overrides": settings KEY=VALUE, each on a new line. VALUE may contain line ends.
std::string settings_text(const std::vector<Setting>& settings);
std::vector<Setting> override_settings(const std::string& text);

/// The text of the attribute "scene_hash": 64-bit FNV-1a hash of the scene's text and settings, to compare tables.
std::string scene_hash(const SceneValues& scene);
std::uint64_t scene_seed(const SceneValues& scene);  ///< the same hash as a number

void check_may_hold_scene(const std::string& path);

/// Reads a table. Errors: errors of read_table; InputError if there is no file or its format does not store a scene.
TableValues load_table(const std::string& path);

/// Where table_scene() gets data that a scene refers to by name, such as n, k and E0.
enum class NamedData {
  kOfTable,  ///< from the table; no file is opened
  kOfFiles,  ///< from the files that the scene names, relative to the folder of the attribute "scene_path"
};

/// True if the file at `path` begins like a NetCDF file.
bool is_table_file(const std::string& path);

/// The scene from which a table was made, with its settings applied. Its member `known` has the data of the table, so
/// further settings keep these data. Errors: InputError that begins with `name` if the table has no scene, if its scene
/// was changed later, or if the reader of scenes refuses the scene.
SceneValues table_scene(const TableHead& table, const std::string& name, NamedData named_data = NamedData::kOfTable);

/// Converts a value on an axis with labels (materials, bands) to the position of the same label in the scene. Errors:
/// InputError that begins with `name` if the scene lacks the label.
double scene_position(const TableHead& table, Axis axis, double value, const SceneValues& scene,
                      const std::string& name);

/// Converts the values on all axes with labels to positions in the scene's lists. Errors: errors of scene_position().
void use_scene_labels(TableHead& table, const SceneValues& scene, const std::string& name);

/// Rows of n and k that a table stores: those at the wavelengths of its scene, or all rows of the material.
enum class StoredRows { kOfSpectrum, kAll };

/// The n and k of the films of a coating as CSV, with the columns number (from 1), quantity (name, n, k or formula),
/// wavelength_um and value. Empty if there are no films.
std::string coating_text(const SceneModel& scene, StoredRows rows);
std::string axis_materials_text(const SceneModel& scene, StoredRows rows);  ///< the same for the grid's materials

std::vector<std::optional<Material>> parse_materials(const std::string& text, const std::string& name);

/// The measured reflectances of a surface, in the format of parse_reflectances(). Empty if the surface has none.
std::string reflectance_text(const Surface& surface);

std::string formula_text(const Dispersion& formula);

Dispersion parse_formula(const std::string& text, const std::string& where);

}  // namespace dolp
