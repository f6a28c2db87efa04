// Resumable table writer: writes part by part, so that an interrupted run can continue.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// A table file under way. A table of several parts is in PATH.partial until it is complete, and PATH.partial.txt
/// states its progress; a table of one part has no name before. A .csv or .npy is converted from it at the end.
class TableOutput {
 public:
  struct Job {
    std::filesystem::path path;
    TableLayout layout;
    std::size_t parts = 1;
    bool is_resumable = true;   ///< otherwise the files of an interrupted run are removed
    bool is_resumed = false;    ///< goes on with PATH.partial, if it is there
    std::string identity = {};  ///< one line of scene, program and device that all parts must share
  };
  /// Errors: those of check_output_path; InputError for a partial file of another identity, or that another process
  /// writes.
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

}  // namespace dolp
