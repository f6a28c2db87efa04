#include "run/lookup_run.hpp"

#include <fmt/format.h>

#include <array>
#include <dolp/errors.hpp>
#include <optional>
#include <string>

#include "base/parallel_ranges.hpp"
#include "base/text.hpp"

namespace dolp {
namespace {

using OptionalColumn = std::optional<std::vector<double>>;

/// One coordinate of all points.
struct Coordinate {
  const char* name;
  Axis axis;
  const OptionalColumn& given;
  std::optional<double> of_scene;
};

std::string range_text(const LookupAxis& axis) {
  if (axis.size() == 1) return format_number(axis.min());
  return fmt::format("[{}, {}]", format_number(axis.min()), format_number(axis.max()));
}

/// The coordinate of each point: as given, or the only one that the table has, or that of its scene.
std::vector<double> values_of(const Coordinate& coordinate, const LookupAxis& axis, const Points& points) {
  if (coordinate.given) {
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (axis.contains((*coordinate.given)[row])) continue;
      throw InputError(fmt::format("{}: {} = {}: outside the table, which has {}", points.where(row), coordinate.name,
                                   format_number((*coordinate.given)[row]), range_text(axis)));
    }
    return *coordinate.given;
  }
  std::optional<double> value = coordinate.of_scene;
  if (axis.size() == 1) value = axis.min();
  if (!value || !axis.contains(*value)) {
    throw InputError(
        fmt::format("{}: column \"{}\" is missing, a number in {}", points.where(), coordinate.name, range_text(axis)));
  }
  return std::vector<double>(points.size(), *value);
}

/// All coordinates of all points.
std::vector<TableLookup::Point> coordinates(const TableLookup& lookup, const Scene& scene, const Points& points) {
  const Surface& surface = scene.surface;
  const std::optional<double> none;
  const std::array<Coordinate, kGridAxes.size()> all = {
      {{"wavelength_um", Axis::kWavelength, points.wavelength_um, scene.spectrum.min_um},
       {"n", Axis::kN, points.n, surface.material.constant.n},
       {"k", Axis::kK, points.k, surface.material.constant.k},
       {"theta_deg", Axis::kTheta, points.theta_deg, none},
       {"sigma", Axis::kSigma, points.sigma, surface.sigma},
       {"q", Axis::kQ, points.q, surface.q}}};
  std::vector<TableLookup::Point> result(points.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const LookupAxis* axis = lookup.axis(all[i].axis);
    if (axis == nullptr) continue;
    const std::vector<double> values = values_of(all[i], *axis, points);
    for (std::size_t row = 0; row < points.size(); ++row) result[row][i] = values[row];
  }
  return result;
}

/// Refuses another index or wavelength than the table's, where it has no axis of these.
void check_index(const TableLookup& lookup, const Scene& scene, const Points& points) {
  const Material& material = scene.surface.material;
  const auto check = [&](const char* name, Axis axis, const OptionalColumn& given, double own) {
    if (!given || lookup.axis(axis)) return;
    for (std::size_t row = 0; row < points.size(); ++row) {
      if ((material.is_constant() || axis == Axis::kWavelength) && (*given)[row] == own) continue;
      throw InputError(fmt::format("{}: {} = {}: the table is of {}; dolp eval computes other indices",
                                   points.where(row), name, format_number((*given)[row]),
                                   material.is_constant() || axis == Axis::kWavelength
                                       ? fmt::format("{} = {}", name, format_number(own))
                                       : "a material that depends on the wavelength"));
    }
  };
  check("n", Axis::kN, points.n, material.constant.n);
  check("k", Axis::kK, points.k, material.constant.k);
  check("wavelength_um", Axis::kWavelength, points.wavelength_um, scene.spectrum.min_um);
}

}  // namespace

std::vector<PointResult> lookup_points(const TableLookup& lookup, const Scene& scene, const Points& points,
                                       const Progress& progress) {
  check_index(lookup, scene, points);
  const std::vector<TableLookup::Point> at = coordinates(lookup, scene, points);
  std::vector<PointResult> results(points.size());
  parallel_for(
      results.size(), [&](std::size_t i) { results[i] = lookup.at(at[i]); }, progress);
  return results;
}

}  // namespace dolp
