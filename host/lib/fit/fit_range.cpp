#include "fit/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

constexpr const char* kForm = "must be KEY=LOW:HIGH or KEY=LOW:HIGH:START";

/// The scene's numeric keys, except the accuracy of the model itself.
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
  throw InputError(fmt::format("{}: {} is no number of a scene that can vary; the nearest is {}", origin, one_line(key),
                               nearest_name(key, keys)));
}

}  // namespace

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
