#include "scene/material_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "model/films.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

constexpr int kFormulaSteps = 1000;

enum IndexColumn : std::size_t { kIndexName = 0, kWavelength = 1, kN = 2, kK = 3, kIndexColumns = 4 };

enum SourceColumn : std::size_t { kName = 0, kSource = 6, kKind = 7, kSourceColumns = 8 };

std::vector<Material> read_built_in_materials() {
  std::vector<Material> materials;
  CsvReader source(embedded_materials_sources_csv(), "materials_sources.csv (built in)");
  source.next();  // names
  while (source.next()) {
    const std::vector<std::string_view>& cells = source.cells();
    if (cells.size() != kSourceColumns) source.fail("8 columns are expected");
    Material& material = materials.emplace_back();
    material.name = cells[kName];
    material.source = cells[kSource];
    material.kind = cells[kKind];
  }
  CsvReader row(embedded_materials_csv(), "materials.csv (built in)");
  row.next();  // names
  while (row.next()) {
    if (row.cells().size() != kIndexColumns) row.fail("4 columns are expected");
    const auto material = std::ranges::find(materials, row.cells()[kIndexName], &Material::name);
    if (material == materials.end()) row.fail("the material has no source");
    const double wavelength_um = row.number(kWavelength, "wavelength_um");
    append_row(material->n, wavelength_um, {"n", row.number(kN, "n"), kNRange}, row.where());
    append_row(material->k, wavelength_um, {"k", row.number(kK, "k"), kKRange}, row.where());
  }
  return materials;
}

/// True if a name contains `words`, with no letter or digit before or after them. Case does not matter.
bool has_words(const std::string& name, std::string_view words) {
  const std::string known = lower_case(name);
  const std::string wanted = lower_case(words);
  const auto is_inside_word = [&](std::size_t i) {
    return i < known.size() && std::isalnum(static_cast<unsigned char>(known[i])) != 0;
  };
  for (std::size_t at = known.find(wanted); at != std::string::npos; at = known.find(wanted, at + 1)) {
    if ((at == 0 || !is_inside_word(at - 1)) && !is_inside_word(at + wanted.size())) return !wanted.empty();
  }
  return false;
}

std::vector<const Material*> materials_with(std::string_view words) {
  std::vector<const Material*> found;
  for (const Material& material : built_in_materials()) {
    if (has_words(material.name, words)) found.push_back(&material);
  }
  return found;
}

/// The materials whose names share a word with `name`, begin like it, or are misspelt in it.
std::vector<std::string> similar_names(std::string_view name) {
  std::vector<std::string> similar;
  const auto add = [&](const std::string& found) {
    if (std::ranges::find(similar, found) == similar.end()) similar.push_back(found);
  };
  const auto add_with = [&](std::string_view words) {
    for (const Material* material : materials_with(words)) add(material->name);
  };
  add_with(name);
  for (const Material& material : built_in_materials()) {
    if (!name.empty() && lower_case(material.name).starts_with(lower_case(name))) add(material.name);
  }
  if (!similar.empty()) return similar;
  for (const std::string_view word : split(name, ' ')) add_with(trim(word));
  if (!similar.empty() || name.empty()) return similar;
  std::vector<std::string> words;
  for (const Material& material : built_in_materials()) {
    words.push_back(material.name);
    for (const std::string_view word : split(material.name, ' ')) words.emplace_back(word);
  }
  if (const std::optional<std::string> near = near_name(name, words)) add_with(*near);
  return similar;
}

}  // namespace

const std::vector<Material>& built_in_materials() {
  static const std::vector<Material> materials = read_built_in_materials();
  return materials;
}

const Material* match_material(std::string_view name) {
  const std::string wanted = lower_case(trim(name));
  std::vector<const Material*> beginning;
  for (const Material& material : built_in_materials()) {
    const std::string known = lower_case(material.name);
    if (known == wanted) return &material;
    if (known.starts_with(wanted + ' ')) beginning.push_back(&material);
  }
  if (beginning.empty()) beginning = materials_with(wanted);
  return beginning.size() == 1 ? beginning.front() : nullptr;
}

Material find_material(std::string_view name, const Spectrum& spectrum, const std::string& prefix) {
  return fit_to_spectrum(named_material(name, prefix), spectrum, prefix);
}

