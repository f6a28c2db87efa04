#include "run/lookup_run.hpp"

#include <fmt/format.h>

#include <dolp/errors.hpp>
#include <optional>
#include <string>

#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "model/slopes.hpp"
#include "run/scene_run.hpp"

namespace dolp {
namespace {

/// The coordinate that points without a column of it have.
std::optional<double> value_of(const SceneValues& scene, Axis axis) {
  const Surface& surface = scene.surface;
  AxisArray<std::optional<double>> values;
  values[Axis::kWavelength] = scene.spectrum.min_um;
  values[Axis::kN] = surface.material.constant.n;
  values[Axis::kK] = surface.material.constant.k;
  values[Axis::kSigma] = surface.sigma;
  values[Axis::kQ] = surface.q;
  if (scene.emission) values[Axis::kTemperature] = scene.emission->temperature_K;
  return values[axis];
}

/// How messages name the values of an axis: sigma as winds where the points, or the table without them, have winds.
struct AxisWords {
  bool is_wind = false;
  const char* name = "";

  std::string value(double value) const {
    return is_wind ? fmt::format("{:.6g}", wind_of_sigma(value)) : format_number(value);
  }
  std::string range(const LookupAxis& axis) const {
    if (axis.size() == 1) return value(axis.min());
    return fmt::format("[{}, {}]", value(axis.min()), value(axis.max()));
  }
};

AxisWords words_of(Axis axis, const SceneValues& scene, const Points& points) {
  const bool has_winds = points[axis] ? points.has_winds : !scene.wind_m_s.empty();
  if (axis == Axis::kSigma && has_winds) return {true, kWind.column};
  return {false, description_of(axis).column};
}

/// The coordinate of each point: as given, or the only one that the table has, or that of its scene.
std::vector<double> values_of(Axis number, const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  const LookupAxis& axis = *lookup.axis(number);
  const AxisWords words = words_of(number, scene, points);
  if (description_of(number).has_labels && points[number]) return label_positions(points, number, lookup.labels());
  if (const auto& given = points[number]) {
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (axis.contains((*given)[row])) continue;
      throw InputError(fmt::format("{}: {} = {}: outside the table, which has {}", points.where(row), words.name,
                                   words.value((*given)[row]), words.range(axis)));
    }
    return *given;
  }
  const std::optional<double> value = axis.size() == 1 ? axis.min() : value_of(scene, number);
  if (!value || !axis.contains(*value)) {
    throw InputError(fmt::format("{}: column \"{}\" is missing, {}", points.where(), words.name,
                                 description_of(number).has_labels ? "one of " + join(lookup.labels()[number])
                                                                   : "a number in " + words.range(axis)));
  }
  return std::vector<double>(points.size(), *value);
}

/// All coordinates of all points.
std::vector<TableLookup::Point> coordinates(const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  std::vector<TableLookup::Point> result(points.size());
  for (const Axis axis : kAllAxes) {
    if (lookup.axis(axis) == nullptr) continue;
    const std::vector<double> values = values_of(axis, lookup, scene, points);
    for (std::size_t row = 0; row < points.size(); ++row) result[row][axis] = values[row];
  }
  return result;
}

/// Refuses numbers of films, which a table has no axis of.
void check_no_films(const Points& points) {
  if (points.films.empty()) return;
  throw InputError(fmt::format("{}: column of layer {}: the table is of one coating; dolp eval computes other ones",
                               points.where(), points.films.begin()->first.first + 1));
}

/// Refuses another index or wavelength than the table's, where it has no axis of these.
void check_index(const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  const Material& material = scene.surface.material;
  for (const Axis axis : {Axis::kMaterial, Axis::kBand, Axis::kN, Axis::kK, Axis::kWavelength, Axis::kTemperature}) {
    const auto& given = points[axis];
    if (!given || lookup.axis(axis)) continue;
    const char* const name = description_of(axis).column;
    const std::optional<double> own = value_of(scene, axis);
    const bool is_dispersive = !material.is_constant() && (axis == Axis::kN || axis == Axis::kK);
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (!is_dispersive && own && (*given)[row] == *own) continue;
      throw InputError(fmt::format("{}: {} = {}: the table {}; dolp eval computes other values", points.where(row),
                                   name, points.text_at(axis, row),
                                   is_dispersive ? "is of a material that depends on the wavelength"
                                   : own         ? fmt::format("is of {} = {}", name, format_number(*own))
                                                 : "has no such axis"));
    }
  }
}

}  // namespace

std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress) {
  check_shapes(scene, points);
  check_index(lookup, scene, points);
  check_no_films(points);
  const std::vector<TableLookup::Point> at = coordinates(lookup, scene, points);
  std::vector<PointResult> results(points.size());
  parallel_for(
      results.size(), [&](std::size_t i) { results[i] = lookup.at(at[i]); }, progress);
  return results;
}

}  // namespace dolp
