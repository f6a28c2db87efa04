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

/// The path of the file of a shard: "table.2-of-8.nc" for "table.nc". Without a shard, `path` itself.
std::filesystem::path shard_path(const std::filesystem::path& path, const Shard& shard);

/// The entries of a shard. Shards divide theta and, if it has too few values, other axes too. They never divide sigma
/// and q, because entries along these axes share work. Errors: InputError for a wrong shard number or too many shards.
SceneEntries shard_entries(const SceneValues& scene, const Shard& shard);

struct TableJob {
  std::filesystem::path path;  ///< file to write: the result of shard_path() for a shard
  Shard shard;
  RunOptions options;
  std::string evaluator;  ///< name of the evaluator that the user chose
};

/// Computes the entries of the job and writes them to its file. Each part is written while the next one is computed.
/// Errors: errors of Run and TableOutput; Cancelled. Their messages tell which parts are already on disk.
RunOutcome write_table(const SceneValues& scene, const TableJob& job, const EvaluatorMaker& make_evaluator);

/// True if the file of the job is complete and undamaged, and has the entries and the kIdentity that the job asks for.
bool is_there(const SceneValues& scene, const TableJob& job);

class ShardSet {
 public:
  /// Errors: InputError that names a missing shard, a duplicate, or a shard of another table; errors of TableReader.
  explicit ShardSet(const std::vector<std::string>& paths);

  /// Joins the shards. Returns the number of entries. Errors: errors of the constructor if a file has changed since.
  std::size_t merge(const std::filesystem::path& path, const std::string& command_line) const;

 private:
  void begin(const TableReader& first, const std::string& path);
  std::size_t checked_number(const TableReader& reader, const std::string& path) const;

  SceneValues scene_;
  TableLayout layout_;  ///< layout of the whole table, with the attributes of the first shard
  std::size_t count_ = 0;
  std::map<std::size_t, std::string> paths_;  ///< paths of the shards by their numbers
};

}  // namespace dolp
