#include "scene/material_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.hpp"
#include "scene/embedded_data.hpp"
#include "scene/number_range.hpp"
#include "scene/spectral_data.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

/// The cells of a CSV line; a cell in double quotes may hold commas.
std::vector<std::string> split_csv(std::string_view line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = std::string(trim(cell));
  return cells;
}

/// A line of the built-in file: name, wavelength_um, n, k, bracket_um, rii_path, source.
enum MaterialColumn : std::size_t { kName = 0, kWavelength = 1, kIndexN = 2, kIndexK = 3, kSource = 6, kColumns = 7 };

std::vector<Material> built_in_materials() {
  std::vector<Material> materials;
  const std::vector<std::string_view> lines = split_lines(embedded_materials_csv());
  bool is_header = true;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].front() == '#') continue;
    if (is_header) {
      is_header = false;
      continue;
    }
    const std::string where = fmt::format("materials.csv (built in):{}: ", i + 1);
    const std::vector<std::string> cells = split_csv(lines[i]);
    if (cells.size() != kColumns) throw InputError(where + "7 columns are expected");
    if (materials.empty() || materials.back().name != cells[kName]) {
      materials.push_back({cells[kName], cells[kSource], {}, {}, {}});
    }
    append_index(materials.back(), parse_cell(cells[kWavelength], "wavelength_um", where),
                 parse_cell(cells[kIndexN], "n", where), parse_cell(cells[kIndexK], "k", where), where);
  }
  return materials;
}

/// The one material of that name, or the only one that begins with it up to a blank.
const Material* match_name(const std::vector<Material>& materials, std::string_view name) {
  const std::string wanted = lower_case(trim(name));
  const Material* match = nullptr;
  for (const Material& material : materials) {
    const std::string known = lower_case(material.name);
    if (known == wanted) return &material;
    if (known.starts_with(wanted + ' ')) {
      if (match) return nullptr;
      match = &material;
    }
  }
  return match;
}

/// Where a name is cut too short, what it could be; else the nearest name.
std::string name_hint(std::string_view name) {
  std::vector<std::string> begin_alike;
  for (const std::string& known : material_names()) {
    if (lower_case(known).starts_with(lower_case(trim(name)))) begin_alike.push_back(known);
  }
  return begin_alike.empty() || trim(name).empty() ? nearest_name(name, material_names()) : join(begin_alike);
}

}  // namespace

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const Material& material : built_in_materials()) names.push_back(material.name);
  return names;
}

Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix) {
  const std::vector<Material> materials = built_in_materials();
  if (const Material* material = match_name(materials, name)) return fit_to_spectrum(*material, spectrum, prefix);
  throw InputError(
      fmt::format("{}unknown material; the nearest of the {} known: {}", prefix, materials.size(), name_hint(name)));
}

OpticalConstants Material::at(double wavelength_um) const {
  if (is_constant()) return constant;
  return {n.at(wavelength_um), k.wavelength_um.empty() ? constant.k : k.at(wavelength_um)};
}

void append_index(Material& material, double wavelength_um, std::optional<double> n, std::optional<double> k,
                  const std::string& where) {
  const auto append = [&](SpectralTable& table, const char* name, double value, const NumberRange& range) {
    if (!range.contains(value))
      throw InputError(fmt::format("{}{} = {}: must be in {}", where, name, value, range.text()));
    append_row(table, wavelength_um, value, where);
  };
  if (n) append(material.n, "n", *n, kNRange);
  if (k) append(material.k, "k", *k, kKRange);
}

Material fit_to_spectrum(Material material, const Spectrum& spectrum, const std::string& prefix) {
  const bool has_k = !material.k.wavelength_um.empty();
  const bool is_single =
      material.n.wavelength_um.size() == 1 && (!has_k || material.k.wavelength_um == material.n.wavelength_um);
  double min_um = material.n.wavelength_um.front();
  double max_um = material.n.wavelength_um.back();
  if (is_single) {
    const bool is_near = std::abs(spectrum.min_um - min_um) <= kSingleWavelengthReachUm && !spectrum.is_band();
    if (is_near) {
      return {
          material.name, material.source, {material.n.value.front(), has_k ? material.k.value.front() : 0.0}, {}, {}};
    }
  } else {
    if (has_k) {
      min_um = std::max(min_um, material.k.wavelength_um.front());
      max_um = std::min(max_um, material.k.wavelength_um.back());
    }
    if (covers(material.n, spectrum) && (!has_k || covers(material.k, spectrum))) return material;
  }
  throw InputError(fmt::format("{}n and k of \"{}\" are known at {}, and the spectrum is {}", prefix, material.name,
                               wavelength_text(min_um, max_um), wavelength_text(spectrum.min_um, spectrum.max_um)));
}

}  // namespace dolp
