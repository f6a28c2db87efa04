#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "run/scattering_gap.hpp"
#include "run/scene_run.hpp"
#include "run/table_run.hpp"
#include "scene/text.hpp"
#include "table/table_file.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

/// A whole number from `least` on.
std::size_t whole_number(const std::string& text, const std::string& what, double least) {
  constexpr double kMost = 1e9;
  const std::optional<double> number = parse_number(text);
  if (number && *number >= least && *number <= kMost &&
      *number == static_cast<double>(static_cast<std::size_t>(*number)))
    return static_cast<std::size_t>(*number);
  throw InputError(fmt::format("{}: {} is not a whole number from {} on", what, one_line(text), least));
}

std::size_t slurm_number(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text)
    throw InputError(fmt::format("--shard auto: needs the tasks of a Slurm array, and {} is not set", variable));
  return whole_number(text, variable, 0.0);
}

/// "2/8", or what the Slurm array says for "auto".
Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  if (text == "auto") {
    const std::size_t task = slurm_number("SLURM_ARRAY_TASK_ID");
    const std::size_t first = slurm_number("SLURM_ARRAY_TASK_MIN");
    shard = {task - first + 1, slurm_number("SLURM_ARRAY_TASK_COUNT")};
  } else {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) throw InputError(fmt::format("--shard {}: must be I/N or auto", one_line(text)));
    shard = {whole_number(text.substr(0, slash), "--shard", 1.0), whole_number(text.substr(slash + 1), "--shard", 1.0)};
  }
  if (shard.number < 1 || shard.number > shard.count)
    throw InputError(fmt::format("--shard {}: shard {} of {}", one_line(text), shard.number, shard.count));
  return shard;
}

}  // namespace

int run_table(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load_scene(options);
  TableJob job;
  job.shard = shard_of(options.shard);
  job.path = shard_path(options.output_path, job.shard);
  job.is_resumed = options.resume;
  job.keep_all = options.keep_all;
  job.command_line = options.command_line;
  job.start = start;
  check_output_is_no_input(options, scene.files);
  check_output_path(job.path);
  const SceneEntries entries = shard_entries(scene, job.shard);
  if (!job.shard.is_whole() && is_there(scene, job)) {
    Report report;
    report.line("{}", key("title", scene.title));
    report.row("kept", "{}: the whole shard is there already", key("output", job.path.string()));
    report.print(options.json, options.quiet, job.path.string());
    return kExitDone;
  }
  std::unique_ptr<MomentsEvaluator> evaluator;
  const auto make = [&] {
    evaluator = make_evaluator(options, scene);
    return evaluator.get();
  };
  SceneRun run;
  try {
    ProgressBar bar(options.quiet);
    TableRun table = run_table_job(scene, job, make, bar.callback());
    run = {std::move(table.plan), std::move(table.effects), table.summary, {}, table.evaluation, table.wall_s};
  } catch (const InterruptedTable& interrupted) {
    return fail("dolp", kExitInterrupted, "interrupted; " + interrupted.rest);
  }
  if (!evaluator) run.evaluation = evaluation_of(nullptr, options);
  run.scattering_gap = scattering_gap(scene, entries, run.plan);
  run.wall_s = seconds_since(start);
  return report_run(options, scene, run, grid_text(entries.axes()), job.path.string());
}

int run_merge(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  for (const std::string& shard : options.shards) {
    std::error_code error;
    if (std::filesystem::equivalent(shard, options.output_path, error))
      throw InputError(options.output_path + ": is a shard to merge; write to another file");
  }
  check_output_path(options.output_path);
  const std::size_t entries = merge_shards(options.shards, options.output_path, options.command_line);
  Report report;
  report.line("{} entries of {} shards", key("entries", entries), key("shards", options.shards.size()));
  report.row("written", "{}", key("output", options.output_path));
  report.value("wall_s", seconds_since(start));
  report.print(options.json, options.quiet, options.output_path);
  return kExitDone;
}

}  // namespace dolp::cli
