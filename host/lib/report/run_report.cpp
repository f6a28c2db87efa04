#include "report/run_report.hpp"

#include <algorithm>
#include <utility>

#include <dolp/status.hpp>
#include "base/numbers.hpp"
#include "plan/kernel_data.hpp"
#include "run/scene_remarks.hpp"
#include "run/scene_table.hpp"

namespace dolp {
namespace {

double roundoff_growth(const Arithmetic& arithmetic) { return float_roundoff(arithmetic) / kFloatRoundoff; }

constexpr double kFewEvaluations = 1e6;  // number of evaluations that one core computes in about 0.1 s

ReportBuilder range_report(const char* what, double limit, const EnergyRange& range) {
  ReportBuilder report;
  report.values({{"entries", range.entries}, {"theta_deg", range.theta_deg}, {"sigma", range.sigma}});
  if (range.entries == 0) return report;
  report.line("    {} {}): {} entries, theta {:g}..{:g}, sigma {:.4g}..{:.4g}", what, limit, range.entries,
              range.theta_deg.first, range.theta_deg.second, range.sigma.first, range.sigma.second);
  return report;
}

void add_energy(ReportBuilder& report, const RunSummary& summary, bool is_computed) {
  if (summary.albedos == 0) {
    report.row("albedo", "{}", is_computed ? "not given for any entry" : "not computed: nothing kept depends on it");
    report.value("albedo", nullptr);
    return;
  }
  const bool is_off = summary.loses.entries + summary.gains.entries > 0;
  report.row("albedo", "{:.3g}..{:.3g}{}", key("albedo/min", summary.albedo.first),
             key("albedo/max", summary.albedo.second),
             is_off ? ": the surface model itself does not keep the energy" : "");
  report.add("albedo/loses_energy", range_report("loses it (below", kAlbedoMin, summary.loses));
  report.add("albedo/gains_energy", range_report("gains it (above", kAlbedoMax, summary.gains));
}

void add_effects(ReportBuilder& report, const RunOutcome& run) {
  std::string kept;
  for (const Effect& row : run.effects) {
    if (row.state == EffectState::kKept) kept += (kept.empty() ? "" : ", ") + row.name;
  }
  report.row("kept", "{}{}", kept.empty() ? "nothing" : kept, run.plan.keep_all ? " (all are kept)" : "");
  for (const Effect& row : run.effects) {
    report.row_if(row.state == EffectState::kDropped, "dropped", "{}: {}", row.name, row.reason);
  }
  report.value("effects", effects_json(run.effects, run.plan));
}

std::string bound_text(const std::optional<double>& bound) {
  return bound ? fmt::format("<= {:.2g}", *bound) : "not promised for any entry";
}

void add_work(ReportBuilder& report, const EvaluationReport& e, std::size_t entries) {
  const double per_entry = entries > 0 ? e.evaluations / static_cast<double>(entries) : 0.0;
  report.row("work", "{:.4g} integrand evaluations, {:.0f} an entry", key("evaluations", e.evaluations), per_entry);
  report.row_if(e.interpolated > 0, "of these", "{} moments interpolated or combined, from {}",
                key("interpolated_moments", e.interpolated), key("interpolation_nodes", e.interpolation_nodes));
}

/// The parts of the time of a run. No two of them overlap, and `other_s` is what they leave of `wall_s`.
void add_times(ReportBuilder& report, const RunOutcome& run) {
  const EvaluationReport& e = run.evaluation;
  const RunSummary& summary = run.summary;
  const double named_s = e.setup_s + e.kernel_s + e.sums_s + e.curves_s + e.beams_s + e.transfer_s +
                         summary.response_basis_s + summary.radiometry_s + summary.check_s + run.spectral_rule_s +
                         run.estimates_s + run.derivatives_s + run.file_s;
  report.row_if(e.evaluator != "vulkan", "of that", "{:.3f} s in sums of the host", e.sums_s);
  report.row("", "{:.3f} s in the spectral rule, {:.3f} s in the response basis, {:.3f} s in reflectance curves",
             key("spectral_rule_s", run.spectral_rule_s), key("response_basis_s", summary.response_basis_s),
             key("reflectance_curves_s", e.curves_s));
  report.row("", "{:.3f} s to move data of kernels, {:.3f} s in radiometry, {:.3f} s waiting for the file",
             key("transfer_s", e.transfer_s), key("radiometry_s", summary.radiometry_s), key("file_s", run.file_s));
  report.row_if(run.derivatives_s > 0.0, "", "{:.3f} s in derivatives, without their kernels",
                key("derivatives_s", run.derivatives_s));
  report.row("", "{:.3f} s in the check, {:.3f} s in estimates, {:.3f} s in the rest", key("check_s", summary.check_s),
             key("estimates_s", run.estimates_s), key("other_s", std::max(run.wall_s - named_s, 0.0)));
}

void add_errors(ReportBuilder& report, const RunOutcome& run, double tolerance) {
  const std::optional<double> dolp = run.summary.worst_error;
  std::optional<double> rho;
  if (run.plan.gives_rho) rho = run.summary.worst_rho_error;
  report.row("error", "DOLP {} (absolute), {}; tolerance {:g}", bound_text(dolp),
             run.plan.gives_rho ? fmt::format("rho {} (of rho_I)", bound_text(rho)) : "rho not computed",
             key("tolerance", tolerance));
  report.value("worst_error_estimate", dolp);
  report.value("worst_rho_error_estimate", rho);
}

void add_status(ReportBuilder& report, const RunSummary& summary) {
  std::vector<ReportBuilder> parts;
  using Bit = std::pair<std::uint32_t, const char*>;  // fmt 10 cannot format enumerations
  for (const auto& [bit, meaning] :
       {Bit{kReflectanceOutsideZeroToOne, "reflectance outside [0, 1]"},
        Bit{kToleranceNotMet, "DOLP misses the tolerance"}, Bit{kOutsideModelDomain, "outside the model's domain"},
        Bit{kIntensityNotPositive, "intensity not positive"}, Bit{kRhoToleranceNotMet, "rho misses the tolerance"},
        Bit{kModelInaccurate, kModelInaccurateText}}) {
    ReportBuilder& part = parts.emplace_back();
    part.value("bit", bit);
    part.row(fmt::format("status {}", bit), "{} of {} entries: {}", key("count", summary.count(bit)), summary.entries,
             key("meaning", meaning));
  }
  report.add("status", parts);
}

}  // namespace

std::string arithmetic_text(const Arithmetic& arithmetic) {
  const auto& [division, root] = arithmetic;
  const double growth = roundoff_growth(arithmetic);
  return fmt::format("errors of float: division {:.2f} ulp (mean {:+.2f}), square root {:.2f} ulp (mean {:+.2f}); {}",
                     division.largest, division.mean, root.largest, root.mean,
                     growth > 1.0
                         ? fmt::format("bounds of rounding grow {:.1f} times, so double is needed earlier", growth)
                         : std::string("rounded correctly"));
}

ReportBuilder::Json arithmetic_json(const Arithmetic& arithmetic) {
  return {{"division_ulp", arithmetic.division.largest},
          {"division_mean_ulp", arithmetic.division.mean},
          {"root_ulp", arithmetic.root.largest},
          {"root_mean_ulp", arithmetic.root.mean},
          {"roundoff_growth", roundoff_growth(arithmetic)}};
}

void add_title(ReportBuilder& report, const SceneValues& scene) {
  std::string changed;
  for (const Setting& setting : scene.settings) {
    const bool has_own_line =
        setting.key == "title" || setting.key.starts_with("grid.") || setting.key.starts_with("accuracy.");
    if (!has_own_line) changed += (changed.empty() ? "" : ", ") + setting.text();
  }
  report.line("{}", key("title", scene.title));
  report.row_if(!changed.empty(), "changed", "{}", key("changed", changed));
}

std::string model_change_text(const ModelChange& change) {
  return fmt::format(
      "light that single scattering loses, or that the masking creates, changes I by up to about {:.2g} % and DOLP by "
      "up to about {:.2g} points",
      kPercent * change.i, change.dolp_points);
}

void add_direct_emission(ReportBuilder& report, const SceneModel& scene, const ModelChange& change) {
  const bool is_direct = scene.emission && scene.emission->model == EmissionModel::kDirect;
  const bool is_known = !scene.surface.has_only_direct();
  report.row_if(is_direct, "emission", "direct: leaves out what one facet emits and another reflects{}",
                is_known ? fmt::format(", up to {:.2g} % of I", kPercent * change.i)
                         : "; how much is not computed for smith with slopes along and across");
}

ReportBuilder run_report(const SceneValues& scene, const RunOutcome& run, const std::optional<ScatteringGap>& gap,
                         const std::string& shape, const std::string& path) {
  const RunSummary& summary = run.summary;
  ReportBuilder report;
  add_title(report, scene);
  report.row("entries", "{}", key("shape", shape));
  report.value("entries", summary.entries);
  add_effects(report, run);
  add_evaluation(report, run.evaluation, run.wall_s);
  add_times(report, run);
  add_work(report, run.evaluation, summary.entries);
  report.value("rule", rule_text(scene.accuracy.tolerance, run.evaluation));
  add_errors(report, run, scene.accuracy.tolerance);
  const bool lacks_double = scene.accuracy.precision == Precision::kAuto && run.evaluation.evaluator == "vulkan" &&
                            run.evaluation.precision == "float" && scene.accuracy.tolerance < kLeastFloatTolerance;
  report.row_if(lacks_double, "warning", "the device has no double precision: tolerances below {:g} are out of reach",
                kLeastFloatTolerance);
  report.row_if(summary.check.entries > 0, "checked",
                "{} entries by a rule of another kind: largest difference {:.2g} of the bounds{}",
                key("self_check/entries", summary.check.entries),
                key("self_check/worst_ratio", summary.check.worst_ratio),
                summary.check.worst_ratio > 1.0 ? "; a bound failed, see status 2" : "");
  report.row_if(gap.has_value(), "scattering",
                "single; the model of direct emission differs by up to {:.2g} points of DOLP, the largest of {}",
                kPoints * (gap ? gap->dolp : 0.0), gap ? gap->looked.text() : "");
  report.value("scattering_gap", gap ? std::optional(gap->dolp) : std::nullopt);
  add_status(report, summary);
  report.row_if(summary.count(kModelInaccurate) > 0, "model", "{}", model_change_text(summary.model_change));
  report.row_if(summary.count(kModelInaccurate) > 0, "", "{}", model_advice(scene));
  report.values({{"model_change", summary.model_change.i}, {"model_change_dolp", summary.model_change.dolp_points}});
  add_direct_emission(report, scene, summary.model_change);
  add_energy(report, summary, run.plan.gives_albedo);
  const EvaluationReport& evaluation = run.evaluation;
  const bool is_faster_on_cpu =
      evaluation.evaluator == "vulkan" && evaluation.evaluations < kFewEvaluations && evaluation.setup_s > 0.0;
  report.row_if(is_faster_on_cpu, "hint", "the evaluator cpu has no device to set up and is faster for so little");
  report.row("written", "{}", key("output", path));
  return report;
}

void add_evaluation(ReportBuilder& report, const EvaluationReport& e, double wall_s) {
  const bool is_idle = e.device == "none";
  report.row_if(is_idle, "device", "none: nothing is integrated");
  report.row_if(!is_idle, "device", "{}{}{}, {} precision", key("device", e.device), e.driver.empty() ? "" : ", ",
                key("driver", e.driver), key("precision", e.precision));
  if (e.arithmetic) {
    report.row_if(roundoff_growth(*e.arithmetic) > 1.0, "arithmetic", "{}", arithmetic_text(*e.arithmetic));
    report.value("arithmetic", arithmetic_json(*e.arithmetic));
  }
  report.row_if(e.devices_lost > 0, "lost", "{} times a device, and began again on a new one",
                key("devices_lost", e.devices_lost));
  report.row("time", "{:.3f} s in all, {:.3f} s in kernels, {} dispatches", key("wall_s", wall_s),
             key("kernel_s", e.kernel_s), key("dispatches", e.dispatches));
  report.row_if(e.beams_s > 0.0, "", "{:.3f} s in beams, which the host computes", key("beams_s", e.beams_s));
  report.values({{"evaluator", e.evaluator}});
  report.row_if(e.evaluator == "vulkan", "of that",
                "{:.3f} s to start the driver, {:.3f} s to make kernels, {:.3f} s in sums of the host",
                e.setup_s - e.pipelines_s, key("pipelines_s", e.pipelines_s), key("sums_s", e.sums_s));
  report.values({{"setup_s", e.setup_s}});
}

}  // namespace dolp
