#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/number_text.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "run/mueller_run.hpp"
#include "scene/points.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

/// Everything there is to say about one run.
struct MuellerReport {
  std::string title;
  std::string output;
  std::size_t points = 0;
  std::size_t without_value = 0;  ///< rows of NaN
  double tolerance = 0.0;
  double accuracy = 0.0;  ///< bound of the error of each element, over m00
  double wall_s = 0.0;
  EvaluationReport evaluation;
};

std::string csv_text(const Points& points, const std::vector<MuellerElements>& results) {
  std::string csv = points.header;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) csv += fmt::format(",m{}{}", row, column);
  }
  csv += '\n';
  for (std::size_t i = 0; i < results.size(); ++i) {
    csv += points.rows[i];
    for (const double element : results[i]) (csv += ',') += number_text(element);
    csv += '\n';
  }
  return csv;
}

nlohmann::ordered_json report_json(const MuellerReport& report) {
  const EvaluationReport& e = report.evaluation;
  return {{"title", report.title},
          {"output", report.output},
          {"entries", report.points},
          {"without_value", report.without_value},
          {"evaluator", e.evaluator},
          {"device", e.device},
          {"driver", e.driver},
          {"precision", e.precision},
          {"tolerance", report.tolerance},
          {"worst_error_estimate", report.accuracy},
          {"dispatches", e.dispatches},
          {"wall_s", report.wall_s},
          {"kernel_s", e.kernel_s},
          {"setup_s", e.setup_s}};
}

std::string report_text(const MuellerReport& report) {
  const EvaluationReport& e = report.evaluation;
  std::string text = fmt::format("{}\n  entries    {} geometries\n", report.title, report.points);
  text +=
      fmt::format("  device     {}{}{}, {} precision\n", e.device, e.driver.empty() ? "" : ", ", e.driver, e.precision);
  text += fmt::format("  time       {:.3f} s in all, {:.3f} s in kernels, {} dispatches\n", report.wall_s, e.kernel_s,
                      e.dispatches);
  text += fmt::format("  error      <= {:g} of m00; tolerance {:g}\n", report.accuracy, report.tolerance);
  if (report.without_value > 0) {
    text += fmt::format("  nan        {} of {} geometries: f has no finite value there\n", report.without_value,
                        report.points);
  }
  return text + fmt::format("  written    {}\n", report.output);
}

void print(const MuellerReport& report, const Options& options) {
  std::FILE* out = report.output == "-" ? stderr : stdout;
  if (options.json) {
    fmt::print(out, "{}\n", report_json(report).dump(2));
  } else if (!options.quiet) {
    fmt::print(out, "{}", report_text(report));
  }
}

}  // namespace

int run_mueller(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_one_stdin(options);
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  const Points points = read_points(options.points_path, PointsKind::kGeometries);
  const std::vector<MuellerPoint> geometries = mueller_points(scene, points);
  check_writable(options.output_path);
  const std::unique_ptr<MomentsEvaluator> evaluator = make_evaluator(options, scene);
  std::vector<MuellerElements> results;
  {
    ProgressBar bar(options.quiet);
    results = evaluate_mueller(scene, geometries, *evaluator, bar.callback());
  }
  write_text_atomically(options.output_path, csv_text(points, results));

  const bool is_float = options.evaluator != "reference" &&
                        mueller_precision(scene.accuracy, evaluator->has_double()) == Precision::kFloat;
  MuellerReport report;
  report.title = scene.title;
  report.output = options.output_path;
  report.points = results.size();
  report.without_value = static_cast<std::size_t>(
      std::ranges::count_if(results, [](const MuellerElements& f) { return std::isnan(f[0]); }));
  report.tolerance = scene.accuracy.tolerance;
  report.accuracy = is_float ? kScatteringErrorFloat : kScatteringErrorDouble;
  report.evaluation = evaluator->report();
  report.wall_s = seconds_since(start);
  print(report, options);
  return options.strict && report.accuracy > report.tolerance ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
