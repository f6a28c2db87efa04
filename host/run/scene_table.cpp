#include "run/scene_table.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "base/parallel_ranges.hpp"
#include "run/table_scene.hpp"

namespace dolp {
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

std::vector<Attribute> attributes(const TableContent& content) {
  const Scene& scene = content.scene;
  const EvaluationReport& evaluation = content.evaluation;
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"title", scene.title},
          {"source", "dolp " DOLP_VERSION},
          {"history", fmt::format("{:%Y-%m-%dT%H:%M:%SZ} {}", fmt::gmtime(now), content.command_line)},
          {"references",
           "W. Wang, Y. Li, L. Wang, Infrared Polarization Radiation Optimization Model Based on the Cauchy "
           "Distribution, Infrared 46(8), 2025, doi:10.3969/j.issn.1672-8785.2025.08.004"},
          {"scene", scene.text},
          {"scene_path", scene.path_name},
          {"scene_overrides", overrides_text(scene.overrides)},
          {"scene_hash", scene_hash(scene)},
          {"device", evaluation.device},
          {"driver", evaluation.driver},
          {"evaluator", evaluation.evaluator},
          {"precision", evaluation.precision},
          {"tolerance", scene.accuracy.tolerance},
          {"effects", effects_text(content.effects, content.plan)},
          {"rule", rule_text(scene.accuracy.tolerance, evaluation)},
          {"self_check_entries", static_cast<double>(content.check.entries)},
          {"self_check_worst_ratio", content.check.worst_ratio},
          {"wall_time_s", content.wall_s}};
}

}  // namespace

std::string rule_text(double tolerance, const EvaluationReport& evaluation) {
  std::string text = fmt::format(
      "product Gauss rules on the smooth pieces of slope and azimuth, orders for tolerance {:g}, bounds from pairs "
      "of rules",
      tolerance);
  if (evaluation.interpolated > 0) {
    text += fmt::format(
        "; {} moments interpolated in ln(sigma) and ln(q - q0) between {} at Chebyshev nodes, bounds from the last "
        "coefficients",
        evaluation.interpolated, evaluation.interpolation_nodes);
  }
  return text;
}

Table scene_table(const TableContent& content) {
  const Scene& scene = content.scene;
  Table table;
  table.theta_deg = scene.grid.theta_deg;
  table.sigma = scene.grid.sigma;
  table.q = scene.grid.q;
  table.stokes_units = stokes_units(scene);
  fill_variables(table, content.results, content.plan);
  table.attributes = attributes(content);
  return table;
}

}  // namespace dolp
