#include "scene/spectral_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <optional>
#include <utility>

#include <span>
#include "base/text.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

/// Rows of a CSV with two columns, in the order of the file. A file without names has the columns in this order.
std::vector<SpectralRow> read_rows(std::string_view text, const std::string& name,
                                   const std::vector<CsvColumn>& known) {
  std::optional<CsvColumns> columns;
  std::vector<SpectralRow> rows;
  for (CsvReader row(text, name, kDataFile); row.next();) {
    if (!columns && !row.has_numbers()) {
      columns = CsvColumns::header_at(row, known);
      continue;
    }
    if (!columns) columns = CsvColumns::in_comments(row, known).value_or(CsvColumns(known));
    rows.push_back({columns->number(row, "wavelength_um").value(), columns->number(row, known.back().name).value(),
                    row.line_number()});
  }
  return rows;
}

constexpr double kPercent = 0.01;

std::vector<CsvColumn> diffuse_columns(const NumberRange& range) {
  return {{"wavelength_um", kWavelengthUmRange, true}, {"reflectance", range, true}};
}

/// True for a file of the ECOSTRESS spectral library. It begins with lines such as "Name: Concrete".
bool is_ecostress(std::string_view text) {
  const std::string_view first = trim(text.substr(0, text.find('\n')));
  return first.starts_with("Name:") && text.find("Y Units:") != std::string_view::npos;
}

bool is_pair_of_numbers(std::string_view line) {
  const std::vector<std::string_view> cells = split_cells(line, ' ');
  return cells.size() == 2 && parse_number(cells[0]) && parse_number(cells[1]);
}

/// Reads the lines "Key: value", which may go on in the next line, and the rows below in micrometres and percent.
std::vector<SpectralRow> read_ecostress(std::string_view text, const std::string& name) {
  const std::vector<std::string_view> lines = split_lines(text);
  std::size_t i = 0;
  for (; i < lines.size() && !is_pair_of_numbers(lines[i]); ++i) {
    const std::string line = lower_case(lines[i]);
    const auto check = [&](const char* key, const char* unit, const char* expected) {
      if (line.starts_with(key) && line.find(unit) == std::string::npos)
        throw InputError(fmt::format("{}:{}: {}: must be {}", name, i + 1, one_line(lines[i]), expected));
    };
    check("x units:", "micrometer", "Wavelength (micrometers)");
    check("y units:", "reflectance (percent", "Reflectance (percent)");
  }
  std::vector<SpectralRow> rows;
  if (i == lines.size()) return rows;
  const CsvColumns columns(diffuse_columns({0.0, 100.0}));
  const std::string_view body = text.substr(static_cast<std::size_t>(lines[i].data() - text.data()));
  for (CsvReader row(body, name, {.separator = ' ', .first_line = i + 1}); row.next();)
    rows.push_back({columns.number(row, "wavelength_um").value(), kPercent * columns.number(row, "reflectance").value(),
                    row.line_number()});
  return rows;
}

constexpr double kLargestSplitAtNormal = 0.01;

/// Refuses rows whose angles do not ascend from 0 to 90, or differ from the angles of `first`, the first wavelength.
void check_angles(std::span<const AngleRow> rows, std::span<const AngleRow> first, const std::string& angle,
                  const std::string& file) {
  const auto fail = [&](const AngleRow& row, const std::string& what) {
    throw InputError(fmt::format("{}:{}: {} = {}: {}", file, row.line, angle, row.angle_deg, what));
  };
  if (rows.front().angle_deg != 0.0) fail(rows.front(), "must be 0 in one row, and 90 in another");
  if (rows.back().angle_deg != 90.0) fail(rows.back(), "must be 90 in one row");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].angle_deg == rows[i - 1].angle_deg) fail(rows[i], fmt::format("is in line {} too", rows[i - 1].line));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].angle_deg == first[i].angle_deg) continue;
    fail(rows[i], fmt::format("each wavelength must have the same angles, and the first has {}", first[i].angle_deg));
  }
}

}  // namespace

