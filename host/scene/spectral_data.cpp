#include "scene/spectral_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.hpp"
#include "scene/embedded_data.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

SpectralTable parse_irradiance(std::string_view text, const std::string& name) {
  SpectralTable table;
  bool may_be_header = true;
  const std::vector<std::string_view> lines = split_lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = trim(lines[i]);
    if (line.empty() || line.front() == '#') continue;
    const std::string where = fmt::format("{}:{}: ", name, i + 1);
    const std::vector<std::string_view> cells = split(line, ',');
    if (cells.size() != 2) {
      throw InputError(fmt::format("{}{}: {} columns; 2 are expected, wavelength in um and irradiance in W m-2 um-1",
                                   where, one_line(line), cells.size()));
    }
    const bool is_header = may_be_header && !parse_number(cells[0]) && !parse_number(cells[1]);
    may_be_header = false;
    if (is_header) continue;
    const double wavelength_um = parse_cell(cells[0], "wavelength_um", where);
    const double irradiance = parse_cell(cells[1], "irradiance", where);
    if (!kNonNegativeRange.contains(irradiance)) {
      throw InputError(fmt::format("{}irradiance = {}: must be in {}", where, irradiance, kNonNegativeRange.text()));
    }
    append_row(table, wavelength_um, irradiance, where);
  }
  if (table.value.empty()) throw InputError(name + ":1: no rows; two columns of numbers are expected");
  return table;
}

}  // namespace

double SpectralTable::at(double asked_um) const {
  const double clamped_um = std::clamp(asked_um, wavelength_um.front(), wavelength_um.back());
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
  return parse_irradiance(read_text(path, prefix), path);
}

void append_row(SpectralTable& table, double wavelength_um, double value, const std::string& where) {
  if (!kWavelengthUmRange.contains(wavelength_um)) {
    throw InputError(
        fmt::format("{}wavelength_um = {}: must be in {}", where, wavelength_um, kWavelengthUmRange.text()));
  }
  if (!table.wavelength_um.empty() && wavelength_um <= table.wavelength_um.back()) {
    throw InputError(fmt::format("{}wavelength_um = {}: must be greater than {}, the one before", where, wavelength_um,
                                 table.wavelength_um.back()));
  }
  table.wavelength_um.push_back(wavelength_um);
  table.value.push_back(value);
}

bool covers(const SpectralTable& table, const Spectrum& spectrum) {
  return table.wavelength_um.front() <= spectrum.min_um && spectrum.max_um <= table.wavelength_um.back();
}

std::string wavelength_text(double min_um, double max_um) {
  return min_um == max_um ? fmt::format("{} um", min_um) : fmt::format("{} to {} um", min_um, max_um);
}

double parse_cell(std::string_view cell, const std::string& column, const std::string& where) {
  if (const auto number = parse_number(cell)) return *number;
  throw InputError(fmt::format("{}{} = {}: not a number", where, column, one_line(trim(cell))));
}

}  // namespace dolp
