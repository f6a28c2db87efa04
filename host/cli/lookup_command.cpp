#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/interrupt.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "model/status.hpp"
#include "run/lookup_run.hpp"
#include "run/table_scene.hpp"
#include "table/table_lookup.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {

int run_lookup(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_is_no_input(options);
  const Table table = load_table(options.table_path);
  const Scene scene = table_scene(table, options.table_path);
  const TableLookup lookup(table, scene.accuracy.tolerance, options.table_path);
  const Points points = load_points(options, PointsKind::kDirections);
  check_writable(options.output_path);
  watch_for_interrupts();
  const std::vector<PointResult> results =
      lookup_points(lookup, scene, points, [](std::size_t, std::size_t) { return !interrupted(); });
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
