#include "cli/plan_report.hpp"

#include <fmt/format.h>

#include "cli/report.hpp"

namespace dolp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMebibyte = 1048576.0;
constexpr double kPoints = 100.0;      // of DOLP
constexpr double kMostPoints = 200.0;  // from all s to all p; what a bound beyond says is nothing

std::string state_text(EffectState state) {
  return state == EffectState::kNotNeeded ? "not needed" : state_name(state);
}

std::string influence_text(const EffectRow& row) {
  if (!row.bound) return "-";
  const char* mark = row.unbounded > 0 ? " *" : "";
  const double points = kPoints * *row.bound;
  if (points == 0.0 && row.unbounded == 0) return "0";
  if (points >= kMostPoints) return fmt::format("> {:g}{}", kMostPoints, mark);
  return points >= 10.0 ? fmt::format("<= {:.0f}{}", points, mark) : fmt::format("<= {:.2g}{}", points, mark);
}

std::string work_text(const EffectRow& row, double share) {
  if (!row.part || row.state != EffectState::kKept) return "-";
  return share == 0.0 ? "0 %" : fmt::format("{:.3g} %", kPoints * share);
}

std::string effect_line(const EffectRow& row, double share) {
  const std::string needs = row.needs.empty() ? "" : fmt::format(" [{}]", row.needs);
  return fmt::format("  {:<14} {:<11} {:>11} {:>7}  {}{}\n", row.name, state_text(row.state), influence_text(row),
                     work_text(row, share), row.reason, needs);
}

std::string effects_table(const PlanReport& report) {
  std::string text =
      fmt::format("  {:<14} {:<11} {:>11} {:>7}  {}\n", "effect", "plan", "influence", "work", "why [what it takes]");
  for (std::size_t i = 0; i < report.effects.size(); ++i) {
    text += effect_line(report.effects[i], report.work_shares[i]);
  }
  text += "  influence: bound of the change of (Q/I, U/I) without the effect, in points of DOLP (0.01), worst entry\n";
  for (const EffectRow& row : report.effects) {
    if (row.unbounded == 0) continue;
    text += fmt::format("  *: none is known for {} of {} entries, so that nothing marked can be dropped\n",
                        row.unbounded, report.run.entries);
    break;
  }
  text +=
      "  work: share of the evaluations, f among them, that would go with the effect; those that share theirs have "
      "none alone\n";
  return text;
}

std::string dropped_text(const PlanReport& report) {
  const double tolerance = report.scene.accuracy.tolerance;
  if (report.plan.keep_all) return "  dropped     nothing (--keep-all)\n";
  if (report.plan.dropped.empty() && report.plan.needs_moments) {
    return fmt::format("  dropped     nothing: every bound exceeds {:g}, {:g} of the tolerance {:g}\n",
                       kDroppedShare * tolerance, kDroppedShare, tolerance);
  }
  return fmt::format(
      "  dropped     changes DOLP by {:.2g} at most in all; {:g}, {:g} of the tolerance {:g}, is allowed\n",
      report.plan.bound.dolp, kDroppedShare * tolerance, kDroppedShare, tolerance);
}

std::string output_text(const PlanReport& report) {
  if (!report.plan.gives_rho) return "  output      Stokes parameters, DOLP; without rho_i, rho_q and albedo\n";
  if (!report.plan.needs_moments) return "  output      Stokes parameters, DOLP, rho; without albedo\n";
  return "  output      Stokes parameters, DOLP, rho, albedo\n";
}

std::string precision_name(Precision precision) { return precision == Precision::kDouble ? "double" : "float"; }

std::string work_lines(const PlanReport& report) {
  const RunPrediction& run = report.run;
  std::string text;
  std::string how = run.is_exact ? "counted" : fmt::format("estimated from {} entries", kCountedEntries);
  if (run.interpolated > 0 && !run.is_exact) how = fmt::format("estimated from {} directions", kCountedDirections);
  text += fmt::format(
      "  attempts    first: {} at tolerance {:g}, {} moments, {} values of f; {:.3g} % again, tighter\n",
      precision_name(run.first.precision), run.first.tolerance, run.moments, run.beams, kPoints * run.again_share);
  if (run.moments == 0) return text;
  if (run.interpolated > 0) {
    text += fmt::format("  interpolate {} moments follow from these, to the same tolerance (accuracy.interpolation)\n",
                        run.interpolated);
  }
  text += fmt::format("  work        {:.4g} integrand evaluations in the first attempt ({}), {:.2g} in others\n",
                      run.first_evaluations, how, run.again_evaluations);
  if (report.dispatches.row_width > 1) {
    text += fmt::format("  sharing     entries that differ in q alone share their evaluations: {} groups of up to {}\n",
                        report.dispatches.rows, report.dispatches.row_width);
  }
  return text;
}

