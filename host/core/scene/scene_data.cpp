#include "scene/scene_data.hpp"

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

/// Reads a file that a scene names. With `known`, messages begin with `prefix` and quote no text of the file.
template <class Read>
auto read_file_of(SceneValues& scene, const std::string& file, const std::string& prefix, const KnownData* known,
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

/// Loads the material of the surface or of a film. `stored`: the material from a table file, or null.
void load_material(SceneValues& scene, const SceneDocument& document, const std::string& table, Material& material,
                   std::string& name, const std::string& file, const KnownData* known, const Material* stored) {
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
  if (stored) {
    material = *stored;
    material.name = is_file ? file : name;
    if (material.is_constant()) return;
    material = fit_to_spectrum(material, scene.spectrum, prefix);
  } else if (is_file) {
    material = read_file_of(scene, file, prefix, known, [&](const std::string& path) {
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

/// Loads the materials of the grid's axis. The first becomes the material of the scene.
void load_axis_materials(SceneValues& scene, const SceneDocument& document, const KnownData* known) {
  if (!document.find("grid.material")) return;
  const std::string prefix = document.prefix("grid.material");
  std::vector<Material> materials;
  if (known && !known->materials.empty()) {
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

void load_materials(SceneValues& scene, const SceneDocument& document, const KnownData* known) {
  Surface& surface = scene.surface;
  load_axis_materials(scene, document, known);
  load_material(scene, document, "surface", surface.material, scene.names.material, scene.names.material_file, known,
                known && known->material ? &*known->material : nullptr);
  for (std::size_t i = 0; i < surface.coating.size(); ++i) {
    SceneNames::OfLayer& names = scene.names.coating[i];
    const bool is_known = known && i < known->layers.size() && known->layers[i];
    load_material(scene, document, fmt::format("surface.coating.{}", i + 1), surface.coating[i].material,
                  names.material, names.material_file, known, is_known ? &*known->layers[i] : nullptr);
  }
  if (!document.find("surface.reflectance_file")) return;
  const std::string prefix = document.prefix("surface.reflectance_file");
  if (!surface.coating.empty()) throw InputError(prefix + "cannot be combined with surface.coating");
  ReflectanceTable table =
      known && known->reflectance
          ? *known->reflectance
          : read_file_of(scene, scene.names.reflectance_file, prefix, known,
                         [&](const std::string& path) { return read_reflectance_file(path, prefix); });
  if (!table.wavelength_um.empty()) check_covers({table.wavelength_um, {}}, all_wavelengths(scene), prefix);
  surface.reflectance = std::make_shared<const ReflectanceTable>(std::move(table));
}

void load_source(SceneValues& scene, const SceneDocument& document, const KnownData* known) {
  const bool is_preset = document.find("source.preset") != nullptr;
  if (!is_preset && !document.find("source.file")) return;
  const std::string prefix = document.prefix(is_preset ? "source.preset" : "source.file");
  Source& source = *scene.source;
  source.kind = Source::Kind::kTabulated;
  if (known && known->irradiance) {
    source.table = *known->irradiance;
    if (is_preset) source.table.interpolation = SpectralTable::Interpolation::kLogLog;
  } else if (is_preset) {
    source.table = sun_irradiance();
  } else {
    source.table = read_file_of(scene, scene.names.source_file, prefix, known,
                                [&](const std::string& path) { return read_irradiance_file(path, prefix); });
  }
  check_covers(source.table, all_wavelengths(scene), prefix);
}

void load_profile(SceneValues& scene, const SceneDocument& document, const KnownData* known) {
  if (!document.find("surroundings.profile")) return;
  const std::string prefix = document.prefix("surroundings.profile");
  const char* const air_key =
      document.find("surroundings.vapour_cm") ? "surroundings.vapour_cm" : "surroundings.air_temperature_K";
  std::optional<SkyProfile> profile = built_in_sky(scene.names.profile, scene.surroundings->air,
                                                   document.find(air_key) ? document.prefix(air_key) : prefix);
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
    profile = read_file_of(scene, scene.names.profile, prefix, known,
                           [&](const std::string& path) { return read_sky_profile(path, prefix); });
  }
  if (!profile->wavelength_um.empty()) check_covers({profile->wavelength_um, {}}, all_wavelengths(scene), prefix);
  scene.surroundings->set_sky(std::move(*profile));
}

}  // namespace

void load_named_data(SceneValues& scene, const SceneDocument& document, const KnownData* known) {
  load_materials(scene, document, known);
  load_source(scene, document, known);
  load_profile(scene, document, known);
}

}  // namespace dolp
