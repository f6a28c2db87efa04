#include "scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>
#include <filesystem>
#include <utility>

#include "base/text.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

/// The path with which the process opens `file`. A relative `file` is relative to the folder of the scene.
std::string resolve_path(const std::string& file, const std::string& scene_path) {
  const std::size_t slash = scene_path.find_last_of('/');
  const bool is_as_given = file.starts_with('/') || slash == std::string::npos;
  return is_as_given ? file : scene_path.substr(0, slash + 1) + file;
}

/// The data of the scene's table, if the table's scene has the same name for them; else null.
const KnownData* stored_data(const SceneValues& scene, std::string SceneNames::*name) {
  return scene.known && (*scene.known->names).*name == scene.names.*name ? scene.known.get() : nullptr;
}

/// Reads a file that a scene names. If the scene comes from a table and the table's scene names the file too (`known`),
/// messages begin with `prefix` and quote no text of the file: a table of somebody else may name any file.
template <class Read>
auto read_scene_file(SceneValues& scene, const std::string& file, const std::string& prefix, const KnownData* known,
                     const Read& read) {
  const std::string& path = scene.files.emplace_back(resolve_path(file, scene.path_name));
  if (!known) return read(path);
  if (!known->may_open_files) {
    throw InputError(prefix + "is not in the table; dolp verify --named-files reads it from that file");
  }
  try {
    return read(path);
  } catch (const InputError&) {  // hides the original message, which quotes the file
    throw InputError(prefix + "cannot be read, or holds nothing of the kind");
  }
}

/// The data that the scene's table stores for a file, or read(path) of the file. `name`: the file in SceneNames.
template <class Data, class Read>
Data stored_or_read(SceneValues& scene, std::string SceneNames::*name, std::optional<Data> KnownData::*stored,
                    const std::string& prefix, const Read& read) {
  const KnownData* const known = stored_data(scene, name);
  if (known && known->*stored) return *(known->*stored);
  return read_scene_file(scene, scene.names.*name, prefix, known, read);
}

Spectrum all_wavelengths(const SceneValues& scene) {
  Spectrum all = scene.spectrum;
  for (const double wavelength_um : scene.grid[Axis::kWavelength]) {
    all.min_um = std::min(all.min_um, wavelength_um);
    all.max_um = std::max(all.max_um, wavelength_um);
  }
  for (const Spectrum& band : scene.bands) {
    all.min_um = std::min(all.min_um, band.min_um);
    all.max_um = std::max(all.max_um, band.max_um);
  }
  return all;
}

/// True if the built-in material `name` has the n and k of `stored` at each wavelength of `stored`.
bool is_built_in(const std::string& name, const Material& stored) {
  const Material* const built_in = match_material(name);
  if (!built_in || stored.is_constant()) return false;
  const Spectrum range = known_range(*built_in);
  for (std::size_t i = 0; i < stored.n.wavelength_um.size(); ++i) {
    const double um = stored.n.wavelength_um[i];
    if (um < range.min_um || um > range.max_um) return false;
    const OpticalConstants here = built_in->at(um), there = stored.at(um);
    if (here.n != there.n || here.k != there.k) return false;
  }
  return true;
}

/// The place of a material in a scene.
struct MaterialPlace {
  std::string table;  ///< TOML table
  MaterialNames& names;
  const MaterialNames* known_names = nullptr;       ///< names in the scene of KnownData; null if it lacks the place
  const std::optional<Material>* stored = nullptr;  ///< material in KnownData; null if it lacks the place
};

/// Loads the material of the surface or of a film. Built-in data replace equal stored data, which may have one row.
void load_material(SceneValues& scene, const SceneDocument& document, const MaterialPlace& place, Material& material) {
  const std::string& table = place.table;
  auto& [name, file] = place.names;
  const bool is_file = document.find(table + ".material_file") != nullptr;
  if (!is_file && !document.find(table + ".material")) return;
  const std::string prefix = document.prefix(table + (is_file ? ".material_file" : ".material"));
  const auto check_axis = [&](const Material& used) {
    const Material& known_everywhere = used.tabulated ? *used.tabulated : used;
    for (const Spectrum& band : scene.bands) check_covers(known_everywhere, band, prefix);
    for (const double um : scene.grid[Axis::kWavelength]) {
      check_covers(known_everywhere, {um, um}, prefix);
      check_formula(known_everywhere, {um, um}, prefix);
    }
  };
  const bool is_known = place.known_names && *place.known_names == place.names;
  const bool is_stored = is_known && place.stored && *place.stored;
  if (is_stored && (is_file || !is_built_in(name, **place.stored))) {
    material = **place.stored;
    material.name = is_file ? file : name;
    if (material.is_constant()) return;
    material = fit_to_spectrum(material, scene.spectrum, prefix);
  } else if (is_file) {
    const KnownData* const known = is_known ? scene.known.get() : nullptr;
    material = read_scene_file(scene, file, prefix, known, [&](const std::string& path) {
      Material read = read_material_file(path, scene.spectrum, prefix);
      check_axis(read);
      return read;
    });
  } else {
    material = find_material(name, scene.spectrum, prefix);
    name = material.name;
  }
  check_axis(material);
}

