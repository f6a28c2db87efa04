// The study of effects: how much time each effect costs, and how much time dolp saves when it drops small effects.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <nlohmann/json.hpp>

#include <dolp/status.hpp>
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "plan/effects.hpp"
#include "run/scene_run.hpp"
#include "studies/effect_cases.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timed_scene.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kFullRepeats = 5;
constexpr std::size_t kQuickRepeats = 3;
constexpr std::size_t kQuickEntries = 4096;

/// The largest |change of DOLP| over the entries whose DOLP is valid in both runs, and the number of these entries.
struct Change {
  double dolp = 0.0;
  std::size_t compared = 0;
};

Change change_of(const std::vector<PointResult>& planned, const std::vector<PointResult>& all) {
  Change change;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    if (((planned[i].status | all[i].status) & kNoDolpPromised) != 0) continue;
    change.dolp = std::max(change.dolp, std::abs(planned[i][Quantity::kDolp] - all[i][Quantity::kDolp]));
    ++change.compared;
  }
  return change;
}

/// Names of the effects that the plan drops or does not need.
std::vector<std::string> left_out(const TimedScene& timed) {
  std::vector<std::string> names;
  for (const Effect& row : effects_of(timed.scene(), timed.entries(), timed.plan())) {
    if (row.state == EffectState::kDropped || row.state == EffectState::kNotNeeded) names.emplace_back(row.name);
  }
  return names;
}

/// Two runs of one scene. `planned` drops effects that hardly change DOLP. `all` keeps all effects.
struct Pair {
  std::string name;
  TimedScene planned;
  TimedScene all;

  /// True if `planned` computes less than `all`. Otherwise the two runs are equal.
  bool saves() const {
    const EffectPlan& own = planned.plan();
    const EffectPlan& whole = all.plan();
    return !own.dropped.empty() || own.kept.moments != whole.kept.moments || own.needs_beams != whole.needs_beams;
  }
};

ordered_json effect_row(const EffectGroup& group, const Pair& pair, const Pair& base) {
  const Change change = change_of(pair.planned.results(), pair.all.results());
  const double time_s = median(pair.planned.times_s());
  ordered_json row = {{"effect", group.effect}, {"case", group.mode}, {"setting", pair.name}};
  row["base"] = base.name;
  row["error"] = change.dolp;
  row["compared"] = change.compared;
  row["tolerance"] = pair.planned.scene().accuracy.tolerance;
  row["bound"] = pair.planned.plan().bound;
  row["time_s"] = time_s;
  row["kernel_time_s"] = median(pair.planned.kernel_times_s());
  row["ratio"] = time_s / median(base.planned.times_s());
  if (pair.saves()) {
    row["keep_all_time_s"] = median(pair.all.times_s());
    row["keep_all_kernel_time_s"] = median(pair.all.kernel_times_s());
  }
  row["left_out"] = left_out(pair.planned);
  row["entries"] = pair.planned.entries().size();
  row["time_min_s"] = minimum(pair.planned.times_s());
  row["raw_times_s"] = pair.planned.times_s();
  return row;
}

/// Measures the requested groups of scenes.
class Study {
 public:
  explicit Study(StudyRun& run);
  void measure_all();

 private:
  void describe();
  void run_group(const EffectGroup& group);
  bool is_wanted(const std::string& effect) const {
    const std::vector<std::string>& cases = run_.options().cases;
    return cases.empty() || std::ranges::find(cases, effect) != cases.end();
  }

  StudyRun& run_;
  std::size_t repeats_;
  std::vector<EffectGroup> groups_;
  VulkanEvaluator evaluator_;
};

void check_names(const std::vector<std::string>& names, const std::vector<EffectGroup>& groups) {
  std::string known;
  for (const EffectGroup& group : groups) {
    if (known.find(group.effect) == std::string::npos) known += (known.empty() ? "" : ", ") + group.effect;
  }
  for (const std::string& name : names) {
    if (std::ranges::find(groups, name, &EffectGroup::effect) != groups.end()) continue;
    throw InputError(fmt::format("--case {}: there is none of this name; choose among {}", name, known));
  }
}

