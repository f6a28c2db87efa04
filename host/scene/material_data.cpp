#include "scene/material_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"
#include "scene/number_range.hpp"
#include "scene/spectral_data.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

std::string without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return std::string(is_quoted ? cell.substr(1, cell.size() - 2) : cell);
}

/// A line of the built-in file: name, wavelength_um, n, k, bracket_um, rii_path, source.
enum MaterialColumn : std::size_t { kName = 0, kWavelength = 1, kIndexN = 2, kIndexK = 3, kSource = 6, kColumns = 7 };

std::vector<Material> built_in_materials() {
  std::vector<Material> materials;
  CsvReader row(embedded_materials_csv(), "materials.csv (built in)");
  row.next();  // names
  while (row.next()) {
    if (row.cells().size() != kColumns) row.fail("7 columns are expected");
    const std::string name(row.cells()[kName]);
    if (materials.empty() || materials.back().name != name) {
      materials.push_back({name, without_quotes(row.cells()[kSource]), {}, {}, {}});
    }
    append_index(materials.back(), row.number(kWavelength, "wavelength_um"), row.number(kIndexN, "n"),
                 row.number(kIndexK, "k"), row.where());
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
  if (n) append_row(material.n, wavelength_um, {"n", *n, kNRange}, where);
  if (k) append_row(material.k, wavelength_um, {"k", *k, kKRange}, where);
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
