#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/result_csv.hpp"
#include "error.hpp"
#include "lookup/table_lookup.hpp"
#include "scene/points.hpp"
#include "scene/text.hpp"
#include "table/atomic_file.hpp"
#include "verify/table_scene.hpp"

namespace dolp::cli {
namespace {

using OptionalColumn = std::optional<std::vector<double>>;

/// One coordinate of all points.
struct Coordinate {
  const char* name;
  const OptionalColumn& given;
  const LookupAxis& axis;
  std::optional<double> of_scene;
};

std::string range_text(const LookupAxis& axis) {
  if (axis.size() == 1) return format_number(axis.min());
  return fmt::format("[{}, {}]", format_number(axis.min()), format_number(axis.max()));
}

/// The coordinate of each point: as given, or the only one that the table has, or that of its scene.
std::vector<double> values_of(const Coordinate& coordinate, const Points& points) {
  if (coordinate.given) {
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (coordinate.axis.contains((*coordinate.given)[row])) continue;
      throw InputError(fmt::format("{}:{}: {} = {}: outside the table, which has {}", points.name, points.line(row),
                                   coordinate.name, format_number((*coordinate.given)[row]),
                                   range_text(coordinate.axis)));
    }
    return *coordinate.given;
  }
  std::optional<double> value = coordinate.of_scene;
  if (coordinate.axis.size() == 1) value = coordinate.axis.min();
  if (!value || !coordinate.axis.contains(*value)) {
    throw InputError(fmt::format("{}:1: column \"{}\" is missing, a number in {}", points.name, coordinate.name,
                                 range_text(coordinate.axis)));
  }
  return std::vector<double>(points.size(), *value);
}

/// Refuses another index than the table's.
void check_index(const Scene& scene, const Points& points) {
  const Material& material = scene.surface.material;
  const auto check = [&](const char* name, const OptionalColumn& given, double own) {
    if (!given) return;
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (material.is_constant() && (*given)[row] == own) continue;
      throw InputError(fmt::format("{}:{}: {} = {}: the table is of {}; dolp eval computes other indices", points.name,
                                   points.line(row), name, format_number((*given)[row]),
                                   material.is_constant() ? fmt::format("{} = {}", name, format_number(own))
                                                          : "a material that depends on the wavelength"));
    }
  };
  check("n", points.n, material.constant.n);
  check("k", points.k, material.constant.k);
}

struct Summary {
  std::string table;
  std::string output;
  std::size_t points = 0;
  std::size_t missed = 0;
  double tolerance = 0.0;
  std::optional<double> worst_error;
  std::optional<double> worst_rho_error;
  double wall_s = 0.0;
};

Summary summary_of(const std::vector<PointResult>& results, double tolerance) {
  Summary summary;
  summary.points = results.size();
  summary.tolerance = tolerance;
  for (const PointResult& r : results) {
    if ((r.status & kStatusToleranceMissed) != 0) ++summary.missed;
    if ((r.status & kStatusNoDolpPromised) != 0) continue;
    summary.worst_error = std::max(summary.worst_error.value_or(0.0), r.error_estimate);
    summary.worst_rho_error = std::max(summary.worst_rho_error.value_or(0.0), r.rho_error_estimate);
  }
  return summary;
}

nlohmann::ordered_json json_of(const Summary& summary) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  return {{"table", summary.table},
          {"output", summary.output},
          {"points", summary.points},
          {"tolerance", summary.tolerance},
          {"tolerance_missed", summary.missed},
          {"worst_error_estimate", number(summary.worst_error)},
          {"worst_rho_error_estimate", number(summary.worst_rho_error)},
          {"wall_s", summary.wall_s}};
}

std::string text_of(const Summary& summary) {
  const std::string worst =
      summary.worst_error ? fmt::format("DOLP <= {:.2g} (absolute)", *summary.worst_error) : "stated for no point";
  return fmt::format(
      "{}\n  points     {}\n  error      {}, interpolation included; tolerance of the table {:g}\n  status 2   {} of "
      "{} "
      "points: tolerance not met\n  written    {}\n",
      summary.table, summary.points, worst, summary.tolerance, summary.missed, summary.points, summary.output);
}

}  // namespace

int run_lookup(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_is_no_input(options);
  const Table table = load_table(options.table_path);
  const Scene scene = table_scene(table, options.table_path);
  const TableLookup lookup(table, scene.accuracy.tolerance, options.table_path);
  const Points points = read_points(options.points_path, PointsKind::kDirections);
  check_index(scene, points);
  const std::vector<double> theta = values_of({"theta_deg", points.theta_deg, lookup.theta_deg(), {}}, points);
  const std::vector<double> sigma = values_of({"sigma", points.sigma, lookup.sigma(), scene.surface.sigma}, points);
  const std::vector<double> q = values_of({"q", points.q, lookup.q(), scene.surface.q}, points);
  check_writable(options.output_path);
  std::vector<PointResult> results;
  for (std::size_t i = 0; i < points.size(); ++i) results.push_back(lookup.at(theta[i], sigma[i], q[i]));
  std::string csv = points.header + ',' + kResultColumns + '\n';
  for (std::size_t i = 0; i < results.size(); ++i) csv += points.rows[i] + ',' + result_cells(results[i]) + '\n';
  write_text_atomically(options.output_path, csv);
  Summary summary = summary_of(results, scene.accuracy.tolerance);
  summary.table = options.table_path;
  summary.output = options.output_path;
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::FILE* const out = options.output_path == "-" ? stderr : stdout;
  if (options.json) {
    fmt::print(out, "{}\n", json_of(summary).dump(2));
  } else if (!options.quiet) {
    fmt::print(out, "{}", text_of(summary));
  }
  return options.strict && summary.missed > 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