double SpectralTable::at(double asked_um) const {
  const double at_um = std::clamp(asked_um, wavelength_um.front(), wavelength_um.back());
  if (formula.number != 0) return formula.at(at_um);
  if (at_um == wavelength_um.back()) return value.back();
  const auto [i, share] = between(wavelength_um, at_um);
  if (interpolation == Interpolation::kLinear) return std::lerp(value[i], value[i + 1], share);
  const double weight = std::log(at_um / wavelength_um[i]) / std::log(wavelength_um[i + 1] / wavelength_um[i]);
  return value[i] * std::pow(value[i + 1] / value[i], weight);
}

SpectralTable parse_response(std::string_view text, const std::string& name) {
  std::vector<SpectralRow> rows =
      read_rows(text, name, {{"wavelength_um", kWavelengthUmRange, true}, {"response", kResponseRange, true}});
  const auto fail = [&](std::size_t line, const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", name, line, what));
  };
  if (rows.size() < 2) fail(1, fmt::format("{} rows; a response has at least 2 rows", rows.size()));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool ascends = rows[i].wavelength_um > rows[i - 1].wavelength_um;
    const bool should_ascend = rows[1].wavelength_um > rows[0].wavelength_um;
    if (ascends != should_ascend || rows[i].wavelength_um == rows[i - 1].wavelength_um)
      fail(rows[i].line, fmt::format("wavelength_um = {:.6g} after {:.6g}: the rows must be in the order of their "
                                     "wavelengths, and each wavelength in one row",
                                     rows[i].wavelength_um, rows[i - 1].wavelength_um));
  }
  constexpr double kLeast = 1e-100;  // far smaller numbers lose their digits in products
  const double largest = std::ranges::max(rows, {}, &SpectralRow::value).value;
  if (largest < kLeast)
    fail(rows.front().line, fmt::format("response = {}{}: must be at least {} in one row", largest,
                                        largest == 0.0 ? " in all rows" : " in the largest row", kLeast));
  SpectralTable table;
  append_rows(table, std::move(rows), {"response", 0.0, kResponseRange}, name);
  return table;
}

SpectralTable parse_irradiance(std::string_view text, const std::string& name) {
  const std::vector<CsvColumn> known = {{"wavelength_um", kPositiveRange, true},
                                        {"irradiance", kNonNegativeRange, true, "irradiance_W_m2_um", "W m-2 um-1"}};
  SpectralTable table;
  append_rows(table, read_rows(text, name, known), {"irradiance", 0.0, kNonNegativeRange}, name);
  if (table.value.empty()) {
    throw InputError(
        fmt::format("{}:1: no rows; wavelength_um in {} and irradiance are expected", name, kWavelengthUmRange.text()));
  }
  return table;
}

SpectralTable parse_diffuse(std::string_view text, const std::string& name) {
  std::vector<SpectralRow> rows =
      is_ecostress(text) ? read_ecostress(text, name) : read_rows(text, name, diffuse_columns(kFractionRange));
  if (rows.empty()) throw InputError(fmt::format("{}:1: no rows; wavelength_um and reflectance are expected", name));
  SpectralTable table;
  append_rows(table, std::move(rows), {"reflectance", 0.0, kFractionRange}, name);
  return table;
}

std::string spectral_text(const SpectralTable* table, const char* value) {
  if (!table) return {};
  std::string text = fmt::format("wavelength_um,{}\n", value);
  for (std::size_t i = 0; i < table->value.size(); ++i)
    text += fmt::format("{},{}\n", format_number(table->wavelength_um[i]), format_number(table->value[i]));
  return text;
}

Spectrum response_spectrum(SpectralTable table, ResponsePer per) {
  const auto is_positive = [](double response) { return response > 0.0; };
  const auto first = std::ranges::find_if(table.value, is_positive) - table.value.begin();
  const auto after = std::find_if(table.value.rbegin(), table.value.rend(), is_positive).base() - table.value.begin();
  const double from_um = *(table.wavelength_um.begin() + std::max<std::ptrdiff_t>(first - 1, 0));
  const double to_um = *(table.wavelength_um.begin() + std::min<std::ptrdiff_t>(after, std::ssize(table.value) - 1));
  const auto largest = std::ranges::max_element(table.value) - table.value.begin();
  const double photon_um = per == ResponsePer::kPhoton ? *(table.wavelength_um.begin() + largest) : 0.0;
  return {from_um, to_um, std::make_shared<const SpectralTable>(std::move(table)), per, photon_um};
}

