#include "table/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>

#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "model/scene_entry.hpp"

namespace dolp {

std::string spectral_data_of(const TableHead& head) {
  std::string text;
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = head.*described.curve;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      (text += described.name) += ',';
      append_number(text, curve.wavelength_um[i]);
      append_number(text += ',', curve.values[i]);
      text += '\n';
    }
  }
  return text;
}

void take_spectral_data(TableHead& head, const std::string& name) {
  const auto found = std::ranges::find(head.attributes, kSpectralData, &Attribute::name);
  if (found == head.attributes.end()) return;
  for (const TableCurve& described : kTableCurves) {
    Curve& curve = head.*described.curve;
    curve = {{}, {}, std::move(curve.used)};
  }
  const auto* text = std::get_if<std::string>(&found->value);
  const std::string rows = text ? *text : "a number";
  for (const std::string_view line : split_lines(rows)) {
    const std::vector<std::string_view> cells = split(line, ',');
    const auto described = std::ranges::find(kTableCurves, cells.front(), &TableCurve::name);
    const bool is_row = cells.size() == 3 && described != kTableCurves.end();
    const std::optional<double> wavelength_um = is_row ? parse_number(cells[1]) : std::nullopt;
    const std::optional<double> value = is_row ? parse_number(cells[2]) : std::nullopt;
    if (!wavelength_um || !value) {
      throw InputError(
          fmt::format("{}: attribute {}: \"{}\": must be index_n, index_k or irradiance, a wavelength and a "
                      "value",
                      name, kSpectralData, one_line(line)));
    }
    (head.*described->curve).wavelength_um.push_back(*wavelength_um);
    (head.*described->curve).values.push_back(*value);
  }
  head.attributes.erase(found);
}

std::string coordinates_of(const TableHead& head) {
  std::string names = head.wind_m_s.empty() ? "" : kWind.name;
  for (const TableCurve& described : kTableCurves) {
    if (!(head.*described.curve).used.empty()) (names += names.empty() ? "" : " ") += described.name;
  }
  return names;
}

ResultColumns columns_of(std::span<const PointResult> results, const Quantities& quantities) {
  constexpr std::size_t kEntriesAtOnce = 16384;
  ResultColumns columns;
  for (const Quantity quantity : quantities) columns[quantity].resize(results.size());
  columns.status.resize(results.size());
  parallel_ranges(results.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const Quantity quantity : quantities) columns[quantity][i] = results[i][quantity];
      columns.status[i] = results[i].status;
    }
  });
  return columns;
}

}  // namespace dolp
