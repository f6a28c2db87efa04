// What a run writes a table to, part by part, so that an interrupted one can go on.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// A table file under way. One of several parts is in PATH.partial until it is whole, and PATH.partial.txt says how far
/// it is; one of one part has no name before. A .csv or .npy is made of it at the end.
class TableOutput {
 public:
  struct Job {
    std::filesystem::path path;
    TableLayout layout;
    std::size_t parts = 1;
    bool is_resumable = true;   ///< otherwise what is left of an interrupted run is removed
    bool is_resumed = false;    ///< goes on with PATH.partial, if it is there
    std::string identity = {};  ///< one line, of scene, program and device: what the parts must have in common
  };
  /// Errors: those of check_output_path; InputError for a partial file of another identity, or that another process
  /// writes.
  explicit TableOutput(Job job);
  ~TableOutput();
  TableOutput(const TableOutput&) = delete;
  TableOutput& operator=(const TableOutput&) = delete;

  /// Parts that were there already, and the note that came with the last of them.
  std::size_t parts_done() const;
  const std::string& note() const;

  /// Writes the next part, which begins at `first`, and a note, one line. Errors: IoError, Cancelled.
  void write(TableValues part, const PerAxis& first, const std::string& note);
  /// Makes the file, with more attributes. Errors: IoError, Cancelled; PATH is as it was then.
  void finish(const std::vector<Attribute>& more);

  /// How to go on with what is there, if it is any: one sentence.
  std::optional<std::string> rest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
