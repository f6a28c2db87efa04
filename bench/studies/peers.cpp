// The study of peers: the time of different methods for the same entries at the same accuracy.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/stopwatch.hpp"
#include "methods/method.hpp"
#include "model/choices.hpp"
#include "studies/cases.hpp"
#include "studies/grids.hpp"
#include "studies/peer_settings.hpp"
#include "studies/report.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

/// A masking, with its name for the option --case.
struct PeerCase {
  std::string name;
  Masking masking;
};
std::vector<PeerCase> peer_cases() {
  std::vector<PeerCase> cases;
  for (const char* name : words_of(Masking{})) cases.push_back({name, *named<Masking>(name)});
  return cases;
}

// The two methods of dolp that others are compared with. kOwn integrates every entry; kOwnTable interpolates between
// entries, as `dolp table` does.
constexpr const char* kOwn = "vulkan-float";
constexpr const char* kOwnTable = "vulkan-table";

/// How much the study computes.
struct Effort {
  std::vector<double> tolerances;  ///< from coarse to fine
  std::size_t sample;              ///< number of entries whose errors are checked
  double call_s;                   ///< limit in seconds; after a longer call no finer setting of the method is tried
  double grid_s;                   ///< limit in seconds; a grid that would take longer is not timed
  TimingPolicy timing;
};
const Effort kFull{.tolerances = {1e-3, 1e-4, 1e-6},
                   .sample = 8,
                   .call_s = 6.0,
                   .grid_s = 1.5,
                   .timing = {.min_repeats = 5, .max_repeats = 9, .enough_s = 0.5, .most_s = 3.0}};
const Effort kQuick{.tolerances = {1e-4},
                    .sample = 3,
                    .call_s = 0.5,
                    .grid_s = 0.1,
                    .timing = {.min_repeats = 3, .max_repeats = 5, .enough_s = 0.05, .most_s = 0.3}};

/// A target for a ratio of times at tolerance 1e-4: the time of another method, divided by the time of dolp.
struct Target {
  const char* what;
  std::vector<std::string> methods;  ///< the ratio uses the time of the fastest of these methods
  std::vector<std::string> cases;
  double ratio;
  const char* key = "table_ratio";  ///< key of the ratio in the rows of results
};
const std::vector<Target> kTargets = {
    {"SciPy dblquad", {"dblquad"}, {"none", "v-cavity", "integral", "smith"}, 1e5},
    {"libcubature -O2, one core", {"hcubature", "pcubature"}, {"none", "v-cavity"}, 300.0},
    {"libcubature -O2, one core", {"hcubature", "pcubature"}, {"integral"}, 100.0},
    {"product rule, same device", {"vulkan-gauss", "vulkan-midpoint"}, {"none", "v-cavity", "integral", "smith"}, 50.0},
    {"native float build, same cores and entries", {"native-float"}, {"integral", "smith"}, 0.9, "ratio"}};
constexpr double kTargetTolerance = 1e-4;

/// The request whose time is measured. A batched method gets the largest grid of NestedGrid (grids.hpp) that it is
/// expected to finish within effort.grid_s. Any other method gets the entries of the sample.
PeerBatch timed_batch(const Method& method, Solver& solver, const PeerSample& sample, double setting,
                      const Effort& effort) {
  if (!method.is_batched) return whole_sample(sample);
  constexpr double kGrowth = 8.0;  // half the stride gives 8 times the entries
  std::size_t stride = NestedGrid::kLargestStride;
  PeerBatch batch = nested_grid(sample, stride);
  while (stride > 1) {
    const auto start = std::chrono::steady_clock::now();
    solver.solve(batch.request, setting);
    const double elapsed_s = seconds_since(start);
    if (kGrowth * elapsed_s > effort.grid_s) break;
    stride /= 2;
    batch = nested_grid(sample, stride);
  }
  return batch;
}

ordered_json row_start(const Method& method, const PeerSample& sample, double tolerance) {
  return {{"method", method.name}, {"case", name_of(sample.masking)}, {"tolerance", tolerance}};
}

class Study {
 public:
  explicit Study(StudyRun& run)
      : run_(run),
        effort_(run.options().quick ? kQuick : kFull),
        methods_(chosen(methods(), run.options().methods, "--method")),
        cases_(chosen(peer_cases(), run.options().cases, "--case")) {
    run_.expect(methods_.size() * cases_.size() * effort_.tolerances.size());
  }

  void measure_all() {
    describe();
    for (const Method& method : methods_) run_method(method);
  }

