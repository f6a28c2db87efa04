#include "scene/spectral_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <optional>
#include <utility>

#include <span>
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

constexpr std::size_t kMostReflectanceRows = 100'000;
constexpr double kLargestSplitAtNormal = 0.01;

struct ReflectanceRow {
  double wavelength_um;  ///< 0 in a file without this column
  double beta_deg;
  double r_s;
  double r_p;
  std::size_t line;
};

std::vector<ReflectanceRow> read_rows(CsvReader& row) {
  const CsvColumns columns = CsvColumns::first_of(row, {{"beta_deg", kZenithDegRange, true},
                                                        {"r_s", kFractionRange, true},
                                                        {"r_p", kFractionRange, true},
                                                        {"wavelength_um", kWavelengthUmRange}});
  std::vector<ReflectanceRow> rows;
  while (row.next()) {
    if (rows.size() == kMostReflectanceRows) row.fail(fmt::format("too many rows; at most {}", kMostReflectanceRows));
    rows.push_back({columns.number(row, "wavelength_um").value_or(0.0), columns.number(row, "beta_deg").value(),
                    columns.number(row, "r_s").value(), columns.number(row, "r_p").value(), row.line_number()});
  }
  if (rows.empty()) row.fail("no rows; beta_deg from 0 to 90 is expected");
  std::ranges::stable_sort(rows, [](const ReflectanceRow& a, const ReflectanceRow& b) {
    return std::pair(a.wavelength_um, a.beta_deg) < std::pair(b.wavelength_um, b.beta_deg);
  });
  return rows;
}

/// The reflectances of rows of one wavelength.
MeasuredReflectance measured_in(std::span<const ReflectanceRow> rows, const std::vector<double>& expected_deg,
                                const std::string& path) {
  const auto fail = [&](const ReflectanceRow& row, const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", path, row.line, what));
  };
  if (rows.front().beta_deg != 0.0) fail(rows.front(), "beta_deg must be 0 in one row, and 90 in another");
  if (rows.back().beta_deg != 90.0) fail(rows.back(), "beta_deg must be 90 in one row");
  MeasuredReflectance measured;
  for (const ReflectanceRow& row : rows) {
    if (!measured.beta_deg.empty() && row.beta_deg == measured.beta_deg.back())
      fail(row, fmt::format("beta_deg = {} is there twice", row.beta_deg));
    measured.beta_deg.push_back(row.beta_deg);
    measured.r_s.push_back(row.r_s);
    measured.r_p.push_back(row.r_p);
  }
  if (!expected_deg.empty() && measured.beta_deg != expected_deg)
    fail(rows.front(), "each wavelength must have the same beta_deg");
  if (std::abs(measured.r_s.front() - measured.r_p.front()) > kLargestSplitAtNormal)
    fail(rows.front(),
         fmt::format("r_s = {} and r_p = {} must agree at beta_deg = 0", measured.r_s.front(), measured.r_p.front()));
  measured.r_s.front() = measured.r_p.front() = 0.5 * (measured.r_s.front() + measured.r_p.front());
  return measured;
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

void set_films(Surface& surface, const std::vector<FilmValue>& films) {
  for (const FilmValue& film : films) {
    Layer& layer = surface.coating.at(film.layer);
    if (film.part == FilmValue::Part::kN) layer.material.constant.n = film.value;
    if (film.part == FilmValue::Part::kK) layer.material.constant.k = film.value;
    if (film.part == FilmValue::Part::kThickness) layer.thickness_um = film.value;
  }
}

SceneModel with_variant(const SceneModel& scene, const SceneVariant& variant) {
  SceneModel own = scene;
  if (variant.material) own.surface.material = scene.materials->at(*variant.material);
  if (variant.band) own.spectrum = scene.bands.at(*variant.band);
  if (variant.wavelength_um) own = at_wavelength(own, *variant.wavelength_um);
  if (variant.temperature_K) own.emission->temperature_K = *variant.temperature_K;
  set_films(own.surface, variant.films);
  return own;
}

ReflectanceTable read_reflectance_file(const std::string& path, const std::string& prefix) {
  return parse_reflectances(read_text(path, prefix), path);
}

ReflectanceTable parse_reflectances(const std::string& text, const std::string& name) {
  CsvReader reader(text, name);
  const std::vector<ReflectanceRow> rows = read_rows(reader);
  ReflectanceTable table;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last =
        std::find_if(first, rows.end(), [&](const auto& row) { return row.wavelength_um != first->wavelength_um; });
    const std::vector<double> expected = table.measured.empty() ? std::vector<double>{} : table.measured[0]->beta_deg;
    table.measured.push_back(std::make_shared<const MeasuredReflectance>(measured_in({first, last}, expected, name)));
    if (first->wavelength_um > 0.0) table.wavelength_um.push_back(first->wavelength_um);
    first = last;
  }
  return table;
}

std::shared_ptr<const MeasuredReflectance> ReflectanceTable::at(double at_um) const {
  if (measured.size() == 1) return measured.front();
  const auto above = std::upper_bound(wavelength_um.begin() + 1, wavelength_um.end() - 1, at_um);
  const auto i = static_cast<std::size_t>(above - wavelength_um.begin()) - 1;
  const double share = std::clamp((at_um - wavelength_um[i]) / (wavelength_um[i + 1] - wavelength_um[i]), 0.0, 1.0);
  const MeasuredReflectance& before = *measured[i];
  const MeasuredReflectance& after = *measured[i + 1];
  auto mixed = std::make_shared<MeasuredReflectance>(before);
  for (std::size_t j = 0; j < mixed->beta_deg.size(); ++j) {
    mixed->r_s[j] = std::lerp(before.r_s[j], after.r_s[j], share);
    mixed->r_p[j] = std::lerp(before.r_p[j], after.r_p[j], share);
  }
  return mixed;
}

}  // namespace dolp
