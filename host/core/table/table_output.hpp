// Resumable table writer: writes part by part, so that an interrupted run can continue.
#pragma once

#include <dolp/errors.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.hpp"
#include "table/table.hpp"
#include "table/table_file.hpp"
#include "table/table_store.hpp"

namespace dolp {

/// A table file that is being written. A resumable table of several parts stays in PATH.partial until it is complete;
/// PATH.partial.txt has a line for each finished part, with a hash of its values. Other tables have no name before they
/// are complete. A .csv or .npy is converted at the end.
class TableOutput {
 public:
  struct Job {
    std::filesystem::path path;
    TableLayout layout;
    std::vector<TableBox> parts = {};  ///< in the order of write(); none: any number of parts, in any order
    std::string identity = {};  ///< for a resumable table: names and values that all parts share, see difference()
    bool is_resumed = false;    ///< continues PATH.partial, if it is there
    Progress progress = {};     ///< called, with nothing done, while finished parts are read
  };
  /// Reuses finished parts of an earlier run, up to the first that is missing or changed. Errors: errors of
  /// check_output_path; InputError for a partial file of another identity, or one that another process writes; IoError
  /// if PATH.partial or PATH.partial.txt is a link; Cancelled.
  explicit TableOutput(Job job);
  ~TableOutput();
  TableOutput(const TableOutput&) = delete;
  TableOutput& operator=(const TableOutput&) = delete;

  /// Number of parts that exist already, and the note of the last of them.
  std::size_t parts_done() const { return parts_done_; }
  const std::string& note() const { return note_; }

  /// Writes the next part, which begins at `first`, and a note, one line. Errors: IoError, Cancelled.
  void write(TableValues part, const PerAxis& first, const std::string& note);
  /// Makes the file, with more attributes. Errors: IoError, Cancelled; PATH is as it was then.
  void finish(const std::vector<Attribute>& more);

  /// One sentence on how to continue from the partial file, if there is one.
  std::optional<std::string> rest() const;

 private:
  bool is_resumable() const { return !job_.identity.empty() && job_.parts.size() > 1 && job_.path != "-"; }
  void open_progress();
  std::uint64_t reuse_finished_parts();
  std::uint64_t part_hash(const ValueSums& of_part) const;
  void write_rows();

  Job job_;
  TableFormat format_;
  std::optional<AtomicFile> file_;  ///< has the values; none for a .csv or .npy of one part
  std::optional<TableStore> store_;
  std::optional<AtomicFile> progress_;  ///< text of the finished parts of a resumable table
  TableValues only_part_;
  ValueSums sums_;
  std::size_t parts_done_ = 0;
  std::string note_;
};

/// The first difference between two identities, "name value; name value": "evaluator cpu, not vulkan". None: nothing.
std::optional<std::string> difference(const std::string& identity, const std::string& wanted);

}  // namespace dolp
