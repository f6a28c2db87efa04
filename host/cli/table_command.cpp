#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "cli/commands.hpp"
#include "cli/progress_bar.hpp"
#include "cli/report.hpp"
#include "parallel_ranges.hpp"
#include "table/table_file.hpp"
#include "verify/table_scene.hpp"

namespace dolp::cli {
namespace {

struct Column {
  std::vector<double> Table::*values;
  double PointResult::*member;
};

void fill_variables(Table& table, const std::vector<PointResult>& results, const EffectPlan& plan) {
  std::vector<Column> columns = {
      {&Table::dolp, &PointResult::dolp},         {&Table::stokes_i, &PointResult::stokes_i},
      {&Table::stokes_q, &PointResult::stokes_q}, {&Table::stokes_u, &PointResult::stokes_u},
      {&Table::stokes_v, &PointResult::stokes_v}, {&Table::error_estimate, &PointResult::error_estimate}};
  if (plan.needs_moments) columns.push_back({&Table::albedo, &PointResult::albedo});
  if (plan.gives_rho) {
    columns.push_back({&Table::rho_i, &PointResult::rho_i});
    columns.push_back({&Table::rho_q, &PointResult::rho_q});
    columns.push_back({&Table::rho_error_estimate, &PointResult::rho_error_estimate});
  }
  for (const Column& column : columns) (table.*column.values).resize(results.size());
  table.status.resize(results.size());
  constexpr std::size_t kEntriesAtOnce = 16384;
  parallel_ranges(results.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const Column& column : columns) (table.*column.values)[i] = results[i].*column.member;
      table.status[i] = results[i].status;
    }
  });
}

/// An exitance, in bistatic mode a radiance; per um at a single wavelength.
std::string stokes_units(const Scene& scene) {
  std::string units = "W m-2";
  if (scene.geometry.mode == Mode::kBistatic) units += " sr-1";
  if (!scene.spectrum.is_band()) units += " um-1";
  return units;
}

std::vector<Attribute> attributes(const Scene& scene, const Options& options, const RunReport& report) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"title", scene.title},
          {"source", "dolp " DOLP_VERSION},
          {"history", fmt::format("{:%Y-%m-%dT%H:%M:%SZ} {}", fmt::gmtime(now), options.command_line)},
          {"references",
           "W. Wang, Y. Li, L. Wang, Infrared Polarization Radiation Optimization Model Based on the Cauchy "
           "Distribution, Infrared 46(8), 2025, doi:10.3969/j.issn.1672-8785.2025.08.004"},
          {"scene", scene.text},
          {"scene_path", scene.path_name},
          {"scene_overrides", overrides_text(scene.overrides)},
          {"scene_hash", scene_hash(scene)},
          {"device", report.evaluation.device},
          {"driver", report.evaluation.driver},
          {"evaluator", report.evaluation.evaluator},
          {"precision", report.evaluation.precision},
          {"tolerance", report.tolerance},
          {"effects", effects_text(report.effects, report.plan)},
          {"rule", rule_text(report.tolerance)},
          {"wall_time_s", report.wall_s}};
}

}  // namespace

int run_table(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  check_output_path(options.output_path);
  const std::vector<SceneEntry> entries = grid_entries(scene);
  const EffectPlan plan = plan_run(options, scene, entries);
  const bool integrates = wants_evaluator(scene, entries, plan);
  const std::unique_ptr<MomentsEvaluator> evaluator = integrates ? make_evaluator(options, scene) : nullptr;
  std::vector<PointResult> results;
  {
    ProgressBar bar(options.quiet);
    results = evaluate_scene(scene, entries, plan, evaluator.get(), bar.callback());
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  RunReport report = make_report(scene, entries, results, plan, report_of(evaluator.get(), options), wall.count());
  report.output = options.output_path;
  report.shape = fmt::format("{} x {} x {} (theta x sigma x q)", scene.grid.theta_deg.size(), scene.grid.sigma.size(),
                             scene.grid.q.size());
  Table table;
  table.theta_deg = scene.grid.theta_deg;
  table.sigma = scene.grid.sigma;
  table.q = scene.grid.q;
  table.stokes_units = stokes_units(scene);
  fill_variables(table, results, plan);
  table.attributes = attributes(scene, options, report);
  results = {};  // room for the file
  write_table(table, options.output_path);
  print_report(report, options.json, options.quiet);
  return options.strict && report.missed_tolerance > 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
