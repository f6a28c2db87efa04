// A scene's table, computed part by part into a file.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "plan/effects.hpp"
#include "run/run_summary.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"
#include "table/table_reader.hpp"

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

/// The complete set of a table's shards, which are opened one at a time.
class ShardSet {
 public:
  /// Errors: InputError that names a shard that is missing, there twice, or of another table, and how that differs;
  /// those of TableReader.
  explicit ShardSet(const std::vector<std::string>& paths);

  /// Joins the shards into one table. Returns its entries.
  /// Errors: those of the constructor, since another file may have taken a shard's place; those of TableOutput.
  std::size_t merge(const std::filesystem::path& path, const std::string& command_line) const;

 private:
  void begin(const TableReader& first, const std::string& path);
  /// The number of an open shard that belongs to the set.
  std::size_t checked_number(const TableReader& reader, const std::string& path) const;

  SceneValues scene_;
  TableLayout layout_;  ///< with the first shard's attributes
  std::size_t count_ = 0;
  std::map<std::size_t, std::string> paths_;  ///< by number
};

}  // namespace dolp
