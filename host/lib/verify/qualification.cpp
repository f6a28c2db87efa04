#include "verify/qualification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <dolp/results.hpp>
#include "base/numbers.hpp"
#include "base/text.hpp"
#include "model/choices.hpp"
#include "reference/moments.hpp"
#include "run/scene_run.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"

namespace dolp {
namespace {

using enum Quantity;

constexpr std::array<std::string_view, 17> kCaseColumns{
    "distribution",  "masking", "theta_deg", "sigma",   "q",         "n",         "k",
    "r_i",           "r_q",     "albedo",    "deficit", "r_i_error", "r_q_error", "albedo_error",
    "deficit_error", "case",    "origin"};

template <class Choice>
Choice choice(const CsvReader& row, std::size_t column) {
  const std::string_view word = row.cells()[column];
  const std::optional<Choice> found = named<Choice>(word);
  if (!found) {
    row.fail(fmt::format("{} = {}: must be one of {}", kCaseColumns[column], one_line(word),
                         fmt::join(choice_names(Choice{}), ", ")));
  }
  return *found;
}

StoredCase parse_case(const CsvReader& row) {
  const std::size_t cells = row.cells().size();
  if (cells != kCaseColumns.size()) row.fail(fmt::format("{} cells, {} are expected", cells, kCaseColumns.size()));
  const auto number = [&row](std::size_t column) { return row.number(column, kCaseColumns[column]); };
  StoredCase stored;
  stored.distribution = choice<Distribution>(row, 0);
  stored.masking = choice<Masking>(row, 1);
  stored.theta_deg = number(2);
  stored.shape = {number(3), number(4)};
  stored.index = {number(5), number(6)};
  for (std::size_t i = 0; i < 4; ++i) {
    stored.moments.*kMomentMembers[i].value = number(7 + i);
    stored.moments.*kMomentMembers[i].error = number(11 + i);
  }
  stored.name = row.cells()[15];
  stored.origin = row.cells()[16];
  return stored;
}

constexpr double kQuotientRounding = 8.0 * std::numeric_limits<double>::epsilon();

double relative(double error, double value) {
  if (error == 0.0) return 0.0;
  return value > 0.0 ? error / value : kInfinity;
}

double quotient_error(double above_error, double quotient, double below, double below_error) {
  const double margin = std::abs(below) - below_error;
  return margin > 0.0
             ? (above_error + std::abs(quotient) * below_error) / margin + kQuotientRounding * std::abs(quotient)
             : kInfinity;
}

/// The reference values, with the bounds of their errors. At 90 degrees there is no rho.
PointResult expected_result(const StoredCase& stored) {
  const Moments& m = stored.moments;
  const bool has_rho = stored.theta_deg != 90.0;
  // The surface only emits, so DOLP = |rho_Q| / (1 - rho_I). Moments::deficit is (1 - rho_I) cos(theta).
  const auto [below, below_error] = has_rho ? std::pair(m.deficit, m.deficit_error) : std::pair(m.r_i, m.r_i_error);
  PointResult expected;
  expected[kDolp] = std::abs(m.r_q) / below;
  expected[kErrorEstimate] = quotient_error(m.r_q_error, expected[kDolp], below, below_error);
  if (!has_rho) return expected;
  const double cosine = reference::zenith_from_deg(stored.theta_deg).cos;
  expected[kRhoI] = m.r_i / cosine;
  expected[kRhoQ] = m.r_q / cosine;
  expected[kRhoErrorEstimate] =
      relative(std::max(m.r_i_error, m.r_q_error), m.r_i) + (m.r_i > 0.0 ? kQuotientRounding : 0.0);
  return expected;
}

std::string complaint_about(const char* quantity, const ErrorCheck& check, bool is_promised, double tolerance) {
  if (std::isnan(check.error)) return fmt::format("{} is not a number", quantity);
  if (std::isnan(check.estimate)) return fmt::format("{} has no estimate", quantity);
  if (!(check.ratio() <= 1.0)) return fmt::format("the estimate of {} is below its error", quantity);
  if (is_promised && check.error > tolerance + check.reference) {
    return fmt::format("{} misses the tolerance without the status that says so", quantity);
  }
  return {};
}

CaseOutcome case_outcome(const StoredCase& stored, const PointResult& result, double tolerance) {
  const PointResult expected = expected_result(stored);
  CaseOutcome outcome{.stored = stored};
  outcome.status = result.status;
  const bool meets_dolp = promises_dolp(result.status) && (result.status & kToleranceNotMet) == 0;
  const bool meets_rho = (result.status & kRhoToleranceNotMet) == 0;
  outcome.dolp = {std::abs(result[kDolp] - expected[kDolp]), result[kErrorEstimate], expected[kErrorEstimate]};
  // If I may be 0 within its error bound, DOLP has no usable reference and is not compared.
  const bool has_dolp = std::isfinite(expected[kDolp]) && std::isfinite(expected[kErrorEstimate]);
  if (!has_dolp) outcome.dolp = {0.0, kInfinity, 0.0};
  outcome.complaint = complaint_about("dolp", outcome.dolp, meets_dolp, tolerance);
  if (std::isnan(expected[kRhoI])) {
    outcome.rho.estimate = kInfinity;
    return outcome;
  }
  const double distance =
      std::max(std::abs(result[kRhoI] - expected[kRhoI]), std::abs(result[kRhoQ] - expected[kRhoQ]));
  const bool has_rho = !std::isnan(result[kRhoI]) && !std::isnan(result[kRhoQ]);
  outcome.rho = {has_rho ? relative(distance, expected[kRhoI]) : distance, result[kRhoErrorEstimate],
                 expected[kRhoErrorEstimate]};
  const std::string complaint = complaint_about("rho", outcome.rho, meets_rho, tolerance);
  if (!complaint.empty()) outcome.complaint = complaint;
  return outcome;
}

}  // namespace

std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name) {
  std::vector<StoredCase> cases;
  CsvReader row(text, name);
  const bool is_header = row.next() && std::ranges::equal(row.cells(), kCaseColumns);
  if (!is_header) row.fail(fmt::format("the columns must be {}", fmt::join(kCaseColumns, ",")));
  while (row.next()) cases.push_back(parse_case(row));
  return cases;
}

