#include "fit/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::fit {
namespace {

/// The scene's keys that are numbers, but for the accuracy of the model itself.
std::vector<std::string> number_keys() {
  std::vector<std::string> keys;
  for (const KeyDescription& description : scene_keys()) {
    const bool is_model = !description.key.starts_with("accuracy.");
    if (description.type == KeyDescription::Type::kNumber && is_model) keys.push_back(description.key);
  }
  return keys;
}

}  // namespace

double Parameter::at(double coordinate) const {
  const double value = is_logarithmic() ? low * std::pow(high / low, coordinate) : low + coordinate * (high - low);
  return std::clamp(value, low, high);
}

double Parameter::coordinate(double value) const {
  const double coordinate =
      is_logarithmic() ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return std::clamp(coordinate, 0.0, 1.0);
}

double Parameter::slope(double value) const { return is_logarithmic() ? value * std::log(high / low) : high - low; }

Parameter parse_parameter(const std::string& argument) {
  const auto fail = [&](const std::string& what) { throw InputError("--vary " + one_line(argument) + ": " + what); };
  const std::size_t equals = argument.find('=');
  Parameter parameter;
  parameter.key = trim(std::string_view(argument).substr(0, equals));
  const std::vector<std::string> keys = number_keys();
  if (std::ranges::find(keys, parameter.key) == keys.end()) {
    fail(fmt::format("{} is no number of a scene that can vary; the nearest is {}", one_line(parameter.key),
                     nearest_name(parameter.key, keys)));
  }
  if (equals == std::string::npos) fail("must be KEY=LOW:HIGH or KEY=LOW:HIGH:START");
  const KeyDescription& description = *std::ranges::find(scene_keys(), parameter.key, &KeyDescription::key);
  std::vector<double> numbers;
  for (const std::string_view piece : split(std::string_view(argument).substr(equals + 1), ':')) {
    const std::optional<double> number = parse_number(piece);
    if (!number)
      fail(fmt::format("\"{}\" is not a number; must be KEY=LOW:HIGH or KEY=LOW:HIGH:START", one_line(piece)));
    if (!description.range.contains(*number)) {
      fail(fmt::format("{} is out of range, {} in {}", one_line(piece), parameter.key, description.range.text()));
    }
    numbers.push_back(*number);
  }
  if (numbers.size() < 2 || numbers.size() > 3) fail("must be KEY=LOW:HIGH or KEY=LOW:HIGH:START");
  parameter.low = numbers[0];
  parameter.high = numbers[1];
  if (parameter.low >= parameter.high) fail("LOW must be below HIGH");
  if (numbers.size() == 3) {
    parameter.start = numbers[2];
    if (numbers[2] < parameter.low || numbers[2] > parameter.high) fail("START must lie in LOW:HIGH");
  }
  return parameter;
}

}  // namespace dolp::fit
