#include "report/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <dolp/errors.hpp>
#include "base/numbers.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "report/run_report.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostFailureLines = 20;

std::string position_text(const std::vector<AxisValue>& position) {
  std::vector<std::string> texts;
  for (const auto& [axis, number, label] : position)
    texts.push_back(fmt::format("{} {}", describe(axis).name, label.empty() ? fmt::format("{:g}", number) : label));
  return fmt::format("{}", fmt::join(texts, ", "));
}

void add_position(ReportBuilder::Json& json, const std::vector<AxisValue>& position) {
  for (const auto& [axis, number, label] : position) {
    ReportBuilder::Json& coordinate = json[describe(axis).column];
    label.empty() ? coordinate = number : coordinate = label;
  }
}

ReportBuilder::Json value_json(const CheckedValue& value) {
  ReportBuilder::Json json = {{"quantity", value.quantity}};
  add_position(json, value.position);
  json.update({{"stored", value.stored},
               {"reference", value.reference},
               {"error", value.error()},
               {"stated", value.stated},
               {"reference_error", value.reference_error},
               {"complaint", value.complaint}});
  return json;
}

ReportBuilder quantity_report(const QuantityCheck& check) {
  const CheckedValue& worst = check.worst;
  ReportBuilder report;
  const auto note = [](std::size_t count, std::string_view text) {
    return count > 0 ? fmt::format("; {} for {} of them", text, count) : "";
  };
  report.row(check.name, "{} compared, worst: error {:.2e} of {:.2e} stated, at {}{}{}",
             key("compared", check.compared), worst.error(), worst.stated, position_text(worst.position),
             note(check.unstated, "nothing stated"),
             note(check.undecided, "undecided, as the reference is less accurate,"));
  report.values({{"name", check.name},
                 {"unstated", check.unstated},
                 {"undecided", check.undecided},
                 {"worst", value_json(worst)}});
  return report;
}

void add_failures(ReportBuilder& report, const std::vector<CheckedValue>& failures) {
  ReportBuilder::Json list = ReportBuilder::Json::array();
  for (const CheckedValue& value : failures) {
    report.row_if(list.size() < kMostFailureLines, "wrong",
                  "{} at {} {}: {:.10g} is stored, {:.10g} is right, error {:.2e}, stated {:.2e}", value.quantity,
                  position_text(value.position), value.complaint, value.stored, value.reference, value.error(),
                  value.stated);
    list.push_back(value_json(value));
  }
  report.row_if(list.size() > kMostFailureLines, "wrong", "and {} more", list.size() - kMostFailureLines);
  report.value("failures", list);
}

std::string table_verdict(const TableCheck& check) {
  std::size_t undecided = 0;
  for (const QuantityCheck& quantity : check.quantities) undecided += quantity.undecided;
  if (check.passed() && undecided > 0) {
    return fmt::format(
        "passed: {} of {} entries, no error beyond what the table and the reference state; {} values are "
        "undecided, because the reference is less accurate there than the table says of itself",
        check.checked, check.entries, undecided);
  }
  if (check.passed()) {
    return fmt::format("passed: {} of {} entries, every error within what the table states", check.checked,
                       check.entries);
  }
  return fmt::format("failed: {} values of {} entries are wrong", check.failures.size(), check.checked);
}

ReportBuilder case_report(const CaseOutcome& outcome) {
  const StoredCase& stored = outcome.stored;
  const std::string verdict = !outcome.complaint.empty()   ? "WRONG: " + outcome.complaint
                              : outcome.misses_tolerance() ? "says it misses the tolerance"
                                                           : "ok";
  ReportBuilder report;
  report.line("    {:<31} rho {:.1e} of {:.1e}  dolp {:.1e} of {:.1e}  {}", key("case", stored.name),
              key("rho/error", outcome.rho.error), key("rho/estimate", outcome.rho.estimate),
              key("dolp/error", outcome.dolp.error), key("dolp/estimate", outcome.dolp.estimate), verdict);
  report.value("rho/reference_error", outcome.rho.reference);
  report.value("dolp/reference_error", outcome.dolp.reference);
  report.values({{"distribution", to_name(stored.distribution)},
                 {"masking", to_name(stored.masking)},
                 {"theta_deg", stored.theta_deg},
                 {"sigma", stored.shape.sigma},
                 {"q", stored.shape.q},
                 {"n", stored.index.n},
                 {"k", stored.index.k},
                 {"status", outcome.status},
                 {"ok", outcome.complaint.empty()},
                 {"complaint", outcome.complaint},
                 {"origin", stored.origin}});
  return report;
}