double Spectrum::weight(double wavelength_um) const {
  if (!response) return 1.0;
  return response->at(wavelength_um) * (photon_um > 0.0 ? wavelength_um / photon_um : 1.0);
}

const char* Spectrum::key() const { return response ? "spectrum.response_file" : "spectrum.band_um"; }

double largest_value(const SpectralTable& table, const Spectrum& spectrum) {
  double largest = std::max(table.at(spectrum.min_um), table.at(spectrum.max_um));
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    const double at_um = table.wavelength_um[i];
    if (at_um > spectrum.min_um && at_um < spectrum.max_um) largest = std::max(largest, table.value[i]);
  }
  return largest;
}

SpectralTable sun_irradiance() {
  SpectralTable table = parse_irradiance(embedded_sun_csv(), "sun.csv (built in)");
  table.interpolation = SpectralTable::Interpolation::kLogLog;
  return table;
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
  const std::vector<double>& known_um = table.wavelength_um;
  if (known_um.front() <= spectrum.min_um && spectrum.max_um <= known_um.back()) return;
  throw InputError(fmt::format("{}known at {}, and the spectrum is {}", prefix,
                               wavelength_text(known_um.front(), known_um.back()),
                               wavelength_text(spectrum.min_um, spectrum.max_um)));
}

std::string wavelength_text(double min_um, double max_um) {
  return min_um == max_um ? fmt::format("{} um", min_um) : fmt::format("{} to {} um", min_um, max_um);
}

SceneModel at_wavelength(const SceneModel& scene, double wavelength_um) {
  SceneModel at = scene;
  at.spectrum = {wavelength_um, wavelength_um};
  const auto take_constant = [&](Material& material, const std::string& prefix) {
    if (!material.tabulated) return;
    check_covers(*material.tabulated, at.spectrum, prefix);
    material.constant = material.tabulated->at(wavelength_um);
    material.tabulated.reset();
  };
  const auto take_value = [&](std::shared_ptr<const SpectralTable>& table, double& value, const char* prefix) {
    if (!table) return;
    check_covers(*table, at.spectrum, prefix);
    value = table->at(wavelength_um);
    table.reset();
  };
  take_constant(at.surface.material, "surface.material: ");
  take_value(at.surface.diffuse_table, at.surface.diffuse, "surface.diffuse_file: ");
  for (std::size_t i = 0; i < at.surface.coating.size(); ++i)
    take_constant(at.surface.coating[i].material, fmt::format("surface.coating.{}: ", i + 1));
  if (at.source) take_value(at.source->table, at.source->irradiance, "source: ");
  return at;
}

void set_films(Surface& surface, const std::vector<FilmValue>& films) {
  for (const FilmValue& film : films) {
    Layer& layer = surface.coating.at(film.layer);
    if (film.part == FilmValue::Part::kN) layer.material.constant.n = film.value;
    if (film.part == FilmValue::Part::kK) layer.material.constant.k = film.value;
    if (film.part == FilmValue::Part::kThickness) layer.thickness_um = film.value;
    if (film.part == FilmValue::Part::kSpread) layer.thickness_spread_um = film.value;
  }
}

BeamAngles beam_angles(const SceneModel& scene, const SceneEntry& entry) {
  return {entry.theta_deg, entry.view_zenith_deg.value_or(scene.geometry.view_zenith_deg),
          entry.relative_azimuth_deg.value_or(scene.geometry.relative_azimuth_deg)};
}

double moment_zenith_deg(const SceneModel& scene, const SceneEntry& entry) {
  return scene.geometry.mode == Mode::kBistatic ? beam_angles(scene, entry).theta_r_deg : entry.theta_deg;
}

