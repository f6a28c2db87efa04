// The work-precision study.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/cases.hpp"
#include "bench/context.hpp"
#include "bench/method.hpp"
#include "bench/report.hpp"
#include "bench/study.hpp"
#include "bench/timing.hpp"
#include "cli/progress_bar.hpp"
#include "error.hpp"
#include "evaluate/reference/reference_evaluator.hpp"
#include "evaluate/vulkan/devices.hpp"
#include "table/atomic_file.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

constexpr double kReferenceTolerance = 1e-13;

const TimingPolicy kFullTiming{};
const TimingPolicy kQuickTiming{
    .min_repeats = 3, .max_repeats = 5, .random_repeats = 16, .enough_s = 0.1, .most_s = 1.0};
constexpr double kFullLimit = 20.0;  // seconds for one call of a method that may take for ever
constexpr double kQuickLimit = 1.5;
constexpr std::size_t kQuickEntries = 512;

/// What the reference says about a case.
struct Truth {
  Moments moments;
  double bound = 0.0;  ///< of max(|d r_i|, |d r_q|)/r_i
  double time_s = 0.0;
};

Truth truth_of(const Case& which) {
  MomentsRequest request = neighbourhood(which, 1);
  request.tolerance = 0.0;
  ReferenceEvaluator reference({.relative_tolerance = kReferenceTolerance});
  Truth truth;
  truth.moments = reference.evaluate(request, nullptr).front();
  truth.bound = std::max(truth.moments.r_i_error, truth.moments.r_q_error) / truth.moments.r_i;
  truth.time_s = reference.report().kernel_s;
  return truth;
}

double error_of(const Answer& answer, const Truth& truth) {
  return std::max(std::abs(answer.r_i - truth.moments.r_i), std::abs(answer.r_q - truth.moments.r_q)) /
         truth.moments.r_i;
}

double rms_error(const std::vector<Answer>& answers, const Truth& truth) {
  double sum = 0.0;
  for (const Answer& answer : answers) sum += std::pow(error_of(answer, truth), 2);
  return std::sqrt(sum / static_cast<double>(answers.size()));
}

/// To four digits: raw times have no more.
double rounded(double time_s) { return std::stod(fmt::format("{:.3e}", time_s)); }