 private:
  void describe();
  void run_method(const Method& method);
  void run_sample(const Method& method, Solver& solver, const PeerSample& sample);
  ordered_json measured_row(const Method& method, Solver& solver, const PeerSample& sample, PeerSettings& settings,
                            double tolerance);

  StudyRun& run_;
  const Effort& effort_;
  std::vector<Method> methods_;
  std::vector<PeerCase> cases_;
  std::vector<PeerSample> samples_;
};

void Study::describe() {
  run_.describe(
      "peers", "largest max(|d r_i|, |d r_q|)/r_i of the sample, entries of a 64 x 64 x 64 grid, against the reference",
      "seconds an entry at the cheapest setting of those tried whose error is at most the tolerance; median, "
      "tables and nodes included, creation of devices and interpreters not");
  ordered_json& json = run_.json();
  for (const Method& method : methods_) json["methods"].push_back(method_json(method));
  const std::vector<NestedGrid::Place> places = NestedGrid::sample(effort_.sample);
  for (const PeerCase& which : cases_) {
    const PeerSample& sample = samples_.emplace_back(which.masking, places);
    ordered_json& described = json["cases"].emplace_back();
    described = {{"name", which.name}, {"what", "stainless steel, cauchy"}, {"masking", which.name}};
    for (std::size_t i = 0; i < places.size(); ++i) {
      described["sample"].push_back({{"theta_deg", sample.alone.theta_deg[i]},
                                     {"sigma", sample.alone.sigma[i]},
                                     {"q", sample.alone.q[i]},
                                     {"r_i", sample.truths[i].moments.r_i},
                                     {"bound", sample.truths[i].bound}});
    }
  }
}

void Study::run_method(const Method& method) {
  std::unique_ptr<Solver> solver;
  std::string reason;
  try {
    solver = method.make({.device = run_.options().device, .time_limit_s = effort_.call_s});
  } catch (const Unavailable& error) {
    reason = error.what();
  }
  for (const PeerSample& sample : samples_) {
    if (solver) {
      run_sample(method, *solver, sample);
      continue;
    }
    for (const double tolerance : effort_.tolerances) {
      ordered_json row = row_start(method, sample, tolerance);
      row["not_run"] = reason;
      run_.finish(row);
    }
  }
  if (solver) note_where(run_.json(), method, *solver);
}

void Study::run_sample(const Method& method, Solver& solver, const PeerSample& sample) {
  PeerSettings settings(method, solver, sample, effort_.call_s);
  for (const double tolerance : effort_.tolerances) {
    run_.finish(measured_row(method, solver, sample, settings, tolerance));
  }
}

ordered_json Study::measured_row(const Method& method, Solver& solver, const PeerSample& sample, PeerSettings& settings,
                                 double tolerance) {
  ordered_json row = row_start(method, sample, tolerance);
  while (const TriedSetting* tried = settings.reaching(tolerance)) {
    const PeerBatch batch = timed_batch(method, solver, sample, tried->setting, effort_);
    const std::size_t entries = batch.request.size();
    const Measurement measurement = measure(solver, batch.request, tried->setting, method.is_random, effort_.timing);
    const double error = method.is_batched ? batch.worst_error(measurement.last, sample) : tried->worst_error();
    if (error > tolerance) {  // the setting was tried on another grid, where its errors were smaller
      settings.reject(*tried, error);
      continue;
    }
    const std::vector<double> raw_s = per_entry(measurement.raw_s, entries);
    row["setting"] = tried->setting;
    row["error"] = error;
    row["time_s"] = median(raw_s);
    row["time_min_s"] = minimum(raw_s);
    if (!measurement.raw_kernel_s.empty()) {
      row["kernel_time_s"] = median(per_entry(measurement.raw_kernel_s, entries));
    }
    row["entries"] = entries;
    if (measurement.evaluations) row["evaluations"] = *measurement.evaluations / static_cast<double>(entries);
    row["raw_times_s"] = raw_s;
    break;
  }
  if (!row.contains("setting")) row["not_run"] = settings.why_not();
  const std::optional<double> hindsight_s = settings.with_hindsight(tolerance);
  if (hindsight_s && !method.is_batched) row["hindsight_time_s"] = rounded_time(*hindsight_s);
  return row;
}

/// The time per entry from which a ratio is computed. It is the time in kernels, or row[otherwise] if the method has no
/// kernels. Empty if the row has neither time.
std::optional<double> compared_time(const ordered_json& row, const char* otherwise = "time_s") {
  for (const char* key : {"kernel_time_s", otherwise}) {
    if (row.contains(key)) return row[key].get<double>();
  }
  return std::nullopt;
}