std::vector<StoredCase> read_stored_cases(const std::string& path) {
  return parse_stored_cases(read_text(path, path + ": "), path);
}

std::vector<StoredCase> hard_cases() { return parse_stored_cases(embedded_hard_cases_csv(), "hard_cases.csv"); }

double ErrorCheck::ratio() const {
  if (std::isinf(estimate)) return 0.0;
  const double excess = std::max(0.0, error - reference);
  if (excess == 0.0) return error > 0.0 && estimate > 0.0 ? std::min(1.0, error / estimate) : 0.0;
  return estimate > 0.0 ? excess / estimate : kInfinity;
}

double CaseOutcome::worst_ratio() const { return std::max(rho.ratio(), dolp.ratio()); }

SceneValues emission_scene(Distribution distribution, Masking masking, double tolerance) {
  SceneValues scene;
  scene.surface.distribution = distribution;
  scene.surface.masking = masking;
  scene.surface.material.constant = {1.508, 0.0};
  scene.surface.sigma = 0.3;
  scene.emission = Emission{300.0, EmissionModel::kMoments};
  scene.spectrum = {10.6, 10.6};
  scene.grid = make_axes({60.0}, {0.3}, {2.0});
  scene.accuracy.tolerance = tolerance;
  return scene;
}

std::vector<CaseOutcome> qualify(const std::vector<StoredCase>& cases, ModelEvaluator& evaluator,
                                 const Accuracy& accuracy, const Progress& progress) {
  std::map<std::pair<Distribution, Masking>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < cases.size(); ++i) groups[{cases[i].distribution, cases[i].masking}].push_back(i);
  std::vector<CaseOutcome> outcomes(cases.size());
  std::size_t finished = 0;
  for (const auto& [group, positions] : groups) {
    std::vector<SceneEntry> entries;
    for (const std::size_t i : positions) entries.push_back({cases[i].theta_deg, cases[i].shape, cases[i].index});
    SceneValues scene = emission_scene(group.first, group.second, accuracy.tolerance);
    scene.accuracy = accuracy;
    const Progress group_progress = [&](std::size_t done, std::size_t) {
      return !progress || progress(finished + done, cases.size());
    };
    const std::vector<PointResult> results = evaluate_scene(scene, entries, evaluator, group_progress);
    finished += positions.size();
    for (std::size_t j = 0; j < positions.size(); ++j) {
      const std::size_t i = positions[j];
      outcomes[i] = case_outcome(cases[i], results[j], accuracy.tolerance);
    }
  }
  return outcomes;
}

std::vector<StoredCase> ordinary_cases() {
  constexpr std::array kOrdinary{"ordinary",    "sigma-1e-2",     "brewster",     "index-27-90",
                                 "index-0.2-3", "split-lines-18", "almost-normal"};
  std::vector<StoredCase> cases = hard_cases();
  std::erase_if(cases, [&](const StoredCase& c) { return std::ranges::find(kOrdinary, c.name) == kOrdinary.end(); });
  return cases;
}

}  // namespace dolp
