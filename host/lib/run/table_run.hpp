// A scene's table, computed part by part into a file.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "plan/effects.hpp"
#include "run/run_summary.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One of the equal parts of a table that several processes compute.
struct Shard {
  std::size_t number = 1;  ///< from 1 on
  std::size_t count = 1;
  bool is_whole() const { return count == 1; }
};

/// "2-of-8" before the suffix of a path; the path itself for a whole table.
std::filesystem::path shard_path(const std::filesystem::path& path, const Shard& shard);

/// The entries of a shard: part of the values of theta, or where these are too few of wavelength, n and k too, so that
/// what entries share stays together.
/// Errors: InputError where the axes cannot be cut into so many parts.
SceneEntries shard_entries(const Scene& scene, const Shard& shard);

struct TableJob {
  std::filesystem::path path;  ///< of the table that is written: with shard_path applied
  Shard shard;
  bool is_resumable = true;  ///< an interrupted run leaves what is there
  bool is_resumed = false;
  bool keep_all = false;
  std::string command_line;  ///< for the history
  std::chrono::steady_clock::time_point start;
};

/// What a report says of a table that is written.
struct TableRun {
  EffectPlan plan;
  std::vector<EffectRow> effects;
  RunSummary summary;
  EvaluationReport evaluation;  ///< with the totals of the parts that were there already
  std::size_t parts = 0;
  std::size_t parts_before = 0;  ///< that an interrupted run left
  double wall_s = 0.0;
};

/// Makes the evaluator, when it is needed.
using EvaluatorMaker = std::function<MomentsEvaluator*()>;

/// Computes the job's entries and writes them; a part is written while the next is computed.
/// Errors: those of run_scene and of TableOutput, which say what is there already, as Cancelled does.
TableRun run_table_job(const Scene& scene, const TableJob& job, const EvaluatorMaker& make_evaluator,
                       const Progress& progress);

/// Whether the job's path is a whole table of its scene, shard and program already.
bool is_there(const Scene& scene, const TableJob& job);

/// Joins all shards of a table into one, which are opened one at a time. Returns the entries.
/// Errors: InputError that names a shard that is missing, there twice, or of another table; those of TableReader and
/// TableOutput.
std::size_t merge_shards(const std::vector<std::string>& shards, const std::filesystem::path& path,
                         const std::string& command_line);

}  // namespace dolp
