#include "run/table_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <dolp/errors.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include <dolp/number_range.hpp>
#include "base/hash.hpp"
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"
#include "scene/scene_document.hpp"
#include "scene/scene_reader.hpp"
#include "scene/spectral_data.hpp"
#include "table/table_file.hpp"
#include "table/table_reader.hpp"

namespace dolp {
namespace {

constexpr double kMostMaterials = 1e4;

enum Column : std::size_t { kNumber, kQuantity, kWavelength, kValue, kColumns };

/// True if a setting begins in this line: it has a key of a scene, or the name of a TOML table, before an equals sign.
bool begins_setting(std::string_view line) {
  const std::string_view key = trim(line.substr(0, line.find('=')));
  if (line.find('=') == std::string_view::npos) return false;
  return std::ranges::any_of(dolp::keys(), [key](const Key& known) {
    return known.key == key || known.key.starts_with(std::string(key) + '.') || key.starts_with(known.key + '.');
  });
}

/// KEY=VALUE, in one line if override_settings() would take a line of the value for another setting.
std::string stored_text(const Setting& setting) {
  const std::string text = setting.text();
  const std::vector<std::string_view> lines = split(text, '\n');
  if (std::none_of(lines.begin() + 1, lines.end(), begins_setting)) return text;
  SceneDocument document("", "");
  document.apply(setting);
  return setting.key + '=' + toml_text(*document.find(setting.key));
}

SpectralTable checked_table(const Curve& curve, const NamedValue& value, const std::string& where) {
  SpectralTable table;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    append_row(table, curve.wavelength_um[i], {value.name, curve.values[i], value.range}, where);
  }
  return table;
}

std::shared_ptr<KnownData> stored_data(const TableHead& table, const std::string& name) {
  const std::string where = name + ": ";
  const auto stored = std::make_shared<KnownData>(KnownData{.table = name});
  KnownData& known = *stored;
  if (!table.index_n.values.empty() && !table.index_k.values.empty()) {
    Material& material = known.material.emplace();
    material.n = checked_table(table.index_n, {"index_n", 0.0, kNRange}, where);
    material.k = checked_table(table.index_k, {"index_k", 0.0, kKRange}, where);
    material.constant = {material.n.value.front(), material.k.value.front()};
    const std::string* formula = find_attribute<std::string>(table, "index_n_formula");
    if (formula) material.n.formula = parse_formula(*formula, where + "attribute \"index_n_formula\": ");
    if (material.n.value.size() != material.k.value.size()) {
      for (SpectralTable* values : {&material.n, &material.k}) {
        if (values->value.size() == 1) *values = {};  // a constant beside a table
      }
    }
  }
  if (!table.irradiance.values.empty()) {
    known.irradiance = checked_table(table.irradiance, {"irradiance", 0.0, kNonNegativeRange}, where);
  }
  if (const std::string* coating = find_attribute<std::string>(table, "coating"))
    known.layers = parse_materials(*coating, name + ": attribute \"coating\"");
  if (const std::string* materials = find_attribute<std::string>(table, "materials")) {
    for (std::optional<Material>& material : parse_materials(*materials, name + ": attribute \"materials\""))
      known.materials.push_back(std::move(material).value_or(Material()));
  }
  if (const std::string* reflectance = find_attribute<std::string>(table, "reflectance"))
    known.reflectance = parse_reflectances(*reflectance, name + ": attribute \"reflectance\"");
  if (const std::string* response = find_attribute<std::string>(table, "response"))
    known.response = parse_response(*response, name + ": attribute \"response\"");
  if (const std::string* diffuse = find_attribute<std::string>(table, "diffuse"))
    known.diffuse = parse_diffuse(*diffuse, name + ": attribute \"diffuse\"");
  const std::string* profile = find_attribute<std::string>(table, "surroundings_profile");
  if (profile && !profile->empty()) {
    known.profile = parse_sky_profile(*profile, name + ": attribute \"surroundings_profile\"");
  }
  return stored;
}

std::string materials_text(const std::vector<const Material*>& materials, const Spectrum& spectrum, StoredRows rows) {
  if (materials.empty()) return {};
  std::string text = "number,quantity,wavelength_um,value\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& used = *materials[i];
    if (!used.name.empty()) text += fmt::format("{},name,,\"{}\"\n", i + 1, one_line(used.name));
    const Material& material = rows == StoredRows::kAll && used.tabulated ? *used.tabulated : used;
    const std::string constant_um = material.tabulated ? format_number(spectrum.min_um) : "";
    const auto add = [&](const char* quantity, const SpectralTable& table, double constant) {
      if (table.wavelength_um.empty())
        text += fmt::format("{},{},{},{}\n", i + 1, quantity, constant_um, format_number(constant));
      for (std::size_t row = 0; row < table.wavelength_um.size(); ++row) {
        text += fmt::format("{},{},{},{}\n", i + 1, quantity, format_number(table.wavelength_um[row]),
                            format_number(table.value[row]));
      }
    };
    add("n", material.n, material.constant.n);
    add("k", material.k, material.constant.k);
    if (material.n.formula.number != 0)
      text += fmt::format("{},formula,,{}\n", i + 1, formula_text(material.n.formula));
  }
  return text;
}

}  // namespace

