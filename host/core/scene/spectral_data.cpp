#include "scene/spectral_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

SpectralTable parse_irradiance(std::string_view text, const std::string& name) {
  const std::vector<CsvColumn> known = {{"wavelength_um", kPositiveRange, true, "wl"},
                                        {"irradiance", kNonNegativeRange, true, "irradiance_W_m2_um", "W m-2 um-1"}};
  std::optional<CsvColumns> columns;
  std::vector<SpectralRow> rows;
  for (CsvReader row(text, name); row.next();) {
    const bool is_header = !columns && !row.has_numbers();
    if (!columns) columns = is_header ? CsvColumns(row, known) : CsvColumns(known);
    if (is_header) continue;
    rows.push_back(
        {columns->number(row, "wavelength_um").value(), columns->number(row, "irradiance").value(), row.line_number()});
  }
  SpectralTable table;
  append_rows(table, std::move(rows), {"irradiance", 0.0, kNonNegativeRange}, name);
  if (table.value.empty()) {
    throw InputError(
        fmt::format("{}:1: no rows; wavelength_um in {} and irradiance are expected", name, kWavelengthUmRange.text()));
  }
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
  if (!table.wavelength_um.empty() && wavelength_um == table.wavelength_um.back()) {
    throw InputError(fmt::format("{}wavelength_um = {}: has {} = {} and {}", where, wavelength_um, value.name,
                                 table.value.back(), value.value));
  }
  if (!table.wavelength_um.empty() && wavelength_um < table.wavelength_um.back()) {
    throw InputError(fmt::format("{}wavelength_um = {}: must be greater than {}, the one before", where, wavelength_um,
                                 table.wavelength_um.back()));
  }
  table.wavelength_um.push_back(wavelength_um);
  table.value.push_back(value.value);
}

void append_rows(SpectralTable& table, std::vector<SpectralRow> rows, const NamedValue& named,
                 const std::string& file) {
  std::erase_if(rows, [](const SpectralRow& row) { return !kWavelengthUmRange.contains(row.wavelength_um); });
  std::ranges::stable_sort(rows, {}, &SpectralRow::wavelength_um);
  for (const SpectralRow& row : rows) {
    const bool is_repeated =
        !table.value.empty() && row.wavelength_um == table.wavelength_um.back() && row.value == table.value.back();
    if (is_repeated) continue;
    append_row(table, row.wavelength_um, {named.name, row.value, named.range}, fmt::format("{}:{}: ", file, row.line));
  }
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
  const auto take_constant = [&](Material& material, const std::string& prefix) {
    if (!material.tabulated) return;
    check_covers(*material.tabulated, at.spectrum, prefix);
    material.constant = material.tabulated->at(wavelength_um);
    material.tabulated.reset();
  };
  take_constant(at.surface.material, "surface.material: ");
  for (std::size_t i = 0; i < at.surface.coating.size(); ++i)
    take_constant(at.surface.coating[i].material, fmt::format("surface.coating.{}: ", i + 1));
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

SceneModel with_variant(const SceneModel& scene, const SceneVariant& variant) {
  SceneModel own = scene;
  if (variant.material) own.surface.material = scene.materials->at(*variant.material);
  if (variant.band) own.spectrum = scene.bands.at(*variant.band);
  if (variant.wavelength_um) own = at_wavelength(own, *variant.wavelength_um);
  if (variant.temperature_K) own.emission->temperature_K = *variant.temperature_K;
  for (const FilmValue& film : variant.films) {
    Layer& layer = own.surface.coating.at(film.layer);
    if (film.part == FilmValue::Part::kN) layer.material.constant.n = film.value;
    if (film.part == FilmValue::Part::kK) layer.material.constant.k = film.value;
    if (film.part == FilmValue::Part::kThickness) layer.thickness_um = film.value;
  }
  return own;
}

}  // namespace dolp
