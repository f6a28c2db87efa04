// The study of accuracy: error against time per entry.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "model/choices.hpp"
#include "studies/cases.hpp"
#include "studies/report.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

const TimingPolicy kFullTiming{};
const TimingPolicy kQuickTiming{
    .min_repeats = 3, .max_repeats = 5, .random_repeats = 16, .enough_s = 0.1, .most_s = 1.0};
constexpr double kFullLimit = 20.0;  // seconds; methods that might not end are stopped after this time
constexpr double kQuickLimit = 1.5;
constexpr std::size_t kQuickAccuracyEntries = 512;

double rms_error(const std::vector<Answer>& answers, const Truth& truth) {
  double sum = 0.0;
  for (const Answer& answer : answers) sum += std::pow(error_of(answer, truth), 2);
  return std::sqrt(sum / static_cast<double>(answers.size()));
}

ordered_json row_start(const Method& method, const Case& which, double setting) {
  return {{"method", method.name}, {"case", which.name}, {"setting", setting}};
}

ordered_json measured_row(const Method& method, const Case& which, double setting, const Truth& truth,
                          const Measurement& measurement, std::size_t entries) {
  ordered_json row = row_start(method, which, setting);
  const Answer& answer = measurement.answers.front();
  const std::vector<double> raw_s = per_entry(measurement.raw_s, entries);
  row["error"] = rms_error(measurement.answers, truth);
  row["time_s"] = median(raw_s);
  row["time_min_s"] = minimum(raw_s);
  if (!measurement.raw_kernel_s.empty()) {
    row["kernel_time_s"] = median(per_entry(measurement.raw_kernel_s, entries));
  }
  row["raw_times_s"] = raw_s;
  row["entries"] = entries;
  if (measurement.evaluations) row["evaluations"] = *measurement.evaluations / static_cast<double>(entries);
  if (answer.stated_error) row["stated_error"] = *answer.stated_error;
  row["r_i"] = answer.r_i;
  row["r_q"] = answer.r_q;
  return row;
}

/// Measures the requested methods, cases and settings.
class AccuracyStudy {
 public:
  explicit AccuracyStudy(StudyRun& run);
  void measure_all();

 private:
  void describe();
  void run_method(const Method& method);
  void run_settings(const Method& method, Solver& solver, const Case& which, const Truth& truth);
  void not_run(const Method& method, const Case& which, double setting, const std::string& reason);
  const std::vector<double>& settings(const Method& method) const {
    return run_.options().quick ? method.quick_settings : method.settings;
  }

  StudyRun& run_;
  std::vector<Method> methods_;
  std::vector<Case> cases_;
  std::vector<Truth> truths_;
};

AccuracyStudy::AccuracyStudy(StudyRun& run)
    : run_(run),
      methods_(chosen(methods(), run.options().methods, "--method")),
      cases_(chosen(cases(), run.options().cases, "--case")) {
  for (const Method& method : methods_) run_.expect(cases_.size() * settings(method).size());
}

void AccuracyStudy::describe() {
  run_.describe("accuracy", "max(|d r_i|, |d r_q|)/r_i against the reference; random methods: rms over the repeats",
                "seconds an entry, median over raw_times_s of a whole call over its entries; tables and nodes of the "
                "call included, creation of devices and interpreters not");
  ordered_json& json = run_.json();
  for (const Method& method : methods_) json["methods"].push_back(method_json(method));
  for (const Case& one : cases_) {
    const Truth& truth = truths_.emplace_back(truths_of(neighbourhood(one, 1)).front());
    json["cases"].push_back({{"name", one.name},
                             {"what", one.what},
                             {"distribution", "cauchy"},
                             {"masking", to_name(one.masking)},
                             {"theta_deg", one.theta_deg},
                             {"sigma", one.shape.sigma},
                             {"q", one.shape.q},
                             {"n", one.index.n},
                             {"k", one.index.k},
                             {"reference",
                              {{"r_i", truth.moments.r_i},
                               {"r_q", truth.moments.r_q},
                               {"bound", truth.bound},
                               {"time_s", rounded_time(truth.time_s)}}}});
  }
}