std::vector<double> kinks_um(const SceneModel& scene) {
  std::vector<double> kinks = scene.surface.optics_rows_um();
  const auto add = [&](const std::vector<double>& rows_um) {
    kinks.insert(kinks.end(), rows_um.begin(), rows_um.end());
  };
  if (scene.source && scene.source->table) add(scene.source->table->wavelength_um);
  if (scene.surface.diffuse_table) add(scene.surface.diffuse_table->wavelength_um);
  if (scene.surroundings && scene.surroundings->profile) add(scene.surroundings->profile->breaks_um());
  std::ranges::sort(kinks);
  return kinks;
}

SceneModel with_variant(const SceneModel& scene, const SceneVariant& variant) {
  SceneModel changed = scene;
  if (variant.material) changed.surface.material = scene.materials->at(*variant.material);
  if (variant.band) changed.spectrum = scene.bands.at(*variant.band);
  if (variant.wavelength_um) changed = at_wavelength(changed, *variant.wavelength_um);
  if (variant.temperature_K) changed.emission->temperature_K = *variant.temperature_K;
  set_films(changed.surface, variant.films);
  return changed;
}

std::vector<AngleRow> read_angle_rows(CsvReader& row, const CsvColumns& columns, const std::string& angle,
                                      const std::vector<std::string>& values, const std::string& file) {
  std::vector<AngleRow> rows;
  while (row.next()) {
    AngleRow& read = rows.emplace_back();
    read.wavelength_um = columns.number(row, "wavelength_um").value_or(0.0);
    read.angle_deg = columns.number(row, angle).value();
    for (const std::string& name : values) read.values.push_back(columns.number(row, name).value());
    read.line = row.line_number();
  }
  if (rows.empty()) row.fail(fmt::format("no rows; {} from 0 to 90 is expected", angle));
  std::ranges::stable_sort(rows, {}, [](const AngleRow& r) { return std::pair(r.wavelength_um, r.angle_deg); });
  std::span<const AngleRow> first;
  for (auto begin = rows.cbegin(), end = begin; begin != rows.cend(); begin = end) {
    end = std::find_if(begin, rows.cend(), [&](const AngleRow& r) { return r.wavelength_um != begin->wavelength_um; });
    if (first.empty()) first = {begin, end};
    check_angles({begin, end}, first, angle, file);
  }
  return rows;
}

Between between(const std::vector<double>& list, double value) {
  if (list.size() < 2) return {};
  const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, value);
  const auto first = static_cast<std::size_t>(above - list.begin()) - 1;
  return {first, std::clamp((value - list[first]) / (list[first + 1] - list[first]), 0.0, 1.0)};
}

ReflectanceTable parse_reflectances(const std::string& text, const std::string& name) {
  CsvReader reader(text, name, kDataFile);
  const CsvColumns columns = CsvColumns::read_names(reader, {{"beta_deg", kZenithDegRange, true},
                                                             {"r_s", kFractionRange, true},
                                                             {"r_p", kFractionRange, true},
                                                             {"wavelength_um", kWavelengthUmRange}});
  ReflectanceTable table;
  std::vector<MeasuredReflectance> measured;
  for (const AngleRow& row : read_angle_rows(reader, columns, "beta_deg", {"r_s", "r_p"}, name)) {
    double r_s = row.values[0], r_p = row.values[1];
    if (row.angle_deg == 0.0) {
      if (std::abs(r_s - r_p) > kLargestSplitAtNormal) {
        throw InputError(
            fmt::format("{}:{}: r_s = {} and r_p = {} must agree at beta_deg = 0", name, row.line, r_s, r_p));
      }
      r_s = r_p = 0.5 * (r_s + r_p);
      measured.emplace_back();
      if (row.wavelength_um > 0.0) table.wavelength_um.push_back(row.wavelength_um);
    }
    measured.back().beta_deg.push_back(row.angle_deg);
    measured.back().r_s.push_back(r_s);
    measured.back().r_p.push_back(r_p);
  }
  for (MeasuredReflectance& reflectance : measured)
    table.measured.push_back(std::make_shared<const MeasuredReflectance>(std::move(reflectance)));
  return table;
}

std::shared_ptr<const MeasuredReflectance> ReflectanceTable::at(double at_um) const {
  if (measured.size() == 1) return measured.front();
  const auto [i, share] = between(wavelength_um, at_um);
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
