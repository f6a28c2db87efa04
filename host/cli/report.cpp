#include "cli/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "model/status.hpp"
#include "run/scene_table.hpp"

namespace dolp::cli {
namespace {

std::vector<RunReport::StatusCount> count_status(const std::vector<PointResult>& results) {
  std::vector<RunReport::StatusCount> counts = {{"reflectance outside [0, 1]", kStatusUnphysicalReflectance, 0},
                                                {"tolerance not met", kStatusToleranceMissed, 0},
                                                {"outside the model's domain", kStatusOutsideDomain, 0},
                                                {"intensity not positive", kStatusNonPositiveIntensity, 0}};
  for (RunReport::StatusCount& status : counts) {
    status.count = static_cast<std::size_t>(std::count_if(
        results.begin(), results.end(), [&](const PointResult& r) { return (r.status & status.bit) != 0; }));
  }
  return counts;
}

void add(EnergyRange& range, double theta_deg, double sigma) {
  const bool is_first = range.entries++ == 0;
  const auto widen = [is_first](double& low, double& high, double value) {
    low = is_first ? value : std::min(low, value);
    high = is_first ? value : std::max(high, value);
  };
  widen(range.theta_min_deg, range.theta_max_deg, theta_deg);
  widen(range.sigma_min, range.sigma_max, sigma);
}

void add_ranges(RunReport& report, const Scene& scene, const SceneEntries& entries,
                const std::vector<PointResult>& results) {
  report.albedo_min = std::numeric_limits<double>::infinity();
  report.albedo_max = -std::numeric_limits<double>::infinity();
  const bool bistatic = scene.geometry.mode == Mode::kBistatic;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const PointResult& r = results[i];
    if (promises_dolp(r.status)) report.worst_error = std::max(report.worst_error.value_or(0.0), r.error_estimate);
    if ((r.status & kStatusOutsideDomain) == 0 && report.plan.gives_rho) {
      report.worst_rho_error = std::max(report.worst_rho_error.value_or(0.0), r.rho_error_estimate);
    }
    if (std::isnan(r.albedo)) continue;
    report.albedo_min = std::min(report.albedo_min, r.albedo);
    report.albedo_max = std::max(report.albedo_max, r.albedo);
    if (r.albedo >= kAlbedoMin && r.albedo <= kAlbedoMax) continue;
    const SceneEntry entry = entries[i];
    const double theta_deg = bistatic ? scene.geometry.view_zenith_deg : entry.theta_deg;
    add(r.albedo < kAlbedoMin ? report.loses : report.gains, theta_deg, entry.shape.sigma);
  }
}

std::string range_text(const EnergyRange& range) {
  return fmt::format("{} entries, theta {:g}..{:g}, sigma {:.4g}..{:.4g}", range.entries, range.theta_min_deg,
                     range.theta_max_deg, range.sigma_min, range.sigma_max);
}

std::string bound_text(const std::optional<double>& bound) {
  return bound ? fmt::format("<= {:.2g}", *bound) : "not promised for any entry";
}

nlohmann::ordered_json number_or_null(const std::optional<double>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json range_json(const EnergyRange& range) {
  return {{"entries", range.entries},
          {"theta_deg", {range.theta_min_deg, range.theta_max_deg}},
          {"sigma", {range.sigma_min, range.sigma_max}}};
}

/// Over which part of the grid the surface model itself gains or loses energy.
std::string energy_text(const RunReport& report) {
  if (!report.plan.needs_moments) return "  albedo     not computed: nothing kept depends on it\n";
  if (report.albedo_min > report.albedo_max) return "  albedo     not given for any entry\n";
  std::string text = fmt::format("  albedo     {:.3g}..{:.3g}", report.albedo_min, report.albedo_max);
  if (report.loses.entries + report.gains.entries == 0) return text + "\n";
  text += ": the surface model itself does not keep the energy\n";
  if (report.loses.entries > 0) {
    text += fmt::format("    loses it (below {}): {}\n", kAlbedoMin, range_text(report.loses));
  }
  if (report.gains.entries > 0) {
    text += fmt::format("    gains it (above {}): {}\n", kAlbedoMax, range_text(report.gains));
  }
  return text;
}

/// What is kept, and a line for each effect that is dropped.
std::string effects_lines(const RunReport& report) {
  std::string kept;
  std::string dropped;
  for (const EffectRow& row : report.effects) {
    if (row.state == EffectState::kKept) kept += (kept.empty() ? "" : ", ") + std::string(row.name);
    if (row.state == EffectState::kDropped) dropped += fmt::format("  dropped    {}: {}\n", row.name, row.reason);
  }
  return fmt::format("  kept       {}{}\n", kept.empty() ? "nothing" : kept,
                     report.plan.keep_all ? " (--keep-all)" : "") +
         dropped;
}

std::string device_line(const EvaluationReport& e) {
  if (e.device == "none") return "  device     none: nothing is integrated\n";
  return fmt::format("  device     {}{}{}, {} precision\n", e.device, e.driver.empty() ? "" : ", ", e.driver,
                     e.precision);
}

}  // namespace

RunReport make_report(const Scene& scene, const SceneEntries& entries, const std::vector<PointResult>& results,
                      const EffectPlan& plan, const EvaluationReport& evaluation, double wall_s) {
  RunReport report;
  report.title = scene.title;
  report.entries = results.size();
  report.tolerance = scene.accuracy.tolerance;
  report.wall_s = wall_s;
  report.plan = plan;
  report.effects = effect_rows(scene, entries, plan);
  report.evaluation = evaluation;
  report.status = count_status(results);
  for (const RunReport::StatusCount& status : report.status) {
    if (status.bit == kStatusToleranceMissed) report.missed_tolerance = status.count;
  }
  add_ranges(report, scene, entries, results);
  return report;
}

std::string summary_text(const RunReport& report) {
  const EvaluationReport& e = report.evaluation;
  const double per_entry = report.entries > 0 ? e.evaluations / static_cast<double>(report.entries) : 0.0;
  std::string text;
  text += fmt::format("{}\n", report.title);
  text += fmt::format("  entries    {}\n", report.shape);
  text += effects_lines(report);
  text += device_line(e);
  text += fmt::format("  time       {:.3f} s in all, {:.3f} s in kernels, {} dispatches\n", report.wall_s, e.kernel_s,
                      e.dispatches);
  text += fmt::format("  work       {:.4g} integrand evaluations, {:.0f} an entry\n", e.evaluations, per_entry);
  if (e.interpolated > 0) {
    text += fmt::format("  of these   {} moments interpolated between slope distributions, from {}\n", e.interpolated,
                        e.interpolation_nodes);
  }
  const std::string rho =
      report.plan.gives_rho ? fmt::format("rho {} (of rho_I)", bound_text(report.worst_rho_error)) : "rho not computed";
  text += fmt::format("  error      DOLP {} (absolute), {}; tolerance {:g}\n", bound_text(report.worst_error), rho,
                      report.tolerance);
  for (const RunReport::StatusCount& status : report.status) {
    text +=
        fmt::format("  status {}   {} of {} entries: {}\n", status.bit, status.count, report.entries, status.meaning);
  }
  text += energy_text(report);
  text += fmt::format("  written    {}\n", report.output);
  return text;
}

nlohmann::ordered_json effects_json(const std::vector<EffectRow>& effects, const EffectPlan& plan) {
  nlohmann::ordered_json json = {{"kept", nlohmann::ordered_json::array()},
                                 {"dropped", nlohmann::ordered_json::array()},
                                 {"not_needed", nlohmann::ordered_json::array()},
                                 {"absent", nlohmann::ordered_json::array()}};
  for (const EffectRow& row : effects) {
    nlohmann::ordered_json of_row = {{"name", row.name}, {"reason", row.reason}};
    if (row.state == EffectState::kDropped) of_row["bound"] = row.bound.value_or(0.0);
    json[state_name(row.state)].push_back(of_row);
  }
  json["keep_all"] = plan.keep_all;
  json["allowed_share_of_tolerance"] = kDroppedShare;
  json["dolp_bound"] = plan.bound.dolp;
  json["rho_bound"] = plan.bound.rho;
  return json;
}

nlohmann::ordered_json summary_json(const RunReport& report) {
  const EvaluationReport& e = report.evaluation;
  nlohmann::ordered_json json;
  json["title"] = report.title;
  json["output"] = report.output;
  json["entries"] = report.entries;
  json["shape"] = report.shape;
  json["evaluator"] = e.evaluator;
  json["device"] = e.device;
  json["driver"] = e.driver;
  json["precision"] = e.precision;
  json["effects"] = effects_json(report.effects, report.plan);
  json["rule"] = rule_text(report.tolerance, e);
  json["tolerance"] = report.tolerance;
  json["dispatches"] = e.dispatches;
  json["evaluations"] = e.evaluations;
  json["interpolated_moments"] = e.interpolated;
  json["interpolation_nodes"] = e.interpolation_nodes;
  json["wall_s"] = report.wall_s;
  json["kernel_s"] = e.kernel_s;
  json["setup_s"] = e.setup_s;
  json["worst_error_estimate"] = number_or_null(report.worst_error);
  json["worst_rho_error_estimate"] = number_or_null(report.worst_rho_error);
  for (const RunReport::StatusCount& status : report.status) {
    json["status"].push_back({{"bit", status.bit}, {"meaning", status.meaning}, {"count", status.count}});
  }
  json["albedo"] = nullptr;
  if (report.albedo_min > report.albedo_max) return json;
  json["albedo"] = {{"min", report.albedo_min},
                    {"max", report.albedo_max},
                    {"loses_energy", range_json(report.loses)},
                    {"gains_energy", range_json(report.gains)}};
  return json;
}

void print_report(const RunReport& report, bool json, bool quiet) {
  std::FILE* out = report.output == "-" ? stderr : stdout;
  if (json) {
    fmt::print(out, "{}\n", summary_json(report).dump(2));
  } else if (!quiet) {
    fmt::print(out, "{}", summary_text(report));
  }
}

}  // namespace dolp::cli