void AccuracyStudy::measure_all() {
  describe();
  for (const Method& method : methods_) run_method(method);
}

void AccuracyStudy::run_method(const Method& method) {
  std::unique_ptr<Solver> solver;
  std::string reason;
  try {
    solver =
        method.make({.device = run_.options().device, .time_limit_s = run_.options().quick ? kQuickLimit : kFullLimit});
  } catch (const Unavailable& error) {
    reason = error.what();
  }
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    if (solver) {
      run_settings(method, *solver, cases_[i], truths_[i]);
    } else {
      for (const double setting : settings(method)) not_run(method, cases_[i], setting, reason);
    }
  }
  if (solver) note_where(run_.json(), method, *solver);
}

void AccuracyStudy::run_settings(const Method& method, Solver& solver, const Case& which, const Truth& truth) {
  const StudyOptions& options = run_.options();
  const std::size_t batch = options.quick ? std::min(options.entries, kQuickAccuracyEntries) : options.entries;
  const MomentsRequest request = neighbourhood(which, method.is_batched ? batch : 1);
  std::string too_long;
  for (const double setting : settings(method)) {
    if (!too_long.empty()) {
      not_run(method, which, setting, too_long);
      continue;
    }
    try {
      const Measurement measurement =
          measure(solver, request, setting, method.is_random, options.quick ? kQuickTiming : kFullTiming);
      run_.finish(measured_row(method, which, setting, truth, measurement, request.size()));
    } catch (const TookTooLong& error) {
      too_long = fmt::format("at {:g} {}", setting, error.what());
      not_run(method, which, setting, too_long);
    } catch (const Unavailable& error) {
      not_run(method, which, setting, error.what());
    }
  }
}

void AccuracyStudy::not_run(const Method& method, const Case& which, double setting, const std::string& reason) {
  ordered_json row = row_start(method, which, setting);
  row["not_run"] = reason;
  run_.finish(row);
}

std::string row_text(const ordered_json& row) {
  const std::string start =
      fmt::format("  {:<14} {:>8.3g}  ", row["method"].get<std::string>(), row["setting"].get<double>());
  if (row.contains("not_run")) return start + "not run: " + row["not_run"].get<std::string>() + "\n";
  const std::string kernel = row.contains("kernel_time_s") ? time_text(row["kernel_time_s"].get<double>()) : "";
  const std::string work = row.contains("evaluations") ? fmt::format("{:.4g}", row["evaluations"].get<double>()) : "";
  return fmt::format("{}{:>8.1e}  {:>9}  {:>9}  {:>9}\n", start, row["error"].get<double>(),
                     time_text(row["time_s"].get<double>()), kernel, work);
}

/// The results as tables for the terminal.
std::string accuracy_table(const ordered_json& result) {
  std::string text;
  for (const ordered_json& one : result["cases"]) {
    text +=
        fmt::format("{}: {}; {} masking, theta {:g}, sigma {:g}, q {:g}, n {:g}, k {:g}; reference to {:.1e}\n",
                    one["name"].get<std::string>(), one["what"].get<std::string>(), one["masking"].get<std::string>(),
                    one["theta_deg"].get<double>(), one["sigma"].get<double>(), one["q"].get<double>(),
                    one["n"].get<double>(), one["k"].get<double>(), one["reference"]["bound"].get<double>());
    text += fmt::format("  {:<14} {:>8}  {:>8}  {:>9}  {:>9}  {:>9}\n", "method", "setting", "error", "time", "kernel",
                        "evaluations");
    for (const ordered_json& row : result["results"]) {
      if (row["case"] == one["name"]) text += row_text(row);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

void run_accuracy(const StudyOptions& options) {
  run_study(options, {.measure =
                          [](StudyRun& run) {
                            check_device(run.options());
                            AccuracyStudy(run).measure_all();
                          },
                      .table_text = accuracy_table});
}

}  // namespace dolp::bench