const ordered_json* row_of(const ordered_json& result, const std::string& method, const std::string& which,
                           double tolerance) {
  for (const ordered_json& row : result["results"]) {
    if (row["method"] == method && row["case"] == which && row["tolerance"] == tolerance) return &row;
  }
  return nullptr;
}

void add_ratios(ordered_json& result) {
  for (ordered_json& row : result["results"]) {
    for (const auto& [method, prefix] : {std::pair{kOwn, ""}, std::pair{kOwnTable, "table_"}}) {
      const ordered_json* own = row_of(result, method, row["case"], row["tolerance"]);
      if (own == nullptr) continue;
      const std::optional<double> own_s = compared_time(*own);
      const std::optional<double> time_s = compared_time(row);
      const std::string key = std::string(prefix) + "ratio";
      if (own_s && time_s) row[key] = *time_s / *own_s;
      if (own_s && row.contains("hindsight_time_s")) {
        row["hindsight_" + key] = row["hindsight_time_s"].get<double>() / *own_s;
      }
    }
  }
}

void add_targets(ordered_json& result) {
  result["targets"] = ordered_json::array();
  for (const Target& target : kTargets) {
    for (const std::string& which : target.cases) {
      std::optional<double> ratio, hindsight_ratio;
      const auto lower = [](std::optional<double>& least, const ordered_json& row, const std::string& key) {
        if (row.contains(key)) least = std::min(least.value_or(row[key].get<double>()), row[key].get<double>());
      };
      for (const std::string& method : target.methods) {
        const ordered_json* row = row_of(result, method, which, kTargetTolerance);
        if (row == nullptr) continue;
        lower(ratio, *row, target.key);
        lower(hindsight_ratio, *row, std::string("hindsight_") + target.key);
      }
      if (!ratio && !hindsight_ratio) continue;
      ordered_json& entry = result["targets"].emplace_back();
      entry = {{"against", target.what}, {"case", which}, {"tolerance", kTargetTolerance}, {"wanted", target.ratio}};
      if (ratio) entry["ratio"] = *ratio;
      if (hindsight_ratio) entry["hindsight_ratio"] = *hindsight_ratio;
      if (ratio) entry["met"] = *ratio >= target.ratio;
    }
  }
}

std::string row_text(const ordered_json& row) {
  const std::string start = fmt::format("  {:<16} {:<9} {:>7.0e}  ", row["method"].get<std::string>(),
                                        row["case"].get<std::string>(), row["tolerance"].get<double>());
  if (row.contains("not_run")) return start + "not run: " + row["not_run"].get<std::string>() + "\n";
  const std::string kernel = row.contains("kernel_time_s") ? time_text(row["kernel_time_s"].get<double>()) : "";
  const auto ratio = [&](const char* key) {
    return row.contains(key) ? fmt::format("x {:.3g}", row[key].get<double>()) : std::string();
  };
  return start + fmt::format("{:>8g} {:>8.1e} {:>9} {:>9} {:>8}  {:>10} {:>10}\n", row["setting"].get<double>(),
                             row["error"].get<double>(), time_text(row["time_s"].get<double>()), kernel,
                             row["entries"].get<std::size_t>(), ratio("ratio"), ratio("table_ratio"));
}

std::string table_text(const ordered_json& result) {
  std::string text = fmt::format(
      "Time per entry; ratios to the kernels of {} and of {}\n  {:<16} {:<9} {:>7}  {:>8} {:>8} {:>9} "
      "{:>9} {:>8}\n",
      kOwn, kOwnTable, "method", "masking", "wanted", "setting", "error", "time", "kernel", "entries");
  for (const ordered_json& row : result["results"]) text += row_text(row);
  for (const ordered_json& target : result["targets"]) {
    if (!target.contains("ratio")) continue;
    text +=
        fmt::format("{} {}: x {:.3g}, wanted {:g}\n", target["against"].get<std::string>(),
                    target["case"].get<std::string>(), target["ratio"].get<double>(), target["wanted"].get<double>());
  }
  return text;
}

}  // namespace

void run_peers(const StudyOptions& options) {
  run_study(options, {.measure =
                          [](StudyRun& run) {
                            check_device(run.options());
                            Study(run).measure_all();
                            add_ratios(run.json());
                            add_targets(run.json());
                          },
                      .table_text = table_text});
}

}  // namespace dolp::bench