std::string kernel_lines(const PlanReport& report) {
  std::string text;
  for (const std::string& pipeline : report.pipelines) text += fmt::format("  pipeline    {}\n", pipeline);
  if (report.rule) {
    text += fmt::format("  rule        Gauss rules on smooth pieces, {:.3g} digits; at most {} nodes a piece\n",
                        report.rule->digits, report.rule->most_nodes);
  }
  text += work_lines(report);
  const std::string device =
      report.device.empty() ? "limits of any Vulkan device; none here: " + report.why_no_device : report.device;
  text += fmt::format("  dispatches  {} in the first attempt, at most {} invocations and {} shapes at a time ({})\n",
                      report.dispatches.dispatches, report.dispatches.tile_invocations, report.dispatches.block_shapes,
                      device);
  return text;
}

std::optional<double> estimated_s(const RunPrediction& run) {
  if (run.moments + run.beams == 0) return std::nullopt;
  return run.moments_s + run.beams_s;
}

std::string cost_lines(const PlanReport& report) {
  const bool is_idle = report.pipelines.empty();
  std::string text = is_idle ? "  work        no integrand evaluations: no device is used\n" : kernel_lines(report);
  text +=
      fmt::format("  memory      {:.3g} MiB of the host, {:.3g} MiB of the device\n", report.run.host_bytes / kMebibyte,
                  static_cast<double>(report.dispatches.device_bytes) / kMebibyte);
  if (const std::optional<double> seconds = estimated_s(report.run)) {
    text += fmt::format(
        "  time        estimate: {:.2g} s of evaluation with --evaluator cpu, from counting here; no device is "
        "timed\n",
        *seconds);
  }
  return text;
}

Json rows_json(const PlanReport& report) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < report.effects.size(); ++i) {
    const EffectRow& row = report.effects[i];
    rows.push_back({{"name", row.name},
                    {"asked_for", row.state != EffectState::kAbsent},
                    {"state", state_name(row.state)},
                    {"reason", row.reason},
                    {"needs", row.needs},
                    {"bound", row.bound ? Json(*row.bound) : Json(nullptr)},
                    {"entries_without_bound", row.unbounded},
                    {"work_share", report.work_shares[i]}});
  }
  return rows;
}

Json rule_json(const RuleSize& rule) { return {{"digits", rule.digits}, {"most_nodes", rule.most_nodes}}; }

}  // namespace

std::string plan_text(const PlanReport& report) {
  const Scene& scene = report.scene;
  const char* mode = scene.geometry.mode == Mode::kBistatic ? "bistatic" : "hemispherical";
  std::string text = fmt::format("{}\n", scene.title);
  text += fmt::format("  scene       {}, {} x {} x {} (theta x sigma x q) = {} entries, spectral samples: {}\n", mode,
                      scene.grid.theta_deg.size(), scene.grid.sigma.size(), scene.grid.q.size(), report.run.entries,
                      report.run.spectral_samples);
  return text + "\n" + effects_table(report) + "\n" + dropped_text(report) + output_text(report) + cost_lines(report);
}

Json plan_json(const PlanReport& report) {
  const RunPrediction& run = report.run;
  Json json = {{"title", report.scene.title},
               {"entries", run.entries},
               {"tolerance", report.scene.accuracy.tolerance},
               {"effects", effects_json(report.effects, report.plan)},
               {"rows", rows_json(report)},
               {"gives_rho", report.plan.gives_rho},
               {"gives_albedo", report.plan.needs_moments}};
  json["rule"] = report.rule ? rule_json(*report.rule) : Json(nullptr);
  json["pipelines"] = report.pipelines;
  json["device"] = report.device.empty() ? Json(nullptr) : Json(report.device);
  json["why_no_device"] = report.why_no_device;
  json["spectral_samples"] = run.spectral_samples;
  json["moments"] = run.moments;
  json["interpolated_moments"] = run.interpolated;
  json["beams"] = run.beams;
  json["first_attempt"] = {{"precision", precision_name(run.first.precision)},
                           {"tolerance", run.first.tolerance},
                           {"evaluations", run.first_evaluations},
                           {"is_exact", run.is_exact},
                           {"dispatches", report.dispatches.dispatches}};
  json["further_attempts"] = {
      {"share", run.again_share}, {"evaluations", run.again_evaluations}, {"beams", run.again_beams}};
  json["evaluations"] = run.first_evaluations + run.again_evaluations;
  json["tile_invocations"] = report.dispatches.tile_invocations;
  json["block_shapes"] = report.dispatches.block_shapes;
  json["host_bytes"] = run.host_bytes;
  json["device_bytes"] = report.dispatches.device_bytes;
  const std::optional<double> seconds = estimated_s(run);
  json["estimated_cpu_s"] = seconds ? Json(*seconds) : Json(nullptr);
  return json;
}

}  // namespace dolp::cli
