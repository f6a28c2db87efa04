#include "cli/scene_table.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "verify/table_scene.hpp"

namespace dolp::cli {
namespace {

void fill_variables(Table& table, const std::vector<PointResult>& results, const EffectPlan& plan) {
  const auto column = [&](double PointResult::*member) {
    std::vector<double> values;
    values.reserve(results.size());
    for (const PointResult& result : results) values.push_back(result.*member);
    return values;
  };
  table.dolp = column(&PointResult::dolp);
  table.stokes_i = column(&PointResult::stokes_i);
  table.stokes_q = column(&PointResult::stokes_q);
  table.stokes_u = column(&PointResult::stokes_u);
  table.stokes_v = column(&PointResult::stokes_v);
  table.error_estimate = column(&PointResult::error_estimate);
  if (plan.needs_moments) table.albedo = column(&PointResult::albedo);
  if (plan.gives_rho) {
    table.rho_i = column(&PointResult::rho_i);
    table.rho_q = column(&PointResult::rho_q);
    table.rho_error_estimate = column(&PointResult::rho_error_estimate);
  }
  for (const PointResult& result : results) table.status.push_back(result.status);
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
          {"effects", effects_text(effect_rows(scene, content.entries, content.plan), content.plan)},
          {"rule", rule_text(scene.accuracy.tolerance)},
          {"wall_time_s", content.wall_s}};
}

}  // namespace

std::string rule_text(double tolerance) {
  return fmt::format(
      "product Gauss rules on the smooth pieces of slope and azimuth, orders for tolerance {:g}, compared "
      "with three quarters of the nodes",
      tolerance);
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

}  // namespace dolp::cli