const Material& named_material(std::string_view name, const std::string& prefix) {
  if (const Material* material = match_material(name)) return *material;
  const std::vector<std::string> similar = similar_names(trim(name));
  if (const std::size_t count = materials_with(trim(name)).size(); count > 1) {
    throw InputError(fmt::format("{}names {} materials: {}", prefix, count, join(similar)));
  }
  if (similar.empty()) {
    throw InputError(
        fmt::format("{}is not one of the {} built-in materials, which dolp materials lists; give its n and "
                    "k as numbers, or as a file by material_file",
                    prefix, built_in_materials().size()));
  }
  throw InputError(fmt::format("{}unknown material; the nearest of the {} known: {}", prefix,
                               built_in_materials().size(), join(similar)));
}

OpticalConstants Material::at(double wavelength_um) const {
  if (is_constant()) return constant;
  return {n.at(wavelength_um), k.wavelength_um.empty() ? constant.k : k.at(wavelength_um)};
}

bool Surface::has_constant_optics() const {
  return coating.empty() && (reflectance ? reflectance->measured.size() == 1 : material.is_constant());
}

FacetOptics Surface::optics_at(double wavelength_um) const {
  FacetOptics optics;
  if (reflectance) {
    optics.measured = reflectance->at(wavelength_um);
    return optics;
  }
  optics.index = material.at(wavelength_um);
  for (const Layer& layer : coating) {
    const Film& film =
        optics.films.emplace_back(Film{layer.material.at(wavelength_um), layer.thickness_um / wavelength_um,
                                       layer.thickness_spread_um / wavelength_um});
    if (!is_too_wide(film)) continue;
    throw InputError(
        fmt::format("surface.coating.{}.thickness_spread_um = {:g}: must be at most {:g}, a fifth of thickness_um, for "
                    "a film of so "
                    "many wavelengths",
                    optics.films.size(), layer.thickness_spread_um, 0.2 * layer.thickness_um));
  }
  return optics;
}

std::vector<double> Surface::optics_rows_um() const {
  if (reflectance) return reflectance->wavelength_um;
  std::vector<double> rows;
  const auto add = [&](const Material& used) {
    const Material& all = used.tabulated ? *used.tabulated : used;
    for (const SpectralTable* table : {&all.n, &all.k})
      rows.insert(rows.end(), table->wavelength_um.begin(), table->wavelength_um.end());
  };
  add(material);
  for (const Layer& layer : coating) add(layer.material);
  return rows;
}

Spectrum known_range(const Material& material) {
  const std::vector<double>& n_um = material.n.wavelength_um;
  const std::vector<double>& k_um = material.k.wavelength_um.empty() ? n_um : material.k.wavelength_um;
  return {std::max(n_um.front(), k_um.front()), std::min(n_um.back(), k_um.back())};
}

void check_covers(const Material& material, const Spectrum& spectrum, const std::string& prefix) {
  const Spectrum known = known_range(material);
  if (spectrum.min_um < known.min_um || known.max_um < spectrum.max_um) {
    throw InputError(fmt::format("{}n and k of \"{}\" are known at {}, and the spectrum is {}", prefix, material.name,
                                 wavelength_text(known.min_um, known.max_um),
                                 wavelength_text(spectrum.min_um, spectrum.max_um)));
  }
  for (const double unknown_um : material.unknown_um) {
    if (unknown_um < spectrum.min_um || spectrum.max_um < unknown_um) continue;
    throw InputError(fmt::format("{}\"{}\" has NaN at {} um; delete this row to interpolate across it", prefix,
                                 material.name, unknown_um));
  }
}

void check_formula(const Material& material, const Spectrum& spectrum, const std::string& prefix) {
  if (material.n.formula.number == 0) return;
  const int steps = spectrum.is_band() ? kFormulaSteps : 1;
  for (int i = 0; i <= steps; ++i) {
    const double wavelength_um = std::lerp(spectrum.min_um, spectrum.max_um, static_cast<double>(i) / steps);
    const double n = material.n.at(wavelength_um);
    if (kNRange.contains(n)) continue;
    throw InputError(fmt::format("{}n = {} of \"{}\" at {} um: the formula has a pole there; n must be in {}", prefix,
                                 std::isnan(n) ? std::abs(n) : n, material.name, wavelength_um, kNRange.text()));
  }
}

Material fit_to_spectrum(const Material& material, const Spectrum& spectrum, const std::string& prefix) {
  check_covers(material, spectrum, prefix);
  check_formula(material, spectrum, prefix);
  if (spectrum.is_band()) return material;
  return {.name = material.name,
          .source = material.source,
          .constant = material.at(spectrum.min_um),
          .tabulated = std::make_shared<const Material>(material)};
}

}  // namespace dolp
