#include "run/table_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>
#include <filesystem>
#include <string_view>

#include <dolp/number_range.hpp>
#include "base/hash.hpp"
#include "base/text.hpp"
#include "run/surface_data.hpp"
#include "scene/reflectance_file.hpp"
#include "scene/scene_reader.hpp"
#include "scene/spectral_data.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

/// A text attribute, or nullptr.
const std::string* find_text(const TableHead& table, std::string_view attribute) {
  const auto found = std::ranges::find(table.attributes, attribute, &Attribute::name);
  return found == table.attributes.end() ? nullptr : std::get_if<std::string>(&found->value);
}

/// True for a line that begins a setting: a key, dotted or at the top of a scene, and an equals sign.
bool begins_setting(std::string_view line) {
  const std::string_view key = trim(line.substr(0, line.find('=')));
  if (line.find('=') == std::string_view::npos) return false;
  return std::ranges::any_of(dolp::keys(), [key](const Key& known) {
    return known.key == key || known.key.starts_with(std::string(key) + '.') || key.starts_with(known.key + '.');
  });
}

/// The table of a curve, checked as one of a file is.
SpectralTable checked_table(const Curve& curve, const NamedValue& value, const std::string& where) {
  SpectralTable table;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    append_row(table, curve.wavelength_um[i], {value.name, curve.values[i], value.range}, where);
  }
  return table;
}

/// n, k, E0 and the sky as the table has them.
KnownData known_data(const TableHead& table, const std::string& name) {
  const std::string where = name + ": ";
  KnownData known;
  if (!table.index_n.values.empty() && !table.index_k.values.empty()) {
    Material& material = known.material.emplace();
    material.n = checked_table(table.index_n, {"index_n", 0.0, kNRange}, where);
    material.k = checked_table(table.index_k, {"index_k", 0.0, kKRange}, where);
    material.constant = {material.n.value.front(), material.k.value.front()};
    const std::string* formula = find_text(table, "index_n_formula");
    if (formula) material.n.formula = parse_formula(*formula, where + "attribute \"index_n_formula\": ");
    for (SpectralTable* values : {&material.n, &material.k}) {
      if (values->value.size() == 1) *values = {};
    }
  }
  if (!table.irradiance.values.empty()) {
    known.irradiance = checked_table(table.irradiance, {"irradiance", 0.0, kNonNegativeRange}, where);
  }
  if (const std::string* coating = find_text(table, "coating"))
    known.layers = parse_materials(*coating, name + ": attribute \"coating\"");
  if (const std::string* materials = find_text(table, "materials")) {
    for (std::optional<Material>& material : parse_materials(*materials, name + ": attribute \"materials\""))
      known.materials.push_back(std::move(material).value_or(Material()));
  }
  if (const std::string* reflectance = find_text(table, "reflectance"))
    known.reflectance = parse_reflectances(*reflectance, name + ": attribute \"reflectance\"");
  const std::string* profile = find_text(table, "surroundings_profile");
  if (profile && !profile->empty()) {
    known.profile = parse_sky_profile(*profile, name + ": attribute \"surroundings_profile\"");
  }
  return known;
}

}  // namespace

std::string settings_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting& setting : settings) text += (text.empty() ? "" : "\n") + setting.text();
  return text;
}

std::vector<Setting> settings_of(const std::string& text) {
  std::vector<std::string> arguments;
  if (text.empty()) return {};
  for (const std::string_view line : split(text, '\n')) {
    if (arguments.empty() || begins_setting(line)) {
      arguments.emplace_back(line);
    } else {
      (arguments.back() += '\n') += line;
    }
  }
  return settings_from_text(arguments);
}

std::uint64_t scene_seed(const SceneValues& scene) {
  std::uint64_t hash = hashed(kHashStart, scene.text);
  for (const Setting& setting : scene.settings) hash = hashed(hash, "\n" + setting.text());
  return hash;
}

std::string scene_hash(const SceneValues& scene) { return fmt::format("fnv1a64:{:016x}", scene_seed(scene)); }

void check_may_hold_scene(const std::string& path) {
  check_regular_file(path, path + ": ");
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".csv" || suffix == ".npy") {
    throw InputError(
        fmt::format("{}: only a table written as .nc holds its scene, which {} files do not in full", path, suffix));
  }
}

TableValues load_table(const std::string& path) {
  check_may_hold_scene(path);
  return read_table(path);
}

void use_scene_labels(TableHead& table, const SceneValues& scene, const std::string& name) {
  for (const Axis axis : kAllAxes) {
    const std::vector<std::string>& known = scene.labels[axis];
    for (double& value : table.axes[axis]) {
      if (!description_of(axis).has_labels) break;
      const std::string& label = table.label(axis, value);
      const auto found = std::ranges::find(known, label);
      if (found == known.end())
        throw InputError(fmt::format("{}: {}: \"{}\" is not among those of its scene: {}", name,
                                     description_of(axis).name, one_line(label), join(known)));
      value = static_cast<double>(found - known.begin());
    }
    table.labels[axis] = known;
  }
}

SceneValues table_scene(const TableHead& table, const std::string& name, NamedData named_data) {
  const std::string* text = find_text(table, "scene");
  if (!text) {
    throw InputError(
        fmt::format("{}: has no attribute \"scene\"; only a table that dolp wrote as .nc holds its scene", name));
  }
  const std::string* overrides = find_text(table, "scene_overrides");
  const std::string* path = find_text(table, "scene_path");
  const KnownData known =
      named_data == NamedData::kOfTable ? known_data(table, name) : KnownData{.may_open_files = true};
  SceneValues scene;
  try {
    scene =
        parse_scene(*text, path ? *path : name, overrides ? settings_of(*overrides) : std::vector<Setting>{}, &known);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: attribute \"scene\": {}", name, error.what()));
  }
  const std::string* hash = find_text(table, "scene_hash");
  if (hash && *hash != scene_hash(scene)) {
    throw InputError(
        fmt::format("{}: attribute \"scene_hash\" is {}, but its scene has {}: the scene was changed after "
                    "the table was made",
                    name, one_line(*hash), scene_hash(scene)));
  }
  return scene;
}

}  // namespace dolp