std::string formula_text(const Dispersion& formula) {
  std::string text = std::to_string(formula.number);
  for (const double coefficient : formula.coefficients) text += ' ' + format_number(coefficient);
  return text;
}

Dispersion parse_formula(const std::string& text, const std::string& where) {
  Dispersion formula;
  for (const std::string_view word : split(text, ' '))
    formula.coefficients.push_back(parse_number(word).value_or(-1.0));
  formula.number = static_cast<int>(std::clamp(formula.coefficients.front(), -1.0, kDispersionFormulas + 1.0));
  formula.coefficients.erase(formula.coefficients.begin());
  const bool is_known = formula.number >= 1 && formula.number <= kDispersionFormulas;
  const std::vector<std::size_t> counts = is_known ? coefficient_counts(formula.number) : std::vector<std::size_t>{};
  if (std::ranges::find(counts, formula.coefficients.size()) == counts.end()) {
    throw InputError(fmt::format("{}is no dispersion formula", where));
  }
  return formula;
}

std::string coating_text(const SceneModel& scene, StoredRows rows) {
  std::vector<const Material*> films;
  for (const Layer& layer : scene.surface.coating) films.push_back(&layer.material);
  return materials_text(films, scene.spectrum, rows);
}

std::string axis_materials_text(const SceneModel& scene, StoredRows rows) {
  std::vector<const Material*> materials;
  for (std::size_t i = 0; scene.materials && i < scene.materials->size(); ++i)
    materials.push_back(&(*scene.materials)[i]);
  return materials_text(materials, scene.spectrum, rows);
}

std::vector<std::optional<Material>> parse_materials(const std::string& text, const std::string& name) {
  std::vector<std::optional<Material>> materials;
  CsvReader row(text, name);
  row.next();  // skips the row with the column names
  while (row.next()) {
    if (row.cells().size() != kColumns) row.fail("4 columns are expected");
    const double number = row.number(kNumber, "number");
    if (!(number >= 1.0 && number <= kMostMaterials)) row.fail("no such material");
    materials.resize(std::max(materials.size(), static_cast<std::size_t>(number)));
    std::optional<Material>& material = materials[static_cast<std::size_t>(number) - 1];
    if (!material) material.emplace();
    const std::string_view quantity = row.cells()[kQuantity];
    if (quantity == "name") {
      material->name = row.cells()[kValue];
      continue;
    }
    if (quantity == "formula") {
      material->n.formula = parse_formula(std::string(row.cells()[kValue]), row.where());
      continue;
    }
    const bool is_n = quantity == "n";
    const NumberRange& range = is_n ? kNRange : kKRange;
    const double value = row.number(kValue, "value", &range);
    if (row.cells()[kWavelength].empty()) {
      (is_n ? material->constant.n : material->constant.k) = value;
    } else {
      const NamedValue named{is_n ? "n" : "k", value, range};
      append_row(is_n ? material->n : material->k, row.number(kWavelength, "wavelength_um"), named, row.where());
    }
  }
  return materials;
}

