#include "scene/reflectance_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <span>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostRows = 100'000;
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
    if (rows.size() == kMostRows) row.fail(fmt::format("too many rows; at most {}", kMostRows));
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
