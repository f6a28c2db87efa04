// Resumable table writer: writes part by part, so that an interrupted run can continue.
#pragma once

#include <dolp/errors.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "table/table_box.hpp"

namespace dolp {

/// A table file under way. A resumable table of several parts is in PATH.partial until it is complete, and
/// PATH.partial.txt has a line for each finished part, with a hash of its values; any other has no name before. A .csv
/// or .npy is converted from it at the end.
class TableOutput {
 public:
  struct Job {
    std::filesystem::path path;
    TableLayout layout;
    std::vector<TableBox> parts = {};  ///< in the order of write(); none: any number of parts, in any order
    std::string identity = {};  ///< of a resumable table: names and values that all parts share, see difference()
    bool is_resumed = false;    ///< goes on with PATH.partial, if it is there
    Progress progress = {};     ///< called, with nothing done, while what is there is read
  };
  /// Of parts that an earlier run finished those are taken over that the file still has as they were written, up to the
  /// first that it has not. Errors: those of check_output_path; InputError for a partial file of another identity, or
  /// that another process writes; IoError where PATH.partial or PATH.partial.txt is a link; Cancelled.
  explicit TableOutput(Job job);
  ~TableOutput();
  TableOutput(const TableOutput&) = delete;
  TableOutput& operator=(const TableOutput&) = delete;

  /// Number of parts that exist already, and the note of the last of them.
  std::size_t parts_done() const;
  const std::string& note() const;

  /// Writes the next part, which begins at `first`, and a note, one line. Errors: IoError, Cancelled.
  void write(TableValues part, const PerAxis& first, const std::string& note);
  /// Makes the file, with more attributes. Errors: IoError, Cancelled; PATH is as it was then.
  void finish(const std::vector<Attribute>& more);

  /// One sentence on how to continue from the partial file, if there is one.
  std::optional<std::string> rest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The first difference between two identities, "name value; name value": "evaluator cpu, not vulkan". None: nothing.
std::optional<std::string> difference(const std::string& identity, const std::string& wanted);

}  // namespace dolp
