#include "scene/points.hpp"

#include <fmt/format.h>

#include <string_view>

#include "scene/csv.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostPointsBytes = 1U << 30U;

using Column = std::optional<std::vector<double>> Points::*;

/// A column that a file may have.
struct ColumnRule {
  const char* name;
  NumberRange range;
  Column column;
  bool is_required;
};

std::vector<ColumnRule> column_rules(PointsKind kind) {
  std::vector<ColumnRule> rules;
  if (kind == PointsKind::kDirections) {
    rules.push_back({"theta_deg", kZenithDegRange, &Points::theta_deg, false});
  } else {
    rules.push_back({"theta_i_deg", kZenithDegRange, &Points::theta_i_deg, true});
    rules.push_back({"theta_r_deg", kZenithDegRange, &Points::theta_r_deg, true});
    rules.push_back({"delta_phi_deg", kAzimuthDegRange, &Points::delta_phi_deg, true});
  }
  rules.push_back({"sigma", kSigmaRange, &Points::sigma, false});
  rules.push_back({"q", kQRange, &Points::q, false});
  rules.push_back({"n", kNRange, &Points::n, false});
  rules.push_back({"k", kKRange, &Points::k, false});
  if (kind == PointsKind::kDirections)
    rules.push_back({"wavelength_um", kWavelengthUmRange, &Points::wavelength_um, false});
  return rules;
}

std::vector<std::string> names_of(const std::vector<ColumnRule>& rules) {
  std::vector<std::string> names;
  for (const ColumnRule& rule : rules) names.emplace_back(rule.name);
  return names;
}

const ColumnRule& find_rule(const std::vector<ColumnRule>& rules, std::string_view name, const CsvReader& header) {
  for (const ColumnRule& rule : rules) {
    if (rule.name == name) return rule;
  }
  const std::vector<std::string> names = names_of(rules);
  header.fail(fmt::format("column \"{}\" is unknown; the nearest known is {}, allowed are {}", one_line(name),
                          nearest_name(name, names), join(names)));
}

/// The rules of the file's columns in the file's order; makes those columns present in `points`.
std::vector<ColumnRule> parse_header(const CsvReader& header, const std::vector<ColumnRule>& rules, Points& points) {
  std::vector<ColumnRule> columns;
  for (const std::string_view cell : header.cells()) {
    const ColumnRule& rule = find_rule(rules, cell, header);
    if (points.*rule.column) header.fail(fmt::format("column \"{}\" appears twice", rule.name));
    (points.*rule.column).emplace();
    columns.push_back(rule);
  }
  for (const ColumnRule& rule : rules) {
    if (rule.is_required) header.position(rule.name, rule.range);
  }
  points.header = fmt::format("{}", fmt::join(header.cells(), ","));
  return columns;
}

void parse_row(const CsvReader& row, const std::vector<ColumnRule>& columns, Points& points) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    (points.*columns[i].column)->push_back(row.number(i, columns[i].name, &columns[i].range));
  }
  if (row.cells().size() > columns.size()) {
    row.fail(fmt::format("{}: one value too many after column {}; the header has {}",
                         one_line(row.cells()[columns.size()]), columns.back().name, columns.size()));
  }
  points.rows.push_back(fmt::format("{}", fmt::join(row.cells(), ",")));
}

}  // namespace

Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind) {
  const std::vector<ColumnRule> rules = column_rules(kind);
  Points points;
  points.name = input_name(path_name);
  CsvReader row(text, points.name, {.has_comments = false});
  if (!row.next()) row.fail("the file is empty; a line of column names is expected: " + join(names_of(rules)));
  const std::vector<ColumnRule> columns = parse_header(row, rules, points);
  while (row.next()) parse_row(row, columns, points);
  return points;
}

Points read_points(const std::string& path, PointsKind kind) {
  return parse_points(read_text(path, input_name(path) + ": ", kMostPointsBytes), path, kind);
}

}  // namespace dolp