/// The full names of the materials on the grid's axis. "all" means all built-in materials that cover the spectrum.
std::vector<std::string> axis_names(const SceneValues& scene, const std::string& prefix) {
  std::vector<std::string> names;
  const std::vector<std::string>& given = scene.labels[Axis::kMaterial];
  const bool is_all = given == std::vector<std::string>{"all"};
  const Spectrum spectrum = all_wavelengths(scene);
  for (const Material& material : is_all ? built_in_materials() : std::vector<Material>{}) {
    const Spectrum range = known_range(material);
    if (range.min_um <= spectrum.min_um && spectrum.max_um <= range.max_um) names.push_back(material.name);
  }
  for (const std::string& name : is_all ? std::vector<std::string>{} : given)
    names.push_back(named_material(name, prefix + '"' + one_line(name) + "\": ").name);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) != name) throw InputError(prefix + '"' + *name + "\" appears twice");
  }
  if (names.empty()) throw InputError(prefix + "no built-in material covers the spectrum");
  return names;
}

bool are_built_in(const std::vector<Material>& materials) {
  return std::ranges::all_of(materials, [](const Material& material) { return is_built_in(material.name, material); });
}

/// Loads the materials of the grid's axis. The first becomes the material of the scene.
void load_axis_materials(SceneValues& scene, const SceneDocument& document) {
  if (!document.find("grid.material")) return;
  const std::string prefix = document.prefix("grid.material");
  std::vector<Material> materials;
  const KnownData* const known = scene.known.get();
  const bool is_stored = known && known->axis_names == scene.labels[Axis::kMaterial];
  if (is_stored && !known->materials.empty() && !are_built_in(known->materials)) {
    for (const Material& material : known->materials)
      materials.push_back(material.is_constant() ? material : fit_to_spectrum(material, scene.spectrum, prefix));
  } else {
    for (const std::string& name : axis_names(scene, prefix))
      materials.push_back(find_material(name, scene.spectrum, prefix));
  }
  std::vector<std::string>& labels = scene.labels[Axis::kMaterial];
  labels.clear();
  for (const Material& material : materials) {
    const Material& all = material.tabulated ? *material.tabulated : material;
    if (!all.is_constant()) check_covers(all, all_wavelengths(scene), prefix);
    scene.grid[Axis::kMaterial].push_back(static_cast<double>(labels.size()));
    labels.push_back(material.name);
  }
  scene.surface.material = materials.front();
  scene.names.material = labels.front();
  scene.materials = std::make_shared<const std::vector<Material>>(std::move(materials));
}

void load_materials(SceneValues& scene, const SceneDocument& document) {
  Surface& surface = scene.surface;
  const KnownData* const known = scene.known.get();
  load_axis_materials(scene, document);
  MaterialPlace medium{"surface", scene.names};
  if (known) medium.known_names = &*known->names;
  if (known) medium.stored = &known->material;
  load_material(scene, document, medium, surface.material);
  for (std::size_t i = 0; i < surface.coating.size(); ++i) {
    MaterialPlace layer{fmt::format("surface.coating.{}", i + 1), scene.names.coating[i]};
    if (known && i < known->names->coating.size()) layer.known_names = &known->names->coating[i];
    if (known && i < known->layers.size()) layer.stored = &known->layers[i];
    load_material(scene, document, layer, surface.coating[i].material);
  }
  if (!document.find("surface.reflectance_file")) return;
  const std::string prefix = document.prefix("surface.reflectance_file");
  if (!surface.coating.empty()) throw InputError(prefix + "cannot be combined with surface.coating");
  // Unlike other files, this one may be stdin or a pipe.
  const auto read = [&](const std::string& path) { return parse_reflectances(read_text(path, prefix), path); };
  ReflectanceTable table = stored_or_read(scene, &SceneNames::reflectance_file, &KnownData::reflectance, prefix, read);
  if (!table.wavelength_um.empty()) check_covers({table.wavelength_um, {}}, all_wavelengths(scene), prefix);
  surface.reflectance = std::make_shared<const ReflectanceTable>(std::move(table));
}

