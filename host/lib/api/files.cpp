#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <dolp/number_range.hpp>
#include "api/impl.hpp"
#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "report/run_report.hpp"
#include "run/estimates.hpp"
#include "run/mueller_run.hpp"
#include "run/scene_remarks.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "run/table_run.hpp"
#include "scene/scene_reader.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

/// Reads the points in a file. Ignores columns with names of results. Errors: InputError if `output` is an input file.
Points load_points(const std::filesystem::path& path, PointsKind kind, std::vector<std::string> inputs,
                   const std::filesystem::path& output) {
  inputs.push_back(path.string());
  check_output_is_no_input(output, inputs);
  std::vector<std::string> results = {"status"};
  for (const QuantityDescription& quantity : kQuantities) results.emplace_back(quantity.name);
  for (const Key& key : keys())
    for (const DerivativeColumn& column : derivative_columns({key.key})) results.push_back(column.name);
  return read_points(path.string(), kind, results);
}

std::optional<ScatteringGap> timed_gap(const SceneValues& scene, const SceneEntries& entries, RunOutcome& run) {
  const Clock::time_point start = Clock::now();
  std::optional<ScatteringGap> gap = scattering_gap(scene, entries, run.plan);
  run.estimates_s = seconds_since(start);
  return gap;
}

void add_left_out(ReportBuilder& report, const Points& points) {
  report.row_if(!points.left_out.empty(), "left out", "{} of the points: results, which are computed anew",
                join(points.left_out));
  report.value("left_out", points.left_out);
}

std::string mueller_csv(const Points& points, const std::vector<MuellerMatrix>& results) {
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

Report public_report(const ReportBuilder& report, bool is_good, const std::filesystem::path& output) {
  return {report.text(), report.json_text(), is_good, output, report.rows()};
}

std::vector<std::string> scene_files(const SceneValues& scene) {
  std::vector<std::string> files = scene.files;
  files.push_back(scene.path_name);
  if (scene.known) files.push_back(scene.known->table);
  return files;
}

void check_output_is_no_input(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code missing;  // set if a file does not exist; equivalent() then returns false
    if (std::filesystem::equivalent(output, input, missing)) {
      throw InputError(output.string() + ": the output would overwrite an input");
    }
  }
}

Report Evaluator::write_table(const Scene& scene, const std::filesystem::path& path, const RunOptions& call_options,
                              const Shard& shard) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    const SceneEntries entries = shard_entries(values, shard);
    const TableJob job{shard_path(path, shard), shard, options, impl_->options.evaluator};
    check_output_is_no_input(job.path, scene_files(values));
    check_output_path(job.path);
    if (!shard.is_none() && is_there(values, job)) {
      ReportBuilder report;
      add_title(report, values);
      report.row("kept", "{}: the whole shard is there already", key("output", job.path.string()));
      return public_report(report, true, job.path);
    }
    RunOutcome run = dolp::write_table(values, job, impl_->maker(values));
    const std::optional<ScatteringGap> gap = timed_gap(values, entries, run);
    run.wall_s += run.estimates_s;
    return public_report(run_report(values, run, gap, grid_text(entries.axes()), job.path.string()),
                         run.summary.meets_tolerance(), job.path);
  });
}

Report Evaluator::write_points(const Scene& scene, const std::filesystem::path& points_path,
                               const std::filesystem::path& path, const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    const Points points = load_points(points_path, PointsKind::kDirections, scene_files(values), path);
    check_labels_chosen(values, points);
    SceneEntries entries = point_entries(values, points);
    check_writable(path);
    Run run(values, std::move(entries), options, impl_->maker(values));
    const TableLayout layout{.quantities = output_quantities(values, nullptr, &run.entries()),
                             .derivatives = run.derivatives()};
    ResultCsv csv(path, points.header, layout,
                  [&](std::string& text, std::size_t row) { (text += points.rows[row]) += ','; });
    double rows_s = 0.0;
    const auto write_rows = [&](const SceneEntries&, RunResults results, const RunSummary&) {
      const Clock::time_point start = Clock::now();
      csv.append(run_columns(layout.quantities, std::move(results)));
      rows_s += seconds_since(start);
    };
    CollectedResults collected(run.entries());  // parts of a grid do not come in the order of the points
    const bool is_grid = run.entries().is_grid();
    RunOutcome outcome = run.compute(is_grid ? collected.sink() : Sink(write_rows));
    if (is_grid) write_rows(run.entries(), collected.take(), outcome.summary);
    const std::optional<ScatteringGap> gap = timed_gap(values, run.entries(), outcome);
    const Clock::time_point start = Clock::now();
    csv.commit();
    outcome.file_s = rows_s + seconds_since(start);
    outcome.wall_s = run.wall_s();
    ReportBuilder report = run_report(values, outcome, gap, fmt::format("{} points", points.size()), path.string());
    add_left_out(report, points);
    Report result = public_report(report, outcome.summary.meets_tolerance(), path);
    const std::vector<std::string> remarks = remarks_on(values, points);
    result.remarks.insert(result.remarks.end(), remarks.begin(), remarks.end());
    return result;
  });
}

Report Evaluator::write_mueller(const Scene& scene, const std::filesystem::path& points_path,
                                const std::filesystem::path& path, const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    const Clock::time_point start = Clock::now();
    const Points points = load_points(points_path, PointsKind::kGeometries, scene_files(values), path);
    check_labels_chosen(values);
    const std::vector<MuellerPoint> geometries = mueller_points(values, points);
    check_writable(path);
    report_start(options.progress, points.size());
    const auto evaluator = impl_->beam_evaluator();
    const std::vector<MuellerMatrix> results = evaluate_mueller(values, geometries, *evaluator, options.progress);
    write_text_atomically(path, mueller_csv(points, results));

    const auto nans = std::ranges::count_if(results, [](const MuellerMatrix& f) { return std::isnan(f[0]); });
    ReportBuilder report;
    add_title(report, values);
    report.row("entries", "{} geometries", key("entries", results.size()));
    add_evaluation(report, evaluator->report(), seconds_since(start));
    report.row("error", "<= {:g} of m00; tolerance {:g}", key("worst_error_estimate", mueller_error(values)),
               key("tolerance", values.accuracy.tolerance));
    report.row_if(nans > 0, "nan", "{} of {} geometries: f is not finite there, or takes over 1000 bounces",
                  key("without_value", nans), results.size());
    add_left_out(report, points);
    report.row("written", "{}", key("output", path.string()));
    return public_report(report, true, path);
  });
}

Report merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& path,
             const std::string& history) {
  const Clock::time_point start = Clock::now();
  std::vector<std::string> names;
  for (const std::filesystem::path& shard : shards) names.push_back(shard.string());
  check_output_is_no_input(path, names);
  check_output_path(path);
  const std::size_t entries = ShardSet(names).merge(path, history);
  ReportBuilder report;
  report.line("{} entries of {} shards", key("entries", entries), key("shards", shards.size()));
  report.row("written", "{}", key("output", path.string()));
  report.value("wall_s", seconds_since(start));
  return public_report(report, true, path);
}

}  // namespace dolp
