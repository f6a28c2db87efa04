#include "run/surface_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>

#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

constexpr double kMostMaterials = 1e4;

enum Column : std::size_t { kNumber, kQuantity, kWavelength, kValue, kColumns };

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

std::string materials_text(const std::vector<const Material*>& materials, bool has_wavelength_axis) {
  if (materials.empty()) return {};
  std::string text = "number,quantity,wavelength_um,value\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& used = *materials[i];
    if (!used.name.empty()) text += fmt::format("{},name,,\"{}\"\n", i + 1, one_line(used.name));
    const Material& material = has_wavelength_axis && used.tabulated ? *used.tabulated : used;
    const auto add = [&](const char* quantity, const SpectralTable& table, double constant) {
      if (table.wavelength_um.empty()) text += fmt::format("{},{},,{}\n", i + 1, quantity, format_number(constant));
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

std::string coating_text(const Surface& surface, bool has_wavelength_axis) {
  std::vector<const Material*> films;
  for (const Layer& layer : surface.coating) films.push_back(&layer.material);
  return materials_text(films, has_wavelength_axis);
}

std::string axis_materials_text(const SceneModel& scene, bool has_wavelength_axis) {
  std::vector<const Material*> materials;
  for (std::size_t i = 0; scene.materials && i < scene.materials->size(); ++i)
    materials.push_back(&(*scene.materials)[i]);
  return materials_text(materials, has_wavelength_axis);
}

std::vector<std::optional<Material>> parse_materials(const std::string& text, const std::string& name) {
  std::vector<std::optional<Material>> materials;
  CsvReader row(text, name);
  row.next();  // names
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
    const double value = row.number(kValue, "value", quantity == "n" ? &kNRange : &kKRange);
    if (row.cells()[kWavelength].empty()) {
      (quantity == "n" ? material->constant.n : material->constant.k) = value;
    } else {
      const double wavelength_um = row.number(kWavelength, "wavelength_um");
      append_index(*material, wavelength_um, quantity == "n" ? std::optional(value) : std::nullopt,
                   quantity == "n" ? std::nullopt : std::optional(value), row.where());
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

}  // namespace dolp
