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
#include "run/scene_run.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The path with "2-of-8" before its suffix, or the path itself where there is no shard.
std::filesystem::path shard_path(const std::filesystem::path& path, const Shard& shard);

/// The entries of a shard: part of the values of theta, or, where these are too few, of wavelength, n and k too, so
/// that entries that share work stay together.
/// Errors: InputError for a number out of range, or where the axes cannot be cut into so many parts.
SceneEntries shard_entries(const SceneValues& scene, const Shard& shard);

/// A scene's table, or a shard of it, as a file.
struct TableJob {
  std::filesystem::path path;  ///< of the table that is written: with shard_path applied
  Shard shard;
  RunOptions options;
  std::string evaluator;  ///< that is asked for
};

/// Computes the job's entries and writes them; a part is written while the next is computed.
/// Errors: those of Run and of TableOutput, which say what is there already, as Cancelled does.
RunOutcome write_table(const SceneValues& scene, const TableJob& job, const EvaluatorMaker& make_evaluator);

/// True where the job's path already holds the undamaged table of its shard, of the same identity.
bool is_there(const SceneValues& scene, const TableJob& job);

/// Joins all shards of a table into one, which are opened one at a time. Returns the entries.
/// Errors: InputError that names a shard that is missing, there twice, or of another table, and how that differs; those
/// of TableReader and TableOutput.
std::size_t merge_shards(const std::vector<std::string>& shards, const std::filesystem::path& path,
                         const std::string& command_line);

}  // namespace dolp