std::vector<EffectGroup> checked_groups(const StudyOptions& options) {
  std::vector<EffectGroup> groups =
      effect_groups(options.quick ? std::min(options.entries, kQuickEntries) : options.entries);
  check_names(options.cases, groups);
  return groups;
}

Study::Study(StudyRun& run)
    : run_(run),
      repeats_(run.options().quick ? kQuickRepeats : kFullRepeats),
      groups_(checked_groups(run.options())),
      evaluator_(VulkanOptions{.device = run.options().device}) {
  for (const EffectGroup& group : groups_) {
    if (is_wanted(group.effect)) run_.expect(group.settings.size());
  }
}

void Study::describe() {
  const SceneValues& base = groups_.front().settings.front().scene;
  run_.describe("effects", "largest |change of DOLP| by what the plan drops, entries with status 1, 4 or 8 left out",
                "seconds an entry, median: plan and evaluation on the Vulkan device, whose creation is not counted");
  run_.json()["tolerance"] = base.accuracy.tolerance;
  run_.json()["grid"] = {
      {"theta_deg", base.grid[Axis::kTheta]}, {"sigma", base.grid[Axis::kSigma]}, {"q", base.grid[Axis::kQ]}};
}

void Study::measure_all() {
  describe();
  for (const EffectGroup& group : groups_) {
    if (is_wanted(group.effect)) run_group(group);
  }
}

void Study::run_group(const EffectGroup& group) {
  std::vector<Pair> pairs;
  for (const EffectSetting& setting : group.settings) {
    pairs.push_back({setting.name, {setting.scene, false, evaluator_}, {setting.scene, true, evaluator_}});
  }
  // Each turn of the loop runs all scenes once, so that other load on the machine affects all scenes equally.
  for (std::size_t i = 0; i < repeats_; ++i) {
    for (Pair& pair : pairs) {
      pair.planned.repeat();
      if (pair.saves()) pair.all.repeat();
    }
  }
  for (const Pair& pair : pairs) run_.finish(effect_row(group, pair, pairs.front()));
}

std::string joined(const ordered_json& names) {
  std::string text;
  for (const ordered_json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text.empty() ? "nothing" : text;
}

constexpr double kMicro = 1e6;

std::string effect_text(const ordered_json& row) {
  const std::string all =
      row.contains("keep_all_time_s") ? fmt::format("{:.3g}", kMicro * row["keep_all_time_s"].get<double>()) : "same";
  return fmt::format("  {:<14} {:<13} {:<22} {:>9.3g} {:>9.3g} {:>7.3g} {:>9} {:>8.1e}  {}\n",
                     row["effect"].get<std::string>(), row["case"].get<std::string>(),
                     row["setting"].get<std::string>(), kMicro * row["time_s"].get<double>(),
                     kMicro * row["kernel_time_s"].get<double>(), row["ratio"].get<double>(), all,
                     row["error"].get<double>(), joined(row["left_out"]));
}

/// The results as a table for the terminal.
std::string table_text(const ordered_json& result) {
  std::string text = fmt::format(
      "Times in us an entry; ratio to the first line of an effect\n  {:<14} {:<13} {:<22} {:>9} {:>9} {:>7} {:>9} "
      "{:>8}  {}\n",
      "effect", "mode", "setting", "time", "kernel", "ratio", "keep all", "error", "left out");
  for (const ordered_json& row : result["results"]) text += effect_text(row);
  return text;
}

/// Warns of scenes in which dropped effects change DOLP by more than the tolerance.
void add_tolerance_warnings(ordered_json& result) {
  for (const ordered_json& row : result["results"]) {
    const double tolerance = row["tolerance"].get<double>();
    if (row["error"].get<double>() <= tolerance) continue;
    result["warnings"].push_back(fmt::format("{} {} {}: error {:.2g} exceeds the tolerance {:g}",
                                             row["effect"].get<std::string>(), row["case"].get<std::string>(),
                                             row["setting"].get<std::string>(), row["error"].get<double>(), tolerance));
  }
}

}  // namespace

void run_effects(const StudyOptions& options) {
  run_study(options, {.measure = [](StudyRun& run) { Study(run).measure_all(); },
                      .table_text = table_text,
                      .warn = add_tolerance_warnings});
}

}  // namespace dolp::bench
