#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <dolp/fit.hpp>
#include <limits>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

constexpr NumberRange kFractionOfOneRange{-1.0, 1.0};
constexpr NumberRange kUncertaintyRange{0.0, std::numeric_limits<double>::infinity(), NumberRange::Ends::kOpenBelow};

struct ColumnRule {
  const char* name;
  NumberRange range;
  std::optional<Observable> observable = std::nullopt;
};

const std::array<ColumnRule, 8> kColumns = {{{"theta_deg", kZenithDegRange},
                                             {"theta_i_deg", kZenithDegRange},
                                             {"dolp", kFractionOfOneRange, Observable::kDolp},
                                             {"q_over_i", kFractionOfOneRange, Observable::kQOverI},
                                             {"emissivity_s", kFractionOfOneRange, Observable::kEmissivityS},
                                             {"emissivity_p", kFractionOfOneRange, Observable::kEmissivityP},
                                             {"uncertainty", kUncertaintyRange},
                                             {"wavelength_um", kWavelengthUmRange}}};

/// The columns of a file in its own order.
std::vector<ColumnRule> columns_of(const CsvReader& header) {
  std::vector<std::string> names;
  for (const ColumnRule& rule : kColumns) names.emplace_back(rule.name);
  std::vector<ColumnRule> columns;
  for (const std::string_view cell : header.cells()) {
    const auto rule = std::ranges::find(kColumns, cell, &ColumnRule::name);
    if (rule == kColumns.end()) {
      header.fail(fmt::format("column \"{}\" is unknown; the nearest known is {}, allowed are {}", one_line(cell),
                              nearest_name(cell, names), join(names)));
    }
    if (std::ranges::find(columns, cell, &ColumnRule::name) != columns.end()) {
      header.fail(fmt::format("column \"{}\" appears twice", rule->name));
    }
    columns.push_back(*rule);
  }
  return columns;
}

std::optional<std::size_t> position_of(const std::vector<ColumnRule>& columns, std::string_view name) {
  const auto found = std::ranges::find(columns, name, &ColumnRule::name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

/// Refuses columns that contradict each other or carry no information.
void check_columns(const CsvReader& header, const std::vector<ColumnRule>& columns) {
  const auto has = [&](const char* name) { return position_of(columns, name).has_value(); };
  if (has("theta_deg") == has("theta_i_deg")) {
    header.fail(has("theta_deg") ? "columns \"theta_deg\" and \"theta_i_deg\" are the same zenith; give one of them"
                                 : "column \"theta_deg\" is missing, a number in " + kZenithDegRange.text());
  }
  const int kinds = int{has("dolp")} + int{has("q_over_i")} + int{has("emissivity_s") || has("emissivity_p")};
  if (kinds != 1) {
    header.fail(fmt::format("{} measured quantities; a file has one of dolp, q_over_i, emissivity_s and emissivity_p",
                            kinds == 0 ? "no" : "several"));
  }
}

void add_row(MeasuredData& data, const CsvReader& row, const std::vector<ColumnRule>& columns) {
  if (row.cells().size() > columns.size()) {
    row.fail(fmt::format("{}: one value too many; the header has {}", one_line(row.cells()[columns.size()]),
                         columns.size()));
  }
  Measurement observation;
  const auto number = [&](const char* name) -> std::optional<double> {
    const std::optional<std::size_t> cell = position_of(columns, name);
    if (!cell) return std::nullopt;
    return row.number(*cell, name, &columns[*cell].range);
  };
  observation.theta_deg = *number(data.zenith_column.c_str());
  observation.wavelength_um = number("wavelength_um");
  observation.uncertainty = number("uncertainty");
  for (const ColumnRule& column : columns) {
    if (!column.observable) continue;
    observation.observable = *column.observable;
    observation.value = *number(column.name);
    data.measurements.push_back(observation);
  }
}

/// The position at which the keys of "FILE:KEY=VALUE,..." begin: behind the colon before the first dotted key of a
/// scene.
std::size_t keys_begin(const std::string& argument) {
  for (std::size_t colon = argument.find(':'); colon != std::string::npos; colon = argument.find(':', colon + 1)) {
    const std::string_view rest = std::string_view(argument).substr(colon + 1);
    const std::string_view key = rest.substr(0, rest.find('='));
    if (key.size() < rest.size() && key.find_first_of("/ :") == std::string_view::npos) return colon;
  }
  return std::string::npos;
}

/// The parts of "KEY=VALUE,KEY=VALUE"; a comma inside of brackets or quotes separates nothing.
std::vector<std::string> pieces_of(std::string_view text) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted && (c == '[' || c == '{')) ++depth;
    if (!is_quoted && (c == ']' || c == '}')) --depth;
    if (c == ',' && depth == 0 && !is_quoted) {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  return pieces;
}

}  // namespace

const char* name_of(Observable observable) {
  return std::ranges::find(kColumns, std::optional(observable), &ColumnRule::observable)->name;
}

MeasuredData MeasuredData::from_csv(const std::string& csv, const std::string& name, std::vector<Setting> settings) {
  MeasuredData data;
  data.name = input_name(name);
  data.settings = std::move(settings);
  CsvReader row(csv, data.name);
  if (!row.next()) row.fail("the file is empty; a line of column names is expected, as theta_deg,dolp,uncertainty");
  const std::vector<ColumnRule> columns = columns_of(row);
  check_columns(row, columns);
  data.zenith_column = position_of(columns, "theta_deg") ? "theta_deg" : "theta_i_deg";
  data.has_uncertainties = position_of(columns, "uncertainty").has_value();
  while (row.next()) add_row(data, row, columns);
  if (data.measurements.empty()) row.fail("no points; at least one row is expected below the column names");
  return data;
}

MeasuredData MeasuredData::read(const std::string& argument) {
  const std::size_t colon = keys_begin(argument);
  const std::string path = argument.substr(0, colon);
  if (path.empty()) throw InputError(fmt::format("data {}: must be FILE or FILE:KEY=VALUE,...", one_line(argument)));
  std::vector<Setting> settings;
  if (colon != std::string::npos) {
    settings = settings_from_text(pieces_of(std::string_view(argument).substr(colon + 1)), "data " + path + ':');
  }
  return from_csv(read_text(path, input_name(path) + ": "), path, std::move(settings));
}

}  // namespace dolp
