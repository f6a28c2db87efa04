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

/// Writes a table file part by part. The file PATH appears when the table is complete. Until then, a resumable table
/// of several parts is in PATH.partial, and PATH.partial.txt lists the finished parts. Other tables have neither file.
class TableOutput {
 public:
  struct Job {
    std::filesystem::path path;
    TableLayout layout;
    std::vector<GridBox> parts = {};  ///< the parts that write() gets, in this order; empty: any parts in any order
    std::string identity = {};        ///< names and values that must be equal in a resumed run; empty: not resumable
    bool is_resumed = false;          ///< continues PATH.partial if this file exists
    /// Called with done = 0 for each finished part that a resumed run reads. If it returns false, the run is cancelled.
    Progress progress = {};
  };
  /// If `is_resumed`, reuses the finished parts of an earlier run, up to the first part that is missing or changed.
  /// Errors: errors of check_output_path; InputError if the partial file has another identity or is in use by another
  /// process; IoError if PATH.partial or PATH.partial.txt is a link; Cancelled.
  explicit TableOutput(Job job);
  ~TableOutput();
  TableOutput(const TableOutput&) = delete;
  TableOutput& operator=(const TableOutput&) = delete;

  /// Number of finished parts, and the note that write() stored with the last of the reused parts.
  std::size_t parts_done() const { return parts_done_; }
  const std::string& note() const { return note_; }

  /// Writes the part that begins at the positions `first`. `note`: a line to store with it. Errors: IoError, Cancelled.
  void write(TableValues part, const PerAxis& first, const std::string& note);
  /// Adds the attributes `more` and makes the file at PATH. Errors: IoError, Cancelled; then PATH is unchanged.
  void finish(const std::vector<Attribute>& more);

  /// Text that tells the user how to resume the run; nullopt if there is no partial file.
  std::optional<std::string> rest() const;

 private:
  bool is_resumable() const { return !job_.identity.empty() && job_.parts.size() > 1 && job_.path != "-"; }
  std::string earlier_parts();
  std::size_t reuse_finished_parts(const std::string& lines);
  std::uint64_t part_hash(const ValueSums& part_sums) const;
  void write_rows();

  Job job_;
  TableFormat format_;
  std::optional<AtomicFile> file_;  ///< NetCDF file with the values, even for a .csv; nullopt: see only_part_
  std::optional<TableStore> store_;
  std::optional<AtomicFile> progress_;  ///< the file PATH.partial.txt of a resumable table
  TableValues only_part_;               ///< values of a .csv or .npy of one part, which needs no file_
  ValueSums sums_;
  std::size_t parts_done_ = 0;
  std::string note_;
};

/// Compares two texts of the form "name value; name value; ...". Returns the first difference, for example "evaluator
/// cpu, not vulkan", or nullopt if the texts are equal.
std::optional<std::string> difference(const std::string& identity, const std::string& wanted);

}  // namespace dolp
