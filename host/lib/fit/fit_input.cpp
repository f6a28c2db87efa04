#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/fit.hpp>
#include <limits>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "fit/model.hpp"
#include "scene/csv_columns.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

constexpr std::array kObservables = {Observable::kDolp, Observable::kQOverI, Observable::kEmissivityS,
                                     Observable::kEmissivityP};
constexpr NumberRange kFractionOfOneRange{-1.0, 1.0};
constexpr NumberRange kUncertaintyRange{0.0, std::numeric_limits<double>::infinity(), NumberRange::Ends::kOpenBelow};
constexpr double kLikelyPercent = 0.9;  // a DOLP of at least this is probably in percent; no surface has so much

const std::vector<CsvColumn>& known_columns() {
  static const std::vector<CsvColumn> columns = {{"theta_deg", kZenithDegRange},
                                                 {"theta_i_deg", kZenithDegRange},
                                                 {to_name(Observable::kDolp), kFractionOfOneRange},
                                                 {to_name(Observable::kQOverI), kFractionOfOneRange},
                                                 {to_name(Observable::kEmissivityS), kFractionOfOneRange},
                                                 {to_name(Observable::kEmissivityP), kFractionOfOneRange},
                                                 {"uncertainty", kUncertaintyRange},
                                                 {"wavelength_um", kWavelengthUmRange}};
  return columns;
}

void check_columns(const CsvReader& header, const CsvColumns& columns) {
  if (columns.has("theta_deg") == columns.has("theta_i_deg")) {
    header.fail(columns.has("theta_deg")
                    ? "columns \"theta_deg\" and \"theta_i_deg\" are the same zenith; give one of them"
                    : "column \"theta_deg\" is missing, a number in " + kZenithDegRange.text());
  }
  const int kinds = int{columns.has("dolp")} + int{columns.has("q_over_i")} +
                    int{columns.has("emissivity_s") || columns.has("emissivity_p")};
  if (kinds != 1) {
    header.fail(fmt::format("{} measured quantities; a file has one of dolp, q_over_i, emissivity_s and emissivity_p",
                            kinds == 0 ? "no" : "several"));
  }
}

void add_row(MeasuredData& data, const CsvReader& row, const CsvColumns& columns) {
  Measurement observation;
  observation.theta_deg = columns.number(row, data.zenith_column).value();
  observation.wavelength_um = columns.number(row, "wavelength_um");
  observation.uncertainty = columns.number(row, "uncertainty");
  for (std::size_t cell = 0; cell < columns.cells().size(); ++cell) {
    if (!columns.cells()[cell]) continue;
    const std::string& name = known_columns()[*columns.cells()[cell]].name;
    const auto observable = std::ranges::find_if(kObservables, [&](Observable kind) { return name == to_name(kind); });
    if (observable == kObservables.end()) continue;
    if (*observable == Observable::kDolp && columns.number_at(row, cell) < 0.0) {
      row.fail(
          fmt::format("dolp = {}: must not be negative; a signed Q/I goes in a column q_over_i", row.cells()[cell]));
    }
    observation.observable = *observable;
    observation.value = columns.number_at(row, cell);
    data.measurements.push_back(observation);
  }
}

std::vector<std::string> remarks_on(const MeasuredData& data) {
  double highest_deg = 0.0, highest_dolp = 0.0, least_um = std::numeric_limits<double>::infinity();
  for (const Measurement& measurement : data.measurements) {
    highest_deg = std::max(highest_deg, measurement.theta_deg);
    const bool is_dolp = measurement.observable == Observable::kDolp || measurement.observable == Observable::kQOverI;
    if (is_dolp) highest_dolp = std::max(highest_dolp, std::abs(measurement.value));
    least_um = std::min(least_um, measurement.wavelength_um.value_or(0.0));
  }
  std::vector<std::string> remarks;
  if (highest_deg > 0.0 && highest_deg < kLikelyRadians) {
    remarks.push_back(
        fmt::format("{}: {} is at most {} degrees; is it in radians?", data.name, data.zenith_column, highest_deg));
  }
  if (highest_dolp >= kLikelyPercent) {
    remarks.push_back(fmt::format("{}: {} rises to {}; is it in percent? 1 is fully polarised", data.name,
                                  to_name(data.measurements.front().observable), highest_dolp));
  }
  if (least_um > kLikelyNanometres) {
    remarks.push_back(fmt::format("{}: wavelength_um is at least {}; is it in nanometres?", data.name, least_um));
  }
  return remarks;
}

/// Position of the colon before KEY in "FILE:KEY=VALUE". FILE may have colons too; KEY has no slash, space or colon.
std::size_t keys_begin(const std::string& argument) {
  for (std::size_t colon = argument.find(':'); colon != std::string::npos; colon = argument.find(':', colon + 1)) {
    const std::string_view rest = std::string_view(argument).substr(colon + 1);
    const std::string_view key = rest.substr(0, rest.find('='));
    if (key.size() < rest.size() && key.find_first_of("/ :") == std::string_view::npos) return colon;
  }
  return std::string::npos;
}

