#include "scene/points.hpp"

#include <fmt/format.h>

#include <string_view>

#include "base/error.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

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
  return rules;
}

std::vector<std::string> names_of(const std::vector<ColumnRule>& rules) {
  std::vector<std::string> names;
  for (const ColumnRule& rule : rules) names.emplace_back(rule.name);
  return names;
}

const ColumnRule& find_rule(const std::vector<ColumnRule>& rules, std::string_view name, const std::string& where) {
  for (const ColumnRule& rule : rules) {
    if (rule.name == name) return rule;
  }
  const std::vector<std::string> names = names_of(rules);
  throw InputError(fmt::format("{}column \"{}\" is unknown; the nearest known is {}, allowed are {}", where,
                               one_line(name), nearest_name(name, names), join(names)));
}

/// The rules of the file's columns in the file's order; makes those columns present in `points`.
std::vector<ColumnRule> parse_header(std::string_view line, const std::vector<ColumnRule>& rules, Points& points,
                                     const std::string& where) {
  std::vector<ColumnRule> columns;
  for (const std::string_view cell : split(line, ',')) {
    const ColumnRule& rule = find_rule(rules, trim(cell), where);
    if (points.*rule.column) throw InputError(fmt::format("{}column \"{}\" appears twice", where, rule.name));
    (points.*rule.column).emplace();
    columns.push_back(rule);
    points.header += (points.header.empty() ? "" : ",") + std::string(rule.name);
  }
  for (const ColumnRule& rule : rules) {
    if (rule.is_required && !(points.*rule.column)) {
      throw InputError(fmt::format("{}column \"{}\" is missing, a number in {}", where, rule.name, rule.range.text()));
    }
  }
  return columns;
}

void parse_row(std::string_view line, const std::vector<ColumnRule>& columns, Points& points,
               const std::string& where) {
  const std::vector<std::string_view> cells = split(line, ',');
  std::string row;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnRule& rule = columns[i];
    const std::string_view cell = i < cells.size() ? trim(cells[i]) : std::string_view{};
    if (cell.empty()) {
      throw InputError(fmt::format("{}{}: the value is missing, a number in {}", where, rule.name, rule.range.text()));
    }
    const std::optional<double> value = parse_number(cell);
    if (!value || !rule.range.contains(*value)) {
      throw InputError(fmt::format("{}{} = {}: {}, a number in {}", where, rule.name, one_line(cell),
                                   value ? "out of range" : "not a number", rule.range.text()));
    }
    (points.*rule.column)->push_back(*value);
    if (i > 0) row += ',';
    row += cell;
  }
  if (cells.size() > columns.size()) {
    throw InputError(fmt::format("{}{}: one value too many after column {}; the header has {}", where,
                                 one_line(trim(cells[columns.size()])), columns.back().name, columns.size()));
  }
  points.rows.push_back(std::move(row));
}

}  // namespace

Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind) {
  const std::string name = input_name(path_name);
  const std::vector<ColumnRule> rules = column_rules(kind);
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.empty()) {
    throw InputError(
        fmt::format("{}:1: the file is empty; a line of column names is expected: {}", name, join(names_of(rules))));
  }
  Points points;
  points.name = name;
  const std::vector<ColumnRule> columns = parse_header(lines[0], rules, points, name + ":1: ");
  points.rows.reserve(lines.size() - 1);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    parse_row(lines[i], columns, points, fmt::format("{}:{}: ", name, points.line(i - 1)));
  }
  return points;
}

Points read_points(const std::string& path, PointsKind kind) {
  return parse_points(read_text(path, input_name(path) + ": "), path, kind);
}

}  // namespace dolp