/// Makes the wavelengths of the camera's response the spectrum of the scene.
void load_response(SceneValues& scene, const SceneDocument& document) {
  if (!document.find("spectrum.response_file")) return;
  const std::string prefix = document.prefix("spectrum.response_file");
  const auto read = [&](const std::string& path) { return parse_response(read_named_file(path, prefix), path); };
  SpectralTable table = stored_or_read(scene, &SceneNames::response_file, &KnownData::response, prefix, read);
  scene.spectrum = response_spectrum(std::move(table), scene.spectrum.response_per);
}

void load_diffuse(SceneValues& scene, const SceneDocument& document) {
  if (!document.find("surface.diffuse_file")) return;
  const std::string prefix = document.prefix("surface.diffuse_file");
  const auto read = [&](const std::string& path) { return parse_diffuse(read_named_file(path, prefix), path); };
  SpectralTable table = stored_or_read(scene, &SceneNames::diffuse_file, &KnownData::diffuse, prefix, read);
  check_covers(table, all_wavelengths(scene), prefix);
  Surface& surface = scene.surface;
  surface.diffuse = largest_value(table, all_wavelengths(scene));
  surface.diffuse_table = std::make_shared<const SpectralTable>(std::move(table));
  if (!scene.spectrum.is_band()) surface.diffuse = surface.diffuse_table->at(scene.spectrum.min_um);
}

void load_source(SceneValues& scene, const SceneDocument& document) {
  const bool is_preset = document.find("source.preset") != nullptr;
  if (!is_preset && !document.find("source.file")) return;
  const std::string prefix = document.prefix(is_preset ? "source.preset" : "source.file");
  SpectralTable table;
  const KnownData* const known = stored_data(scene, is_preset ? &SceneNames::source_preset : &SceneNames::source_file);
  if (known && known->irradiance) {
    table = *known->irradiance;
    if (is_preset) table.interpolation = SpectralTable::Interpolation::kLogLog;
  } else if (is_preset) {
    table = sun_irradiance();
  } else {
    const auto read = [&](const std::string& path) { return parse_irradiance(read_named_file(path, prefix), path); };
    table = read_scene_file(scene, scene.names.source_file, prefix, known, read);
  }
  check_covers(table, all_wavelengths(scene), prefix);
  scene.source->table = std::make_shared<const SpectralTable>(std::move(table));
}

void load_profile(SceneValues& scene, const SceneDocument& document) {
  if (!document.find("surroundings.profile")) return;
  const std::string prefix = document.prefix("surroundings.profile");
  const char* const air_key =
      document.find("surroundings.vapour_cm") ? "surroundings.vapour_cm" : "surroundings.air_temperature_K";
  std::optional<SkyProfile> profile = built_in_sky(scene.names.profile, scene.surroundings->air,
                                                   document.find(air_key) ? document.prefix(air_key) : prefix);
  const KnownData* const known = stored_data(scene, &SceneNames::profile);
  if (!profile && known && known->profile) profile = known->profile;
  std::error_code unknown;
  const std::filesystem::file_status file =
      std::filesystem::status(resolve_path(scene.names.profile, scene.path_name), unknown);
  if (!profile && !known && file.type() == std::filesystem::file_type::not_found) {
    std::vector<std::string> names;
    for (const BuiltInSky& sky : built_in_skies()) names.emplace_back(sky.name);
    const std::optional<std::string> near = near_name(scene.names.profile, names);
    throw InputError(fmt::format("{}no such file, and no built-in sky: {}{}", prefix, join(names),
                                 near ? "; the nearest is " + *near : ""));
  }
  if (!profile) {
    const auto read = [&](const std::string& path) { return parse_sky_profile(read_named_file(path, prefix), path); };
    profile = read_scene_file(scene, scene.names.profile, prefix, known, read);
  }
  if (!profile->wavelength_um.empty()) check_covers({profile->wavelength_um, {}}, all_wavelengths(scene), prefix);
  scene.surroundings->set_sky(std::move(*profile));
}

}  // namespace

void load_named_data(SceneValues& scene, const SceneDocument& document) {
  if (scene.known && !scene.known->names) {
    scene.known->names = scene.names;
    scene.known->axis_names = scene.labels[Axis::kMaterial];
  }
  load_response(scene, document);  // first, because the other data must cover its wavelengths
  load_materials(scene, document);
  load_diffuse(scene, document);
  load_source(scene, document);
  load_profile(scene, document);
}

}  // namespace dolp
