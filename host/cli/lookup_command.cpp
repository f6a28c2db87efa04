#include <fmt/format.h>

#include <array>
#include <chrono>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/interrupt.hpp"
#include "base/parallel_ranges.hpp"
#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "model/status.hpp"
#include "run/table_scene.hpp"
#include "scene/text.hpp"
#include "table/table_lookup.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {
namespace {

constexpr std::size_t kPointsAtOnce = 1024;  // of a thread

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
      throw InputError(fmt::format("{}:{}: {} = {}: outside the table, which has {}", points.name, points.line(row),
                                   coordinate.name, format_number((*coordinate.given)[row]), range_text(axis)));
    }
    return *coordinate.given;
  }
  std::optional<double> value = coordinate.of_scene;
  if (axis.size() == 1) value = axis.min();
  if (!value || !axis.contains(*value)) {
    throw InputError(
        fmt::format("{}:1: column \"{}\" is missing, a number in {}", points.name, coordinate.name, range_text(axis)));
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
      throw InputError(fmt::format("{}:{}: {} = {}: the table is of {}; dolp eval computes other indices", points.name,
                                   points.line(row), name, format_number((*given)[row]),
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

int run_lookup(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_is_no_input(options);
  const Table table = load_table(options.table_path);
  const Scene scene = table_scene(table, options.table_path);
  const TableLookup lookup(table, scene.accuracy.tolerance, options.table_path);
  const Points points = read_points(options.points_path, PointsKind::kDirections);
  check_index(lookup, scene, points);
  const std::vector<TableLookup::Point> at = coordinates(lookup, scene, points);
  check_writable(options.output_path);
  std::vector<PointResult> results(points.size());
  watch_for_interrupts();
  parallel_ranges(results.size(), kPointsAtOnce, [&](std::size_t first, std::size_t last) {
    if (interrupted()) throw Cancelled{};
    for (std::size_t i = first; i < last; ++i) results[i] = lookup.at(at[i]);
  });
  write_text_atomically(options.output_path, result_csv(points, results, lookup.extra_columns()));

  const std::size_t missed = count_status(results, kStatusToleranceMissed);
  const std::optional<double> worst = worst_of(results, &PointResult::error_estimate, kStatusNoDolpPromised);
  Report report;
  report.line("{}", key("table", options.table_path));
  report.row("points", "{}", key("points", results.size()));
  report.row("error", "{}, interpolation included; tolerance of the table {:g}",
             worst ? fmt::format("DOLP <= {:.2g} (absolute)", *worst) : "stated for no point",
             key("tolerance", scene.accuracy.tolerance));
  report.row("status 2", "{} of {} points: tolerance not met", key("tolerance_missed", missed), results.size());
  report.row("written", "{}", key("output", options.output_path));
  report.value("worst_error_estimate", worst);
  report.value("worst_rho_error_estimate", worst_of(results, &PointResult::rho_error_estimate, kStatusNoDolpPromised));
  report.value("wall_s", seconds_since(start));
  report.print(options.json, options.quiet, options.output_path);
  return options.strict && missed > 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
