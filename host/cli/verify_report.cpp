#include "cli/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "evaluate/radiometry/status.hpp"
#include "scene/names.hpp"

namespace dolp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostFailureLines = 20;

/// JSON has no infinity and no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string place(const CheckedValue& value) {
  return fmt::format("theta {:g}, sigma {:g}, q {:g}", value.theta_deg, value.sigma, value.q);
}

std::string quantity_line(const QuantityCheck& check) {
  const CheckedValue& worst = check.worst;
  const std::string unstated =
      check.unstated > 0 ? fmt::format("; nothing stated for {} of them", check.unstated) : std::string{};
  return fmt::format("  {:<10} {} compared, worst: error {:.2e} of {:.2e} stated, at {}{}\n", check.name,
                     check.compared, worst.error(), worst.stated, place(worst), unstated);
}

std::string failure_line(const CheckedValue& value) {
  return fmt::format("  wrong      {} at {} {}: {:.10g} is stored, {:.10g} is right, error {:.2e}, stated {:.2e}\n",
                     value.quantity, place(value), value.complaint, value.stored, value.reference, value.error(),
                     value.stated);
}

Json value_json(const CheckedValue& value) {
  return {{"quantity", value.quantity},
          {"theta_deg", value.theta_deg},
          {"sigma", value.sigma},
          {"q", value.q},
          {"stored", number(value.stored)},
          {"reference", number(value.reference)},
          {"error", number(value.error())},
          {"stated", number(value.stated)},
          {"reference_error", number(value.reference_error)},
          {"complaint", value.complaint}};
}

std::string table_verdict(const TableCheck& check) {
  if (check.passed()) {
    return fmt::format("passed: {} of {} entries, every error within what the table states", check.checked,
                       check.entries);
  }
  return fmt::format("failed: {} values of {} entries are wrong", check.failures.size(), check.checked);
}

/// The part of a case that is nearest to its bound.
struct Worst {
  const char* quantity;
  ErrorCheck check;
};
Worst worst_of(const CaseOutcome& outcome) {
  const bool is_rho = outcome.rho.ratio() >= outcome.dolp.ratio() || std::isinf(outcome.dolp.estimate);
  return is_rho ? Worst{"rho", outcome.rho} : Worst{"dolp", outcome.dolp};
}

bool is_missed(const CaseOutcome& outcome) { return (outcome.status & kStatusToleranceMissed) != 0; }

std::string case_line(const StoredCase& stored, const CaseOutcome& outcome) {
  const std::string verdict = !outcome.complaint.empty() ? "WRONG: " + outcome.complaint
                              : is_missed(outcome)       ? "says it misses the tolerance"
                                                         : "ok";
  return fmt::format("    {:<31} rho {:.1e} of {:.1e}  dolp {:.1e} of {:.1e}  {}\n", stored.name, outcome.rho.error,
                     outcome.rho.estimate, outcome.dolp.error, outcome.dolp.estimate, verdict);
}

std::string group_text(const HardCaseReport& report, const PrecisionReport& precision,
                       const std::vector<std::size_t>& positions, bool all) {
  const auto outcome_at = [&](std::size_t i) -> const CaseOutcome& { return precision.outcomes[i]; };
  const std::size_t worst =
      *std::ranges::max_element(positions, {}, [&](std::size_t i) { return outcome_at(i).worst_ratio(); });
  const auto missed = std::ranges::count_if(positions, [&](std::size_t i) { return is_missed(outcome_at(i)); });
  const StoredCase& first = report.cases[positions.front()];
  const Worst part = worst_of(outcome_at(worst));
  std::string text = fmt::format(
      "  {:<6} {:<8} {:<8} {} cases, {} say they miss; nearest to its estimate: {} of {}, {:.1e} of {:.1e}\n",
      precision.evaluation.precision, name_of(first.distribution), name_of(first.masking), positions.size(), missed,
      part.quantity, report.cases[worst].name, part.check.error, part.check.estimate);
  for (const std::size_t i : positions) {
    if (all || !outcome_at(i).complaint.empty()) text += case_line(report.cases[i], outcome_at(i));
  }
  return text;
}

std::string precision_text(const HardCaseReport& report, const PrecisionReport& precision, bool all) {
  std::map<std::pair<Distribution, Masking>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    groups[{report.cases[i].distribution, report.cases[i].masking}].push_back(i);
  }
  std::string text;
  for (const auto& [group, positions] : groups) text += group_text(report, precision, positions, all);
  return text;
}

Json check_json(const ErrorCheck& check) {
  return {{"error", number(check.error)},
          {"estimate", number(check.estimate)},
          {"reference_error", number(check.reference)}};
}

