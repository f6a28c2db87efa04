#include "scene/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <iterator>
#include <string_view>
#include <variant>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "model/slopes.hpp"
#include "scene/csv_columns.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostPointsBytes = 1U << 30U;

using FilmColumn = std::pair<std::size_t, FilmValue::Part>;

/// A column of points: values on an axis or of a film.
struct ColumnRule {
  std::string name;
  NumberRange range;
  std::variant<Axis, FilmColumn> column;
  bool is_required = false;
  bool is_wind = false;  ///< the column has winds; value() turns them into sigmas

  double value(double number) const { return is_wind ? sigma_of_wind(number) : number; }
  Points::Column& of(Points& points) const {
    const Axis* axis = std::get_if<Axis>(&column);
    return axis ? points[*axis] : points.films[std::get<FilmColumn>(column)];
  }
};

/// Adds a rule for each name in `names` that means n, k, thickness or spread of a film, such as "surface.coating.1.n".
void append_film_rules(std::vector<ColumnRule>& rules, const std::vector<std::string>& names) {
  static const std::map<std::string, FilmValue::Part> kParts = {{"n", FilmValue::Part::kN},
                                                                {"k", FilmValue::Part::kK},
                                                                {"thickness_um", FilmValue::Part::kThickness},
                                                                {"thickness_spread_um", FilmValue::Part::kSpread}};
  for (const std::string& name : names) {
    const SceneKey* const key = find_scene_key(name);
    if (!key || key->description.layer == 0 || std::ranges::find(rules, name, &ColumnRule::name) != rules.end())
      continue;
    const auto part = kParts.find(last_part(name));
    if (part == kParts.end()) continue;
    rules.push_back({name, key->description.range, FilmColumn{key->description.layer - 1, part->second}});
  }
}

/// Rules for all columns that points may have. Columns of films get rules only if they are in `names`.
std::vector<ColumnRule> column_rules(PointsKind kind, const std::vector<std::string>& names) {
  std::vector<ColumnRule> rules;
  const bool has_pairs = kind == PointsKind::kGeometries;
  if (has_pairs) {
    rules.push_back({"theta_i_deg", kZenithDegRange, Axis::kTheta, true});
    rules.push_back({"theta_r_deg", kZenithDegRange, Axis::kViewZenith, true});
    rules.push_back({"delta_phi_deg", kAzimuthDegRange, Axis::kRelativeAzimuth, true});
  }
  for (const Axis axis : kColumnOrder) {
    constexpr std::array kOfPairs = {Axis::kSigma, Axis::kQ,          Axis::kN,
                                     Axis::kK,     Axis::kSigmaCross, Axis::kSurfaceAzimuth};
    if (has_pairs && std::ranges::find(kOfPairs, axis) == kOfPairs.end()) continue;
    rules.push_back({describe(axis).column, describe(axis).range, axis});
  }
  rules.push_back({kWind.column, kWind.range, Axis::kSigma, false, true});
  append_film_rules(rules, names);
  return rules;
}

std::vector<CsvColumn> csv_columns(const std::vector<ColumnRule>& rules) {
  std::vector<CsvColumn> columns;
  for (const ColumnRule& rule : rules) columns.push_back({rule.name, rule.range, rule.is_required});
  return columns;
}