std::vector<double> per_entry(std::vector<double> times_s, std::size_t entries) {
  for (double& time_s : times_s) time_s = rounded(time_s / static_cast<double>(entries));
  return times_s;
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

/// Everything that is asked for, and what has been found so far.
class Study {
 public:
  Study(const StudyOptions& options, Progress progress);
  ordered_json run();

 private:
  void describe();
  void run_method(const Method& method);
  void run_settings(const Method& method, Solver& solver, const Case& which, const Truth& truth);
  void not_run(const Method& method, const Case& which, double setting, const std::string& reason);
  void finish(const ordered_json& row);
  const std::vector<double>& settings(const Method& method) const {
    return options_.quick ? method.quick_settings : method.settings;
  }

  const StudyOptions& options_;
  Progress progress_;
  std::vector<Method> methods_;
  std::vector<Case> cases_;
  std::vector<Truth> truths_;
  ordered_json result_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

/// The members of `all` that are named, all of them when none is.
template <class Named>
std::vector<Named> chosen(const std::vector<Named>& all, const std::vector<std::string>& names, const char* option) {
  std::string known;
  for (const Named& one : all) known += (known.empty() ? "" : ", ") + one.name;
  for (const std::string& name : names) {
    if (std::ranges::find(all, name, &Named::name) != all.end()) continue;
    throw InputError(fmt::format("{} {}: there is none of this name; choose among {}", option, name, known));
  }
  std::vector<Named> kept = all;
  if (!names.empty()) {
    std::erase_if(kept, [&](const Named& one) { return std::ranges::find(names, one.name) == names.end(); });
  }
  return kept;
}

Study::Study(const StudyOptions& options, Progress progress)
    : options_(options),
      progress_(std::move(progress)),
      methods_(chosen(methods(), options.methods, "--method")),
      cases_(chosen(cases(), options.cases, "--case")) {
  for (const Method& method : methods_) total_ += cases_.size() * settings(method).size();
}

void Study::describe() {
  result_["study"] = "accuracy";
  result_["context"] = context_json(options_.device, options_.arguments);
  result_["error"] = "max(|d r_i|, |d r_q|)/r_i against the reference; random methods: rms over the repeats";
  result_["time_s"] =
      "seconds an entry, median over raw_times_s of a whole call over its entries; tables and nodes of the call "
      "included, creation of devices and interpreters not";
  for (const Method& method : methods_) {
    result_["methods"].push_back({{"name", method.name},
                                  {"label", method.label},
                                  {"what", method.what},
                                  {"cores", method.cores},
                                  {"setting", method.setting_name}});
  }
  for (const Case& one : cases_) {
    const Truth& truth = truths_.emplace_back(truth_of(one));
    result_["cases"].push_back({{"name", one.name},
                                {"what", one.what},
                                {"distribution", "cauchy"},
                                {"masking", masking_name(one.masking)},
                                {"theta_deg", one.theta_deg},
                                {"sigma", one.shape.sigma},
                                {"q", one.shape.q},
                                {"n", one.index.n},
                                {"k", one.index.k},
                                {"reference",
                                 {{"r_i", truth.moments.r_i},
                                  {"r_q", truth.moments.r_q},
                                  {"bound", truth.bound},
                                  {"time_s", rounded(truth.time_s)}}}});
  }

  result_["results"] = ordered_json::array();
}

ordered_json Study::run() {
  const auto start = std::chrono::steady_clock::now();
  describe();
  for (const Method& method : methods_) run_method(method);
  result_["wall_s"] = rounded(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return std::move(result_);
}

void Study::run_method(const Method& method) {
  std::unique_ptr<Solver> solver;
  std::string reason;
  try {
    solver = method.make({.device = options_.device, .time_limit_s = options_.quick ? kQuickLimit : kFullLimit});
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
  for (ordered_json& described : result_["methods"]) {
    if (solver && described["name"] == method.name) described["where"] = solver->where();
  }
}

void Study::run_settings(const Method& method, Solver& solver, const Case& which, const Truth& truth) {
  const std::size_t batch = options_.quick ? std::min(options_.entries, kQuickEntries) : options_.entries;
  const MomentsRequest request = neighbourhood(which, method.is_batched ? batch : 1);
  std::string too_long;
  for (const double setting : settings(method)) {
    if (!too_long.empty()) {
      not_run(method, which, setting, too_long);
      continue;
    }
    try {
      const Measurement measurement =
          measure(solver, request, setting, method.is_random, options_.quick ? kQuickTiming : kFullTiming);
      finish(measured_row(method, which, setting, truth, measurement, request.entries.size()));
    } catch (const TookTooLong& error) {
      too_long = fmt::format("at {:g} {}", setting, error.what());
      not_run(method, which, setting, too_long);
    } catch (const Unavailable& error) {
      not_run(method, which, setting, error.what());
    }
  }
}

void Study::not_run(const Method& method, const Case& which, double setting, const std::string& reason) {
  ordered_json row = row_start(method, which, setting);
  row["not_run"] = reason;
  finish(row);
}

void Study::finish(const ordered_json& row) {
  result_["results"].push_back(row);
  if (!progress_(++done_, total_)) throw Cancelled{};
}

std::string time_text(double time_s) {
  if (time_s < 1e-3) return fmt::format("{:.3g} us", 1e6 * time_s);
  return time_s < 1.0 ? fmt::format("{:.3g} ms", 1e3 * time_s) : fmt::format("{:.3g} s", time_s);
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

/// The table for people.
std::string table_text(const ordered_json& result) {
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

/// The study under a progress bar, which is gone before anything is printed.
ordered_json measured(const StudyOptions& options) {
  cli::ProgressBar bar(options.quiet);
  return Study(options, bar.callback()).run();
}

void check_device(const std::string& choice) {
  if (!choice.empty()) choose_device(list_devices().devices, choice, false);
}

}  // namespace

void run_accuracy(const StudyOptions& options) {
  if (!options.json_path.empty()) check_writable(options.json_path);
  check_device(options.device);
  ordered_json result = measured(options);
  add_warnings(result);
  if (options.json_path != "-") fmt::print("{}", table_text(result));
  std::fflush(stdout);
  for (const ordered_json& warning : result["warnings"]) {
    fmt::print(stderr, "warning: {}\n", warning.get<std::string>());
  }
  if (!options.json_path.empty()) write_text_atomically(options.json_path, json_text(std::move(result)));
}

}  // namespace dolp::bench