Json case_json(const StoredCase& stored, const CaseOutcome& outcome) {
  return {{"case", stored.name},
          {"distribution", name_of(stored.distribution)},
          {"masking", name_of(stored.masking)},
          {"theta_deg", stored.theta_deg},
          {"sigma", stored.shape.sigma},
          {"q", stored.shape.q},
          {"n", stored.index.n},
          {"k", stored.index.k},
          {"rho", check_json(outcome.rho)},
          {"dolp", check_json(outcome.dolp)},
          {"status", outcome.status},
          {"ok", outcome.complaint.empty()},
          {"complaint", outcome.complaint},
          {"origin", stored.origin}};
}

std::string hard_case_verdict(const HardCaseReport& report) {
  if (report.precisions.empty()) return "nothing was examined";
  return report.failures() == 0 ? "passed: every error is below its estimate, every miss is reported"
                                : fmt::format("failed: {} cases are wrong", report.failures());
}

}  // namespace

std::string table_text(const TableReport& report) {
  const TableCheck& check = report.check;
  std::string text = fmt::format("{}: {}\n", report.path, report.title);
  text += fmt::format(
      "  checked    {} of {} entries (seed {}) against the reference, {:.1f} s; tolerance {:g}, {} of them miss "
      "it and say so\n",
      check.checked, check.entries, report.options.seed, report.wall_s, check.tolerance, check.missed);
  for (const QuantityCheck& quantity : check.quantities) text += quantity_line(quantity);
  for (std::size_t i = 0; i < std::min(kMostFailureLines, check.failures.size()); ++i) {
    text += failure_line(check.failures[i]);
  }
  if (check.failures.size() > kMostFailureLines) {
    text += fmt::format("  wrong      and {} more\n", check.failures.size() - kMostFailureLines);
  }
  return text + fmt::format("  verdict    {}\n", table_verdict(check));
}

Json table_json(const TableReport& report) {
  const TableCheck& check = report.check;
  Json json = {{"table", report.path},
               {"title", report.title},
               {"entries", check.entries},
               {"checked", check.checked},
               {"seed", report.options.seed},
               {"tolerance", check.tolerance},
               {"missed_tolerance", check.missed},
               {"wall_s", report.wall_s},
               {"passed", check.passed()},
               {"verdict", table_verdict(check)},
               {"quantities", Json::array()},
               {"failures", Json::array()}};
  for (const QuantityCheck& quantity : check.quantities) {
    json["quantities"].push_back({{"name", quantity.name},
                                  {"compared", quantity.compared},
                                  {"unstated", quantity.unstated},
                                  {"worst", value_json(quantity.worst)}});
  }
  for (const CheckedValue& failure : check.failures) json["failures"].push_back(value_json(failure));
  return json;
}

std::size_t PrecisionReport::failures() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(outcomes, [](const CaseOutcome& outcome) { return !outcome.complaint.empty(); }));
}

std::size_t HardCaseReport::failures() const {
  std::size_t count = 0;
  for (const PrecisionReport& precision : precisions) count += precision.failures();
  return count;
}

std::string hard_case_text(const HardCaseReport& report, bool all) {
  std::string text = fmt::format("{} hard cases, tolerance {:g}\n", report.cases.size(), report.tolerance);
  if (!report.precisions.empty()) {
    const EvaluationReport& e = report.precisions.front().evaluation;
    text += fmt::format("  device {}{}{}\n", e.device, e.driver.empty() ? "" : ", ", e.driver);
  }
  for (const PrecisionReport& precision : report.precisions) text += precision_text(report, precision, all);
  if (!report.left_out.empty()) text += fmt::format("  {}\n", report.left_out);
  return text + fmt::format("  verdict {}\n", hard_case_verdict(report));
}

Json hard_case_json(const HardCaseReport& report) {
  Json json = {{"tolerance", report.tolerance},        {"cases", report.cases.size()},
               {"failures", report.failures()},        {"passed", report.failures() == 0},
               {"verdict", hard_case_verdict(report)}, {"left_out", report.left_out},
               {"precisions", Json::array()}};
  for (const PrecisionReport& precision : report.precisions) {
    Json rows = Json::array();
    for (const CaseOutcome& outcome : precision.outcomes) {
      rows.push_back(case_json(report.cases[outcome.position], outcome));
    }
    json["precisions"].push_back({{"precision", precision.evaluation.precision},
                                  {"evaluator", precision.evaluation.evaluator},
                                  {"device", precision.evaluation.device},
                                  {"driver", precision.evaluation.driver},
                                  {"failures", precision.failures()},
                                  {"kernel_s", precision.evaluation.kernel_s},
                                  {"cases", rows}});
  }
  return json;
}

}  // namespace dolp::cli