void add_group(ReportBuilder& report, const char* precision, const std::vector<const CaseOutcome*>& group) {
  const CaseOutcome& worst = **std::ranges::max_element(group, {}, &CaseOutcome::worst_ratio);
  const bool is_rho = worst.rho.ratio() >= worst.dolp.ratio() || std::isinf(worst.dolp.estimate);
  const ErrorCheck& check = is_rho ? worst.rho : worst.dolp;
  report.line("  {:<6} {:<8} {:<8} {} cases, {} say they miss; nearest to its estimate: {} of {}, {:.1e} of {:.1e}",
              precision, to_name(worst.stored.distribution), to_name(worst.stored.masking), group.size(),
              std::ranges::count_if(group, &CaseOutcome::misses_tolerance), is_rho ? "rho" : "dolp", worst.stored.name,
              check.error, check.estimate);
}

bool is_wrong(const CaseOutcome& outcome) { return !outcome.complaint.empty(); }

ReportBuilder precision_report(const PrecisionCheck& check, bool shows_all) {
  const EvaluationReport& e = check.evaluation;
  std::map<std::pair<Distribution, Masking>, std::vector<const CaseOutcome*>> groups;
  ReportBuilder::Json list = ReportBuilder::Json::array();
  for (const CaseOutcome& outcome : check.outcomes) {
    groups[{outcome.stored.distribution, outcome.stored.masking}].push_back(&outcome);
    list.push_back(case_report(outcome).json());
  }
  ReportBuilder report;
  for (const auto& [key, group] : groups) {
    add_group(report, e.precision.c_str(), group);
    for (const CaseOutcome* outcome : group) {
      if (shows_all || is_wrong(*outcome)) report.show(case_report(*outcome));
    }
  }
  report.values({{"precision", e.precision},
                 {"evaluator", e.evaluator},
                 {"device", e.device},
                 {"driver", e.driver},
                 {"failures", std::ranges::count_if(check.outcomes, is_wrong)},
                 {"kernel_s", e.kernel_s},
                 {"cases", list}});
  return report;
}

/// The tolerance with which ordinary cases are computed: near the best accuracy that float or double can reach.
double tolerance_in(Precision precision) { return precision == Precision::kDouble ? 1e-9 : 1e-6; }

struct Quality {
  Precision precision;
  std::string why_not;
  std::vector<CaseOutcome> outcomes = {};
  std::optional<Arithmetic> arithmetic = {};
};

Quality quality_in(const Device& device, std::size_t position, Precision precision) {
  const bool in_double = precision == Precision::kDouble;
  Quality quality{precision, device.usable ? "" : "the device is not usable"};
  if (in_double && !device.has_double) quality.why_not = "the device has no double precision (shaderFloat64)";
  if (!quality.why_not.empty()) return quality;
  try {
    VulkanOptions options;
    options.device = std::to_string(position);
    options.needs_double = in_double;
    VulkanEvaluator evaluator(options);
    quality.outcomes = qualify(ordinary_cases(), evaluator, {tolerance_in(precision), precision}, {});
    quality.arithmetic = evaluator.report().arithmetic;
  } catch (const DeviceError& error) {
    quality.why_not = error.what();
  }
  return quality;
}

ReportBuilder quality_report(const Quality& quality) {
  ReportBuilder report;
  if (quality.outcomes.empty()) {
    report.line("   {:<6} not measured: {}", to_name(quality.precision), key("why_not", quality.why_not));
    return report;
  }
  const auto outcome_error = [](const CaseOutcome& outcome) {
    return std::isnan(outcome.rho.error) ? kInfinity : outcome.rho.error;
  };
  const CaseOutcome& worst = *std::ranges::max_element(quality.outcomes, {}, outcome_error);
  const auto missed = std::ranges::count_if(quality.outcomes, &CaseOutcome::misses_tolerance);
  const bool is_sound = std::ranges::none_of(quality.outcomes, is_wrong);
  report.line(
      "   {:<6} true error of rho at most {:.1e} in {} ordinary cases; with tolerance {:g}, {} of them get status 2 or "
      "16, because the stated bound, larger than the error, misses it{}",
      to_name(quality.precision), key("worst_rho_error", worst.rho.error), key("cases", quality.outcomes.size()),
      key("tolerance", tolerance_in(quality.precision)), key("missed_tolerance", missed),
      is_sound ? "" : "; SOME ERRORS EXCEED THEIR ESTIMATES, see dolp verify --hard-cases");
  const StoredCase& stored = worst.stored;
  report.value("worst_case",
               fmt::format("{} {} {}", to_name(stored.distribution), to_name(stored.masking), stored.name));
  report.value("sound", is_sound);
  if (quality.arithmetic) {
    report.line("          {}", arithmetic_text(*quality.arithmetic));
    report.value("arithmetic", arithmetic_json(*quality.arithmetic));
  }
  return report;
}

