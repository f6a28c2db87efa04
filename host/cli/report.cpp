#include "cli/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace dolp::cli {
namespace {

constexpr std::uint32_t kNoDolpStatement =
    kStatusUnphysicalReflectance | kStatusOutsideDomain | kStatusNonPositiveIntensity;

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

void add_ranges(RunReport& report, const std::vector<PointResult>& results) {
  report.albedo_min = std::numeric_limits<double>::infinity();
  report.albedo_max = -std::numeric_limits<double>::infinity();
  for (const PointResult& r : results) {
    if ((r.status & kNoDolpStatement) == 0) report.worst_error = std::max(report.worst_error, r.error_estimate);
    if ((r.status & kStatusOutsideDomain) == 0) {
      report.worst_rho_error = std::max(report.worst_rho_error, r.rho_error_estimate);
    }
    if (std::isnan(r.albedo)) continue;
    report.albedo_min = std::min(report.albedo_min, r.albedo);
    report.albedo_max = std::max(report.albedo_max, r.albedo);
    if (r.albedo < kAlbedoMin || r.albedo > kAlbedoMax) ++report.energy_off;
  }
}

std::string energy_text(const RunReport& report) {
  if (report.energy_off == 0) return fmt::format("within {}..{} everywhere", kAlbedoMin, kAlbedoMax);
  return fmt::format(
      "outside {}..{} in {} of {} entries (range {:.3g}..{:.3g}): there the surface model itself gains or "
      "loses energy",
      kAlbedoMin, kAlbedoMax, report.energy_off, report.entries, report.albedo_min, report.albedo_max);
}

}  // namespace

RunReport make_report(const Scene& scene, const std::vector<PointResult>& results, const EvaluationReport& evaluation,
                      double wall_s) {
  RunReport report;
  report.title = scene.title;
  report.entries = results.size();
  report.tolerance = scene.accuracy.tolerance;
  report.wall_s = wall_s;
  report.evaluation = evaluation;
  report.status = count_status(results);
  for (const RunReport::StatusCount& status : report.status) {
    if (status.bit == kStatusToleranceMissed) report.missed_tolerance = status.count;
  }
  add_ranges(report, results);
  return report;
}

std::string rule_text(double tolerance) {
  return fmt::format(
      "product Gauss rules on the smooth pieces of slope and azimuth, orders for tolerance {:g}, compared "
      "with three quarters of the nodes",
      tolerance);
}

std::string summary_text(const RunReport& report) {
  const EvaluationReport& e = report.evaluation;
  const double per_entry = report.entries > 0 ? e.evaluations / static_cast<double>(report.entries) : 0.0;
  std::string text;
  text += fmt::format("{}\n", report.title);
  text += fmt::format("  entries    {}\n", report.shape);
  text +=
      fmt::format("  device     {}{}{}, {} precision\n", e.device, e.driver.empty() ? "" : ", ", e.driver, e.precision);
  text += fmt::format("  time       {:.3f} s in all, {:.3f} s in kernels, {} dispatches\n", report.wall_s, e.kernel_s,
                      e.dispatches);
  text += fmt::format("  work       {:.4g} integrand evaluations, {:.0f} an entry\n", e.evaluations, per_entry);
  text += fmt::format("  error      DOLP <= {:.2g} (absolute), rho <= {:.2g} (of rho_I); tolerance {:g}\n",
                      report.worst_error, report.worst_rho_error, report.tolerance);
  for (const RunReport::StatusCount& status : report.status) {
    text +=
        fmt::format("  status {}   {} of {} entries: {}\n", status.bit, status.count, report.entries, status.meaning);
  }
  text += fmt::format("  albedo     {}\n", energy_text(report));
  text += fmt::format("  written    {}\n", report.output);
  return text;
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
  json["rule"] = rule_text(report.tolerance);
  json["tolerance"] = report.tolerance;
  json["dispatches"] = e.dispatches;
  json["evaluations"] = e.evaluations;
  json["wall_s"] = report.wall_s;
  json["kernel_s"] = e.kernel_s;
  json["setup_s"] = e.setup_s;
  json["worst_error_estimate"] = report.worst_error;
  json["worst_rho_error_estimate"] = report.worst_rho_error;
  for (const RunReport::StatusCount& status : report.status) {
    json["status"].push_back({{"bit", status.bit}, {"meaning", status.meaning}, {"count", status.count}});
  }
  json["albedo"] = {{"min", report.albedo_min}, {"max", report.albedo_max}, {"entries_off", report.energy_off}};
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
