#include "scene/spectral_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

SpectralTable parse_irradiance(std::string_view text, const std::string& name) {
  SpectralTable table;
  bool may_be_header = true;
  for (CsvReader row(text, name); row.next();) {
    const std::vector<std::string_view>& cells = row.cells();
    if (cells.size() != 2) {
      row.fail(fmt::format("{} columns; 2 are expected, wavelength in um and irradiance in W m-2 um-1", cells.size()));
    }
    const bool is_header = may_be_header && !parse_number(cells[0]) && !parse_number(cells[1]);
    may_be_header = false;
    if (is_header) continue;
    const double wavelength_um = row.number(0, "wavelength_um");
    const double irradiance = row.number(1, "irradiance");
    append_row(table, wavelength_um, {"irradiance", irradiance, kNonNegativeRange}, row.where());
  }
  if (table.value.empty()) throw InputError(name + ":1: no rows; two columns of numbers are expected");
  return table;
}

bool covers(const SpectralTable& table, const Spectrum& spectrum) {
  return table.wavelength_um.front() <= spectrum.min_um && spectrum.max_um <= table.wavelength_um.back();
}

}  // namespace

double SpectralTable::at(double asked_um) const {
  const double clamped_um = std::clamp(asked_um, wavelength_um.front(), wavelength_um.back());
  if (formula.number != 0) return formula.at(clamped_um);
  const auto above = std::upper_bound(wavelength_um.begin(), wavelength_um.end(), clamped_um);
  if (above == wavelength_um.end()) return value.back();
  const auto i = static_cast<std::size_t>(above - wavelength_um.begin());
  const double from_um = wavelength_um[i - 1];
  const double to_um = wavelength_um[i];
  if (interpolation == Interpolation::kLinear) {
    return std::lerp(value[i - 1], value[i], (clamped_um - from_um) / (to_um - from_um));
  }
  const double weight = std::log(clamped_um / from_um) / std::log(to_um / from_um);
  return value[i - 1] * std::pow(value[i] / value[i - 1], weight);
}

SpectralTable sun_irradiance() {
  SpectralTable table = parse_irradiance(embedded_sun_csv(), "sun.csv (built in)");
  table.interpolation = SpectralTable::Interpolation::kLogLog;
  return table;
}

SpectralTable read_irradiance_file(const std::string& path, const std::string& prefix) {
  return parse_irradiance(read_named_file(path, prefix), path);
}

void append_row(SpectralTable& table, double wavelength_um, const NamedValue& value, const std::string& where) {
  for (const NamedValue& number : {NamedValue{"wavelength_um", wavelength_um, kWavelengthUmRange}, value}) {
    if (number.range.contains(number.value)) continue;
    throw InputError(fmt::format("{}{} = {}: must be in {}", where, number.name, number.value, number.range.text()));
  }
  if (!table.wavelength_um.empty() && wavelength_um <= table.wavelength_um.back()) {
    throw InputError(fmt::format("{}wavelength_um = {}: must be greater than {}, the one before", where, wavelength_um,
                                 table.wavelength_um.back()));
  }
  table.wavelength_um.push_back(wavelength_um);
  table.value.push_back(value.value);
}

void check_covers(const SpectralTable& table, const Spectrum& spectrum, const std::string& prefix) {
  if (covers(table, spectrum)) return;
  const std::vector<double>& known_um = table.wavelength_um;
  throw InputError(fmt::format("{}known at {}, and the spectrum is {}", prefix,
                               wavelength_text(known_um.front(), known_um.back()),
                               wavelength_text(spectrum.min_um, spectrum.max_um)));
}

std::string wavelength_text(double min_um, double max_um) {
  return min_um == max_um ? fmt::format("{} um", min_um) : fmt::format("{} to {} um", min_um, max_um);
}

SceneModel at_wavelength(const SceneModel& scene, double wavelength_um) {
  SceneModel at{.surface = scene.surface,
                .emission = scene.emission,
                .source = std::nullopt,  // its table may be long
                .surroundings = scene.surroundings,
                .path = scene.path,
                .spectrum = {wavelength_um, wavelength_um},
                .geometry = scene.geometry,
                .accuracy = scene.accuracy};
  Material& material = at.surface.material;
  if (material.tabulated) {
    check_covers(*material.tabulated, at.spectrum, "surface.material: ");
    material.constant = material.tabulated->at(wavelength_um);
    material.tabulated.reset();
  }
  if (!scene.source) return at;
  const Source& source = *scene.source;
  at.source = {.kind = source.kind,
               .irradiance = source.irradiance,
               .relative_irradiance = source.relative_irradiance,
               .scale = source.scale};
  if (source.kind == Source::Kind::kTabulated) {
    check_covers(source.table, at.spectrum, "source: ");
    at.source->irradiance = source.table.at(wavelength_um);
    at.source->kind = Source::Kind::kFlat;
  }
  return at;
}

}  // namespace dolp