std::vector<std::string> split_settings(std::string_view text) {
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

constexpr const char* kForm = "must be KEY=LOW:HIGH or KEY=LOW:HIGH:START";

/// The keys that a fit may vary: all keys of numbers, except keys in [accuracy], which do not change the model.
std::vector<std::string> number_keys() {
  std::vector<std::string> keys;
  for (const Key& description : dolp::keys()) {
    const bool is_model = !description.key.starts_with("accuracy.");
    if (description.type == Key::Type::kNumber && is_model) keys.push_back(description.key);
  }
  return keys;
}

void check_key(const std::string& key, const std::string& origin) {
  const std::vector<std::string> keys = number_keys();
  if (std::ranges::find(keys, key) != keys.end()) return;
  const std::optional<KeyHint> meant = key_by_meaning(key);
  const bool can_vary = meant && std::ranges::find(keys, meant->key) != keys.end();
  throw InputError(fmt::format("{}: {} is no number of a scene that can vary; the nearest is {}", origin, one_line(key),
                               can_vary ? meant->text() : nearest_name(key, keys)));
}

}  // namespace

const char* to_name(Observable observable) {
  constexpr std::array<const char*, kObservables.size()> kNames = {"dolp", "q_over_i", "emissivity_s", "emissivity_p"};
  return kNames[static_cast<std::size_t>(observable)];
}

MeasuredData MeasuredData::from_csv(const std::string& csv, const std::string& name, std::vector<Setting> settings) {
  MeasuredData data;
  data.name = input_name(name);
  data.settings = std::move(settings);
  CsvReader row(csv, data.name, kDataFile);
  const CsvColumns columns = CsvColumns::read_names(row, known_columns());
  check_columns(row, columns);
  data.zenith_column = columns.has("theta_deg") ? "theta_deg" : "theta_i_deg";
  data.has_uncertainties = columns.has("uncertainty");
  while (row.next()) add_row(data, row, columns);
  if (data.measurements.empty()) row.fail("no points; at least one row is expected below the column names");
  data.remarks = remarks_on(data);
  return data;
}

MeasuredData MeasuredData::read(const std::string& argument) {
  const std::size_t colon = keys_begin(argument);
  const std::string path = argument.substr(0, colon);
  if (path.empty()) throw InputError(fmt::format("data {}: must be FILE or FILE:KEY=VALUE,...", one_line(argument)));
  std::vector<Setting> settings;
  if (colon != std::string::npos) {
    settings = settings_from_text(split_settings(std::string_view(argument).substr(colon + 1)), "data " + path + ':');
  }
  return from_csv(read_text(path, input_name(path) + ": "), path, std::move(settings));
}

const std::vector<std::string>& model_error_names() {
  static const std::vector<std::string> names = {"none", "bracket"};
  return names;
}

const std::vector<std::string>& loss_names() {
  static const std::vector<std::string> names = {"squares", "huber", "soft-l1", "cauchy", "tukey"};
  return names;
}

Comparison Comparison::from_text(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals + 1 == argument.size()) {
    throw InputError(fmt::format("compare {}: must be KEY=WORD,WORD,...", one_line(argument)));
  }
  Comparison comparison{std::string(trim(std::string_view(argument).substr(0, equals))), {}};
  for (const std::string_view word : split(std::string_view(argument).substr(equals + 1), ',')) {
    comparison.words.emplace_back(trim(word));
  }
  return comparison;
}

double FitRange::at(double coordinate) const {
  const double value = is_logarithmic() ? low * std::pow(high / low, coordinate) : low + coordinate * (high - low);
  return std::clamp(value, low, high);
}

double FitRange::coordinate(double value) const {
  const double coordinate =
      is_logarithmic() ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return std::clamp(coordinate, 0.0, 1.0);
}

double FitRange::slope(double value) const { return is_logarithmic() ? value * std::log(high / low) : high - low; }

FitRange FitRange::from_text(const std::string& argument) {
  const std::string origin = "vary " + one_line(argument);
  const std::size_t equals = argument.find('=');
  FitRange range;
  range.key = trim(std::string_view(argument).substr(0, equals));
  check_key(range.key, origin);
  if (equals == std::string::npos) throw InputError(fmt::format("{}: {}", origin, kForm));
  std::vector<double> numbers;
  for (const std::string_view piece : split(std::string_view(argument).substr(equals + 1), ':')) {
    const std::optional<double> number = parse_number(piece);
    if (!number) throw InputError(fmt::format("{}: \"{}\" is not a number; {}", origin, one_line(piece), kForm));
    numbers.push_back(*number);
  }
  if (numbers.size() < 2 || numbers.size() > 3) throw InputError(fmt::format("{}: {}", origin, kForm));
  range.low = numbers[0];
  range.high = numbers[1];
  if (numbers.size() == 3) range.start = numbers[2];
  fit::check_range(range, origin);
  return range;
}

void fit::check_range(const FitRange& range, const std::string& origin) {
  check_key(range.key, origin);
  const Key& description = *std::ranges::find(dolp::keys(), range.key, &Key::key);
  for (const double number : {range.low, range.high, range.start.value_or(range.low)}) {
    if (description.range.contains(number)) continue;
    throw InputError(fmt::format("{}: {} is out of range, {} in {}", origin, format_number(number), range.key,
                                 description.range.text()));
  }
  if (range.low >= range.high) throw InputError(origin + ": LOW must be below HIGH");
  if (range.start && (*range.start < range.low || *range.start > range.high)) {
    throw InputError(origin + ": START must lie in LOW:HIGH");
  }
}

}  // namespace dolp