ReportBuilder device_report(const Device& device, std::size_t position) {
  const Quality in_float = quality_in(device, position, Precision::kFloat);
  Device examined = device;  // its kernels may fail although the driver calls the device usable
  if (device.usable) examined.why_not = in_float.why_not;
  examined.usable = examined.why_not.empty();
  const Quality in_double = quality_in(examined, position, Precision::kDouble);
  ReportBuilder report;
  report.line("{}: {} ({})", key("index", position), key("name", device.name), type_name(device.type));
  report.line("   {}, Vulkan {}", key("driver", device.driver), key("api_version", device.api_version));
  report.line("   {}{}", examined.usable ? "usable" : "not usable: ", key("why_not", examined.why_not));
  report.line(
      "   double precision {}{}, storage buffer {:.0f} MiB, heap {:.0f} MiB, {} workgroups, subgroup {}, timestamps {}",
      device.has_double ? "yes" : "no",
      device.has_double ? "" : fmt::format(" (tolerances below {:g} are out of reach)", kLeastFloatTolerance),
      static_cast<double>(device.max_storage_buffer_bytes) / kMebibyte,
      static_cast<double>(device.memory_bytes) / kMebibyte, key("max_workgroups", device.max_workgroups),
      key("subgroup_size", device.subgroup_size), device.timestamps ? "yes" : "no");
  report.values({{"type", type_name(device.type)},
                 {"usable", examined.usable},
                 {"float64", device.has_double},
                 {"max_storage_buffer_bytes", device.max_storage_buffer_bytes},
                 {"heap_bytes", device.memory_bytes},
                 {"timestamps", device.timestamps}});
  for (const Quality& quality : {in_float, in_double}) {
    report.add((std::string("quality/") + to_name(quality.precision)).c_str(), quality_report(quality));
  }
  return report;
}

}  // namespace

ReportBuilder between_report(const std::vector<InterpolationError>& errors, std::size_t points, const std::string& path,
                             const std::string& title) {
  ReportBuilder report;
  report.line("{}{}", key("table", path), title.empty() ? "" : ": " + title);
  report.line("errors of interpolation at {} random points between the entries", key("points", points));
  std::vector<ReportBuilder> rows;
  for (const InterpolationError& found : errors) {
    ReportBuilder& row = rows.emplace_back();
    const ErrorSummary& error = found.error;
    row.row(describe(found.quantity).name, "{:<6} median {:.1e}, 95 % {:.1e}, largest {:.1e}{}",
            key("method", found.method), key("median", error.median), key("p95", error.p95),
            key("largest", error.largest), found.at.empty() ? "" : " at " + position_text(found.at));
    ReportBuilder::Json at = ReportBuilder::Json::object();
    add_position(at, found.at);
    row.values({{"quantity", describe(found.quantity).name}, {"compared", error.compared}, {"at", at}});
  }
  report.add("between", rows);
  return report;
}

ReportBuilder table_report(const TableCheck& check, const std::string& path, const std::string& title,
                           std::uint64_t seed, double wall_s) {
  ReportBuilder report;
  report.line("{}: {}", key("table", path), key("title", title));
  report.row(
      "checked",
      "{} of {} entries (seed {}) against the reference, {:.1f} s; tolerance {:g}, {} of them miss it and say so",
      key("checked", check.checked), key("entries", check.entries), key("seed", seed), key("wall_s", wall_s),
      key("tolerance", check.tolerance), key("missed_tolerance", check.missed));
  std::vector<ReportBuilder> quantities;
  for (const QuantityCheck& quantity : check.quantities) quantities.push_back(quantity_report(quantity));
  report.add("quantities", quantities);
  add_failures(report, check.failures);
  report.row("verdict", "{}", key("verdict", table_verdict(check)));
  report.value("passed", check.passed());
  return report;
}

ReportBuilder hard_case_report(const std::vector<PrecisionCheck>& checks, const DeviceCheckOptions& options,
                               const std::string& left_out) {
  const EvaluationReport& e = checks.front().evaluation;
  ReportBuilder report(0);
  report.line("{} hard cases, tolerance {:g}", key("cases", checks.front().outcomes.size()),
              key("tolerance", options.tolerance));
  report.row("device", "{}{}{}", e.device, e.driver.empty() ? "" : ", ", e.driver);
  std::vector<ReportBuilder> precisions;
  std::ptrdiff_t failures = 0;
  for (const PrecisionCheck& check : checks) {
    precisions.push_back(precision_report(check, options.all));
    failures += std::ranges::count_if(check.outcomes, is_wrong);
  }
  report.add("precisions", precisions);
  if (!left_out.empty()) report.line("  {}", left_out);
  const std::string verdict = failures == 0 ? "passed: every error is below its estimate, every miss is reported"
                                            : fmt::format("failed: {} cases are wrong", failures);
  report.row("verdict", "{}", key("verdict", verdict));
  report.values({{"left_out", left_out}, {"failures", failures}, {"passed", failures == 0}});
  return report;
}

ReportBuilder device_report(const DeviceList& list) {
  std::vector<ReportBuilder> devices;
  for (std::size_t i = 0; i < list.devices.size(); ++i) devices.push_back(device_report(list.devices[i], i));
  ReportBuilder report;
  report.add("devices", devices);
  report.value("why_empty", list.why_empty);
  return report;
}

}  // namespace dolp