/// The words above the first row of numbers or names, and those of this row.
std::vector<std::string> header_words(std::string_view text) {
  std::vector<std::string> words;
  bool is_comment = true;
  while (is_comment && !text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trim(text.substr(0, end));
    is_comment = line.empty() || is_comment_line(line);
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t length = std::min(line.find_first_of(" ;,\t\r#!%=:\"", at), line.size()) - at;
      if (length > 0) words.emplace_back(line.substr(at, length));
      at += length + 1;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

std::vector<double>& add_column(Points& points, const ColumnRule& rule) {
  if (rule.of(points)) {
    const bool is_other = rule.is_wind != points.has_winds && std::holds_alternative<Axis>(rule.column) &&
                          std::get<Axis>(rule.column) == Axis::kSigma;
    throw InputError(is_other ? fmt::format("{}: columns \"sigma\" and \"wind_m_s\" cannot be combined", points.where())
                              : fmt::format("{}: column \"{}\" appears twice", points.where(), rule.name));
  }
  if (rule.is_wind) points.has_winds = true;
  return rule.of(points).emplace();
}

void check_required(Points& points, const std::vector<ColumnRule>& rules) {
  std::vector<std::string> missing;
  for (const ColumnRule& rule : rules) {
    if (rule.is_required && !rule.of(points))
      missing.push_back(fmt::format("column \"{}\" is missing, a number in {}", rule.name, rule.range.text()));
  }
  if (!missing.empty()) throw InputError(fmt::format("{}: {}", points.where(), fmt::join(missing, "; ")));
}

void add_columns(const CsvColumns& columns, const std::vector<ColumnRule>& rules, Points& points) {
  std::vector<std::string_view> kept;
  for (std::size_t cell = 0; cell < columns.cells().size(); ++cell) {
    const std::string& name = columns.names()[cell];
    if (const std::optional<std::size_t> column = columns.cells()[cell]) {
      add_column(points, rules[*column]);
      kept.push_back(name);
    } else {
      points.left_out.emplace_back(name);
    }
  }
  points.header = fmt::format("{}", fmt::join(kept, ","));
}

void parse_row(const CsvReader& row, const CsvColumns& columns, const std::vector<ColumnRule>& rules, Points& points) {
  columns.check_row(row);
  std::vector<std::string_view> kept;
  for (std::size_t cell = 0; cell < columns.cells().size(); ++cell) {
    if (!columns.cells()[cell]) continue;
    const ColumnRule& rule = rules[*columns.cells()[cell]];
    if (const Axis* const axis = std::get_if<Axis>(&rule.column); axis && describe(*axis).has_labels) {
      std::vector<std::string>& labels = points.labels[*axis];
      if (cell >= row.cells().size()) row.fail(rule.name + ": the value is missing");
      const auto known = std::ranges::find(labels, row.cells()[cell]);
      rule.of(points)->push_back(static_cast<double>(known - labels.begin()));
      if (known == labels.end()) labels.emplace_back(row.cells()[cell]);
    } else {
      rule.of(points)->push_back(rule.value(columns.number_at(row, cell)));
    }
    kept.push_back(row.cells()[cell]);
  }
  points.rows.push_back(fmt::format("{}", fmt::join(kept, ",")));
  points.row_lines.push_back(static_cast<std::uint32_t>(row.line_number()));
  ++points.count;
}

}  // namespace

std::string Points::where() const { return header_line > 0 ? fmt::format("{}:{}", name, header_line) : name; }

std::string Points::where(std::size_t row) const {
  return header_line > 0 ? fmt::format("{}:{}", name, row_lines[row]) : fmt::format("{}[{}]", name, row);
}

std::string Points::text_at(Axis axis, std::size_t row) const {
  const double value = (*coordinates[axis])[row];
  return labels[axis].empty() ? format_number(value)
                              : '"' + one_line(labels[axis][static_cast<std::size_t>(value)]) + '"';
}

std::vector<FilmValue> Points::films_at(std::size_t row) const {
  std::vector<FilmValue> values;
  for (const auto& [film, column] : films) values.push_back({film.first, film.second, (*column)[row]});
  return values;
}

std::vector<double> label_positions(const Points& points, Axis axis, const AxisLabels& known) {
  const std::vector<std::string>& labels = known[axis];
  const auto label_position = [&](double value) -> std::optional<double> {
    const std::vector<std::string>& given = points.labels[axis];
    if (given.empty())
      return value < static_cast<double>(labels.size()) ? std::optional(std::floor(value)) : std::nullopt;
    const std::string name = lower_case(given[static_cast<std::size_t>(value)]);
    std::vector<double> found;
    for (std::size_t i = 0; i < labels.size() && !name.empty(); ++i) {
      if (lower_case(labels[i]) == name) return static_cast<double>(i);
      if (lower_case(labels[i]).find(name) != std::string::npos) found.push_back(static_cast<double>(i));
    }
    return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
  };
  std::vector<double> positions;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const std::optional<double> position = label_position((*points[axis])[row]);
    if (!position) {
      const std::string column = describe(axis).column;
      throw InputError(fmt::format(
          "{}: {} = {}: {}", points.where(row), column, points.text_at(axis, row),
          labels.empty() ? "the scene has no grid." + column + " to choose from" : "must be one of " + join(labels)));
    }
    positions.push_back(*position);
  }
  return positions;
}

Points make_points(std::span<const Column> columns, std::size_t count, PointsKind kind) {
  std::vector<std::string> names;
  std::ranges::transform(columns, std::back_inserter(names),
                         [](const Column& column) { return std::string(column.name); });
  const std::vector<ColumnRule> rules = column_rules(kind, names);
  Points points;
  points.name = "points";
  points.count = count;
  for (const Column& column : columns) {
    const auto found = std::ranges::find(rules, column.name, &ColumnRule::name);
    if (found == rules.end())
      throw InputError(fmt::format("{}: {}", points.where(), unknown_column(column.name, csv_columns(rules))));
    const ColumnRule& rule = *found;
    const std::span<const double> values = column.values;
    if (values.size() != 1 && values.size() != count) {
      throw InputError(
          fmt::format("{}: column \"{}\" has {} values, not 1 or {}", points.where(), rule.name, values.size(), count));
    }
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (rule.range.contains(values[row])) continue;
      throw InputError(fmt::format("{}: {} = {}: out of range; must be a number in {}", points.where(row), rule.name,
                                   format_number(values[row]), rule.range.text()));
    }
    std::vector<double>& column_values = add_column(points, rule);
    values.size() == count ? column_values.assign(values.begin(), values.end())
                           : column_values.assign(count, values[0]);
    std::ranges::transform(column_values, column_values.begin(), [&](double number) { return rule.value(number); });
  }
  check_required(points, rules);
  return points;
}

Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind,
                    const std::vector<std::string>& results) {
  Points points;
  points.name = input_name(path_name);
  CsvReader row(text, points.name, {.separator = std::nullopt, .has_blank_lines = false});
  const std::vector<ColumnRule> rules = column_rules(kind, header_words(text));
  const CsvColumns columns = CsvColumns::read_names(row, csv_columns(rules), results);
  points.header_line = row.line_number();
  add_columns(columns, rules, points);
  while (row.next()) parse_row(row, columns, rules, points);
  return points;
}

Points read_points(const std::string& path, PointsKind kind, const std::vector<std::string>& results) {
  return parse_points(read_text(path, input_name(path) + ": ", kMostPointsBytes), path, kind, results);
}

}  // namespace dolp
