#include "run/surface_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>

#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

enum Column : std::size_t { kLayer, kQuantity, kWavelength, kValue, kColumns };

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

std::string coating_text(const Surface& surface, bool has_wavelength_axis) {
  if (surface.coating.empty()) return {};
  std::string text = "layer,quantity,wavelength_um,value\n";
  for (std::size_t i = 0; i < surface.coating.size(); ++i) {
    const Material& used = surface.coating[i].material;
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

std::vector<std::optional<Material>> parse_coating(const std::string& text, const std::string& name) {
  std::vector<std::optional<Material>> layers;
  CsvReader row(text, name);
  row.next();  // names
  while (row.next()) {
    if (row.cells().size() != kColumns) row.fail("4 columns are expected");
    const double layer = row.number(kLayer, "layer");
    if (!(layer >= 1.0 && layer <= static_cast<double>(kMostLayers))) row.fail("no such layer");
    layers.resize(std::max(layers.size(), static_cast<std::size_t>(layer)));
    std::optional<Material>& material = layers[static_cast<std::size_t>(layer) - 1];
    if (!material) material.emplace();
    const std::string_view quantity = row.cells()[kQuantity];
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
  return layers;
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
