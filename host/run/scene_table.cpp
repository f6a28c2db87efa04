#include "run/scene_table.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "base/parallel_ranges.hpp"
#include "run/table_scene.hpp"

namespace dolp {
namespace {

/// Whether a run gives a variable at all.
bool is_given(const TableVariable& variable, const Scene& scene, const EffectPlan& plan) {
  const auto is_one_of = [&](std::initializer_list<double PointResult::*> members) {
    return std::ranges::find(members, variable.member) != members.end();
  };
  if (is_one_of({&PointResult::albedo})) return plan.needs_moments;
  if (is_one_of({&PointResult::rho_i, &PointResult::rho_q, &PointResult::rho_error_estimate})) return plan.gives_rho;
  if (is_one_of({&PointResult::emissivity_s, &PointResult::emissivity_p})) return gives_emissivity(scene, plan);
  if (is_one_of({&PointResult::dolp_low, &PointResult::dolp_high}))
    return scene.emission && scene.emission->has_bracket;
  return true;
}

void fill_variables(Table& table, const TableContent& content) {
  const std::vector<PointResult>& results = content.results;
  std::vector<const TableVariable*> columns;
  for (const TableVariable& variable : table_variables()) {
    if (is_given(variable, content.scene, content.plan)) columns.push_back(&variable);
  }
  for (const TableVariable* column : columns) (table.*column->values).resize(results.size());
  table.status.resize(results.size());
  constexpr std::size_t kEntriesAtOnce = 16384;
  parallel_ranges(results.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const TableVariable* column : columns) (table.*column->values)[i] = results[i].*column->member;
      table.status[i] = results[i].status;
    }
  });
}

void fill_curves(Table& table, const Scene& scene) {
  const Material& material = scene.surface.material;
  const std::vector<double> one_um = {scene.spectrum.min_um};
  const auto curve_of = [&](const SpectralTable& tabulated, double constant) -> Curve {
    if (tabulated.wavelength_um.empty()) return {one_um, {constant}};
    return {tabulated.wavelength_um, tabulated.value};
  };
  table.index_n = curve_of(material.n, material.constant.n);
  table.index_k = curve_of(material.k, material.constant.k);
  if (!scene.source) return;
  if (scene.source->kind == Source::Kind::kFlat) table.irradiance = {one_um, {scene.source->irradiance}};
  if (scene.source->kind == Source::Kind::kTabulated) table.irradiance = curve_of(scene.source->table, 0.0);
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

ExtraColumns extra_columns(const Scene& scene) {
  return {.emissivity = scene.emission.has_value(), .bracket = scene.emission && scene.emission->has_bracket};
}

Table scene_table(const TableContent& content) {
  const Scene& scene = content.scene;
  Table table;
  table.theta_deg = scene.grid.theta_deg;
  table.sigma = scene.grid.sigma;
  table.q = scene.grid.q;
  table.stokes_units = stokes_units(scene);
  fill_variables(table, content);
  fill_curves(table, scene);
  table.attributes = attributes(content);
  const Dispersion& formula = scene.surface.material.n.formula;
  if (formula.number != 0) table.attributes.push_back({"index_n_formula", formula_text(formula)});
  return table;
}

}  // namespace dolp
