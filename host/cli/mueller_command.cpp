#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/atomic_file.hpp"
#include "base/number_text.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "run/mueller_run.hpp"
#include "scene/points.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

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

}  // namespace

int run_mueller(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_one_stdin(options);
  const Scene scene = load_scene(options);
  check_output_is_no_input(options, scene.files);
  const Points points = load_points(options, PointsKind::kGeometries);
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
  const double accuracy = is_float ? kScatteringErrorFloat : kScatteringErrorDouble;
  const auto nans = std::ranges::count_if(results, [](const MuellerElements& f) { return std::isnan(f[0]); });
  Report report;
  report.line("{}", key("title", scene.title));
  report.row("entries", "{} geometries", key("entries", results.size()));
  add_evaluation(report, evaluator->report(), seconds_since(start));
  report.row("error", "<= {:g} of m00; tolerance {:g}", key("worst_error_estimate", accuracy),
             key("tolerance", scene.accuracy.tolerance));
  report.row_if(nans > 0, "nan", "{} of {} geometries: f has no finite value there", key("without_value", nans),
                results.size());
  report.row("written", "{}", key("output", options.output_path));
  report.print(options.json, options.quiet, options.output_path);
  return options.strict && accuracy > scene.accuracy.tolerance ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