std::string reflectance_text(const Surface& surface) {
  if (!surface.reflectance) return {};
  const ReflectanceTable& table = *surface.reflectance;
  const bool has_wavelengths = !table.wavelength_um.empty();
  std::string text = has_wavelengths ? "wavelength_um,beta_deg,r_s,r_p\n" : "beta_deg,r_s,r_p\n";
  for (std::size_t i = 0; i < table.measured.size(); ++i) {
    const MeasuredReflectance& measured = *table.measured[i];
    for (std::size_t j = 0; j < measured.beta_deg.size(); ++j) {
      if (has_wavelengths) text += format_number(table.wavelength_um[i]) + ',';
      text += fmt::format("{},{},{}\n", format_number(measured.beta_deg[j]), format_number(measured.r_s[j]),
                          format_number(measured.r_p[j]));
    }
  }
  return text;
}

std::string settings_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting& setting : settings) text += (text.empty() ? "" : "\n") + stored_text(setting);
  return text;
}

std::vector<Setting> override_settings(const std::string& text) {
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
  for (const Setting& setting : scene.settings) hash = hashed(hash, "\n" + stored_text(setting));
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

bool is_table_file(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  std::array<char, 4> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  const std::string_view bytes(start.data(), start.size());
  return bytes.starts_with("CDF") || bytes == "\x89HDF";
}

TableValues load_table(const std::string& path) {
  check_may_hold_scene(path);
  return read_table(path);
}

double scene_position(const TableHead& table, Axis axis, double value, const SceneValues& scene,
                      const std::string& name) {
  const std::vector<std::string>& known = scene.labels[axis];
  const std::string& label = table.label(axis, value);
  const auto found = std::ranges::find(known, label);
  if (found == known.end())
    throw InputError(fmt::format("{}: {} = \"{}\": is not among those that were computed: {}", name,
                                 describe(axis).name, one_line(label), join(known)));
  return static_cast<double>(found - known.begin());
}

void use_scene_labels(TableHead& table, const SceneValues& scene, const std::string& name) {
  for (const Axis axis : kAllAxes) {
    if (!describe(axis).has_labels) continue;
    for (double& value : table.axes[axis]) value = scene_position(table, axis, value, scene, name);
    table.labels[axis] = scene.labels[axis];
  }
}

SceneValues table_scene(const TableHead& table, const std::string& name, NamedData named_data) {
  const std::string* text = find_attribute<std::string>(table, "scene");
  if (!text) {
    throw InputError(
        fmt::format("{}: has no attribute \"scene\"; only a table that dolp wrote as .nc holds its scene", name));
  }
  const std::string* overrides = find_attribute<std::string>(table, "scene_overrides");
  const std::string* path = find_attribute<std::string>(table, "scene_path");
  const std::shared_ptr<KnownData> known =
      named_data == NamedData::kOfTable ? stored_data(table, name)
                                        : std::make_shared<KnownData>(KnownData{.table = name, .may_open_files = true});
  SceneValues scene;
  try {
    scene = parse_scene(*text, path ? *path : name, overrides ? override_settings(*overrides) : std::vector<Setting>{},
                        known);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: attribute \"scene\": {}", name, error.what()));
  }
  const std::string* hash = find_attribute<std::string>(table, "scene_hash");
  if (hash && *hash != scene_hash(scene)) {
    throw InputError(
        fmt::format("{}: attribute \"scene_hash\" is {}, but its scene has {}: the scene was changed after "
                    "the table was made",
                    name, one_line(*hash), scene_hash(scene)));
  }
  return scene;
}

}  // namespace dolp
