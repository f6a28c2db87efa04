// A scene's table, computed part by part into a file.
#pragma once

#include <filesystem>
#include <map>
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

/// The entries of a shard: a part of the values of theta. If these are too few, wavelength, n and k are cut too, so
/// that entries that share work stay together. Errors: InputError for a number out of range, or where the axes cannot
/// be cut into so many parts.
SceneEntries shard_entries(const SceneValues& scene, const Shard& shard);

/// A scene's table, or a shard of it, as a file.
struct TableJob {
  std::filesystem::path path;  ///< file that is written, with shard_path applied
  Shard shard;
  RunOptions options;
  std::string evaluator;  ///< evaluator that the user asks for
};

/// Computes the job's entries and writes them; a part is written while the next is computed.
/// Errors: errors of Run and TableOutput. They, and Cancelled, say which parts are there already.
RunOutcome write_table(const SceneValues& scene, const TableJob& job, const EvaluatorMaker& make_evaluator);

/// True if the job's path already holds the undamaged table of its shard with this identity.
bool is_there(const SceneValues& scene, const TableJob& job);

/// The complete set of a table's shards, which are opened one at a time.
class ShardSet {
 public:
  /// Errors: InputError that names a shard that is missing, there twice, or of another table, and how that differs;
  /// errors of TableReader.
  explicit ShardSet(const std::vector<std::string>& paths);

  /// Joins the shards into one table. Returns its entries.
  /// Errors: errors of the constructor, because another file may have replaced a shard; errors of TableOutput.
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
