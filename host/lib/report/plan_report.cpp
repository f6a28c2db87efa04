#include "report/run_report.hpp"

#include <algorithm>
#include <dolp/errors.hpp>
#include <optional>

#include "base/processor.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "evaluate/vulkan/tiles.hpp"
#include "model/choices.hpp"
#include "plan/kernel_data.hpp"
#include "run/estimates.hpp"
#include "run/prediction.hpp"
#include "run/scene_remarks.hpp"
#include "run/scene_run.hpp"
#include "verify/interpolation.hpp"

namespace dolp {
namespace {

struct PlannedRun {
  SceneValues scene;
  EffectPlan plan;
  std::vector<Effect> effects;
  Influences influences;
  RunPrediction run;
  double rule_digits = 0.0;
  int most_nodes = 0;                  ///< largest number of nodes per slope interval or azimuth arc; 0 without moments
  std::vector<std::string> pipelines;  ///< Vulkan pipelines of the first refinement level; may be empty
  vulkan::DispatchCount dispatches;    ///< dispatches of the first refinement level
  InterpolationForecast between;
  std::string device;  ///< name of the device; empty if there is none
  std::string why_no_device;
};

/// The device that a run would use. If there is none, a device with the lowest limits that Vulkan allows.
Device find_device(const std::string& choice, const SceneValues& scene, PlannedRun& planned) {
  const bool in_double = scene.accuracy.precision == Precision::kDouble;
  const DeviceList list = list_devices();
  try {
    if (list.devices.empty()) throw DeviceError(list.why_empty);
    const Device& device = list.devices[choose_device(list.devices, choice, in_double)];
    planned.device = device.name;
    return device;
  } catch (const DeviceError& error) {
    if (!choice.empty()) throw;
    planned.why_no_device = error.what();
    Device least = least_device();
    least.has_double = true;
    return least;
  }
}

void add_dispatches(PlannedRun& planned, const vulkan::DispatchCount& request_count) {
  planned.dispatches.dispatches += request_count.dispatches;
  planned.dispatches.tile_invocations = std::max(planned.dispatches.tile_invocations, request_count.tile_invocations);
  planned.dispatches.row_width = std::max(planned.dispatches.row_width, request_count.row_width);
  planned.dispatches.rows += request_count.rows;
  planned.dispatches.block_shapes = std::max(planned.dispatches.block_shapes, request_count.block_shapes);
  planned.dispatches.device_bytes = std::max(planned.dispatches.device_bytes, request_count.device_bytes);
}

void add_pipeline(PlannedRun& planned, const char* kernel, Precision precision, const std::string& more = {}) {
  const Surface& surface = planned.scene.surface;
  const std::string text = fmt::format("{}, {}: distribution {}, masking {}{}", kernel, to_name(precision),
                                       to_name(surface.distribution), to_name(surface.masking), more);
  if (std::ranges::find(planned.pipelines, text) == planned.pipelines.end()) planned.pipelines.push_back(text);
}

void add_request(PlannedRun& planned, const MomentsRequest& request, const Device& device) {
  add_dispatches(planned, count_dispatches(request, device));
  const KernelData data = kernel_data(request, Tables::kCounted);
  planned.rule_digits = data.rule.digits;
  planned.most_nodes = data.rule_order;
  std::string more;
  if (request.scattering == Scattering::kMultiple) more += ", all bounces";
  if (request.wants_direct) more += ", direct emission";
  add_pipeline(planned, has_slope_samples(request) ? "slopes" : "moments", request.precision, more);
  if (data.needs_masking_table()) add_pipeline(planned, "masking_table", request.precision);
}

PlannedRun planned_run(const SceneValues& scene, const std::string& device, EffectPlan plan) {
  PlannedRun planned;
  planned.scene = scene;
  const Device limits = find_device(device, scene, planned);
  const std::size_t without_a_run = peak_resident_bytes();  // peak memory of scene and driver, before the prediction
  const SceneEntries entries = grid_entries(scene);
  planned.plan = with_spectra(std::move(plan), scene, entries);
  planned.effects = list_effects(scene, entries, planned.plan);
  planned.influences = add_influences(planned.effects, scene, entries, planned.plan);
  planned.run = predict_run(scene, entries, planned.plan, limits.has_double,
                            [&](const MomentsRequest& request) { add_request(planned, request, limits); });
  if (planned.dispatches.row_width > 1) {
    // The prediction counts the nodes of each entry. A device uses the same nodes for a row, that is, for entries that
    // differ only in q: as many nodes as the most demanding entry needs.
    planned.run.first_evaluations *=
        static_cast<double>(planned.dispatches.rows) / static_cast<double>(planned.run.moments);
    planned.run.is_exact = false;
  }
  const RunPrediction& run = planned.run;
  const double evaluations = run.first_evaluations + run.again_evaluations;
  const double per_moment = evaluations / static_cast<double>(std::max<std::size_t>(run.moments, 1));
  planned.between = forecast_interpolation(scene, planned.plan, allowed_evaluations(scene, evaluations),
                                           per_moment * static_cast<double>(run.spectral_samples));
  planned.run.host_bytes += static_cast<double>(without_a_run);
  return planned;
}

constexpr int kLabelWidth = 11;

std::string influence_text(const Effect& row) {
  if (!row.bound && !row.influence) return "-";
  const double points = kPoints * row.bound.value_or(row.influence.value_or(0.0));
  if (points == 0.0) return "0";
  const char* relation = row.bound ? "<=" : "about";
  return points >= 10.0 ? fmt::format("{} {:.0f}", relation, points) : fmt::format("{} {:.2g}", relation, points);
}

ReportBuilder effect_report(const Effect& row) {
  ReportBuilder report;
  const char* const state = row.state == EffectState::kNotNeeded ? "not needed" : to_name(row.state);
  report.line("  {:<14} {:<11} {:>11}  {}{}", key("name", row.name), state, influence_text(row),
              key("reason", row.reason), row.needs.empty() ? "" : fmt::format(" [{}]", row.needs));
  report.values(
      {{"asked_for", row.state != EffectState::kAbsent}, {"state", to_name(row.state)}, {"needs", row.needs}});
  report.value("bound", row.bound);
  report.value("influence_estimate", row.influence);
  return report;
}

void add_model_change(ReportBuilder& report, const SceneValues& scene, const Influences& influences) {
  const ModelChange& change = influences.model_change;
  if (!scene.surface.has_only_direct())
    report.line("  model: {}, at {}{}", model_change_text(change), influences.looked.text(),
                change.status != 0 ? ": status 32" : "");
  if (change.status != 0) report.line("    {}", model_advice(scene));
  add_direct_emission(report, scene, change);
  report.values({{"model_change", change.i}, {"model_change_dolp", change.dolp_points}});
}

void add_effects(ReportBuilder& report, const PlannedRun& plan) {
  report.value("effects", effects_json(plan.effects, plan.plan));
  report.line("  {:<14} {:<11} {:>11}  {}", "effect", "plan", "influence", "why [what it takes]");
  std::vector<ReportBuilder> rows;
  for (const Effect& row : plan.effects) rows.push_back(effect_report(row));
  report.add("rows", rows);
  report.line(
      "  influence: change of (Q/I, U/I) without the effect, in points of DOLP (0.01): a bound of what is dropped, an "
      "estimate from {} of what is kept",
      plan.influences.looked.text());
}

std::string dropped_text(const EffectPlan& plan, double tolerance) {
  if (plan.keep_all) return "nothing (all are kept)";
  const double allowed = kDroppedShare * tolerance;
  if (plan.dropped.empty() && plan.kept.moments) {
    return fmt::format("nothing: every bound exceeds {:g}, {:g} of the tolerance {:g}", allowed, kDroppedShare,
                       tolerance);
  }
  return fmt::format("changes DOLP by {:.2g} at most in all; {:g}, {:g} of the tolerance {:g}, is allowed", plan.bound,
                     allowed, kDroppedShare, tolerance);
}

std::string output_text(const SceneValues& scene, const EffectPlan& plan) {
  std::string text = "Stokes parameters, DOLP";
  if (scene.emission && scene.emission->has_bracket) text += ", its bracket";
  if (gives_emissivity(scene, plan)) text += ", emissivity";
  if (!plan.gives_rho) return text + "; without rho_i, rho_q and albedo";
  return text + (plan.gives_albedo ? ", rho, albedo" : ", rho; without albedo");
}

std::string how_counted(const RunPrediction& run) {
  if (run.is_exact) return "counted";
  return run.counts_directions ? fmt::format("estimated from {} directions", run.counted_directions)
                               : fmt::format("estimated from {} entries", run.counted_entries);
}

void add_attempts(ReportBuilder& report, const PlannedRun& plan, bool is_idle) {
  const RunPrediction& run = plan.run;
  report.row_if(
      !is_idle, "attempts", "first: {} at tolerance {:g}, {} moments, {} values of f; {:.3g} % again, tighter",
      key("first_attempt/precision", to_name(run.first.precision)), key("first_attempt/tolerance", run.first.tolerance),
      key("moments", run.moments), key("beams", run.beams), kPoints * run.again_share);
  report.value("further_attempts/share", run.again_share);
  report.row_if(run.interpolated > 0 && run.moments > 0, "interpolate",
                "{} moments follow from these, to the same tolerance (accuracy.interpolation)",
                key("interpolated_moments", run.interpolated));
  report.row_if(run.moments > 0, "work", "{:.4g} integrand evaluations in the first attempt ({}), {:.2g} in others",
                key("first_attempt/evaluations", run.first_evaluations), how_counted(run),
                key("further_attempts/evaluations", run.again_evaluations));
  report.value("first_attempt/is_exact", run.is_exact);
  report.value("further_attempts/beams", run.again_beams);
  report.value("evaluations", run.first_evaluations + run.again_evaluations);
  report.value("plan_evaluations", run.counted_evaluations + plan.influences.evaluations + plan.between.evaluations);
}

void add_kernels(ReportBuilder& report, const PlannedRun& plan) {
  const bool is_idle = plan.pipelines.empty();
  report.row_if(is_idle, "work", "no integrand evaluations: no device is used");
  for (const std::string& pipeline : plan.pipelines) report.row("pipeline", "{}", pipeline);
  report.value("pipelines", plan.pipelines);
  report.value("rule", nullptr);
  if (plan.most_nodes > 0) {
    report.row("rule", "Gauss rules on smooth pieces, {:.3g} digits; at most {} nodes a piece",
               key("rule/digits", plan.rule_digits), key("rule/most_nodes", plan.most_nodes));
  }
  add_attempts(report, plan, is_idle);
  const bool has_device = !plan.device.empty();
  report.row_if(
      !is_idle, "dispatches", "at least {} in the first attempt, at most {} invocations{} at a time ({}{})",
      key("first_attempt/dispatches", plan.dispatches.dispatches),
      key("tile_invocations", plan.dispatches.tile_invocations),
      plan.dispatches.block_shapes > 0 ? fmt::format(" and {} shapes", plan.dispatches.block_shapes) : "",
      has_device ? plan.device : "limits of any Vulkan device; none here: ", key("why_no_device", plan.why_no_device));
  report.value("block_shapes", plan.dispatches.block_shapes);
  report.value("device", has_device ? std::optional(plan.device) : std::nullopt);
}

void add_cost(ReportBuilder& report, const PlannedRun& plan) {
  const RunPrediction& run = plan.run;
  report.row("memory", "{:.3g} MiB of the host, {:.3g} MiB of the device", run.host_bytes / kMebibyte,
             static_cast<double>(plan.dispatches.device_bytes) / kMebibyte);
  report.values({{"host_bytes", run.host_bytes}, {"device_bytes", plan.dispatches.device_bytes}});
  report.value("estimated_cpu_s", nullptr);
  if (run.moments + run.beams == 0) return;
  report.row("time", "estimate: {:.2g} s of evaluation with the evaluator cpu, from counting here; no device is timed",
             key("estimated_cpu_s", run.cpu_s));
}

std::string error_text(const ErrorSummary& error) {
  if (error.compared == 0) return "not examined: it would take a large part of the run";
  return fmt::format("linear interpolation of DOLP errs by {:.1g} (median), {:.1g} (largest)", error.median,
                     error.largest);
}

void add_between(ReportBuilder& report, const PlannedRun& plan) {
  std::vector<ReportBuilder> axes;
  for (const AxisForecast& axis : plan.between.axes) {
    ReportBuilder& row = axes.emplace_back(kLabelWidth);
    const bool is_known = axis.needed_values > 0;
    row.row("between", "along {}: {} between {} values{}", key("axis", describe(axis.axis).name),
            error_text(axis.error), key("values", axis.values),
            is_known ? fmt::format("; about {} values keep it within the tolerance", axis.needed_values) : "");
    row.value("median", axis.error.compared > 0 ? std::optional(axis.error.median) : std::nullopt);
    row.value("largest", axis.error.compared > 0 ? std::optional(axis.error.largest) : std::nullopt);
    row.value("needed_values", is_known ? std::optional(axis.needed_values) : std::nullopt);
  }
  report.add("between", axes);
}

}  // namespace

std::string grid_text(const Axes& grid) {
  std::string counts, names;
  for (const Axis axis : kAllAxes) {
    if (grid[axis].empty()) continue;
    counts += fmt::format("{}{}", counts.empty() ? "" : " x ", grid[axis].size());
    names += fmt::format("{}{}", names.empty() ? "" : " x ", describe(axis).name);
  }
  return fmt::format("{} ({})", counts, names);
}

ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan) {
  ReportBuilder::Json json;
  for (const EffectState state :
       {EffectState::kKept, EffectState::kDropped, EffectState::kNotNeeded, EffectState::kAbsent}) {
    json[to_name(state)] = ReportBuilder::Json::array();
  }
  for (const Effect& row : effects) {
    ReportBuilder::Json row_json = {{"name", row.name}, {"reason", row.reason}};
    if (row.state == EffectState::kDropped) row_json["bound"] = row.bound.value_or(0.0);
    json[to_name(row.state)].push_back(row_json);
  }
  json["keep_all"] = plan.keep_all;
  json["allowed_share_of_tolerance"] = kDroppedShare;
  json["dolp_bound"] = plan.bound;
  return json;
}

ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan effects) {
  const PlannedRun plan = planned_run(scene, device, std::move(effects));
  ReportBuilder report(kLabelWidth);
  add_title(report, scene);
  report.row("scene", "{}, {} = {} entries, spectral samples: {}", to_name(scene.geometry.mode), grid_text(scene.grid),
             key("entries", plan.run.entries), key("spectral_samples", plan.run.spectral_samples));
  report.line("");
  add_effects(report, plan);
  add_model_change(report, scene, plan.influences);
  report.line("");
  report.row("dropped", "{}", dropped_text(plan.plan, scene.accuracy.tolerance));
  report.row("output", "{}", output_text(scene, plan.plan));
  report.values({{"tolerance", scene.accuracy.tolerance},
                 {"gives_rho", plan.plan.gives_rho},
                 {"gives_albedo", plan.plan.gives_albedo},
                 {"gives_emissivity", gives_emissivity(scene, plan.plan)}});
  add_kernels(report, plan);
  add_cost(report, plan);
  add_between(report, plan);
  return report;
}

}  // namespace dolp
