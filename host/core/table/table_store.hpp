#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/atomic_file.hpp"
#include "table/table.hpp"

namespace dolp {

/// Writes a NetCDF-4 table whose values may come in any order. Everything except the values is made in memory first,
/// because HDF5 crashes if a disk is full. A text that is too long for an attribute becomes a variable.
class TableStore {
 public:
  /// `file` must outlive the object. The constructor writes nothing to it.
  /// Errors: IoError, for example if the table is longer than the system allows for a file; std::bad_alloc.
  TableStore(const TableLayout& layout, AtomicFile& file);
  TableStore(const TableStore&) = delete;
  TableStore& operator=(const TableStore&) = delete;
  ~TableStore();

  /// Writes a part. Returns the checksums of the part, for the caller to add up. Errors: IoError, Cancelled.
  ValueSums write(const TableValues& part, const PerAxis& first);
  TableValues read(const TableBox& box) const;
  /// The checksums of a part as the file contains it; nullopt if the part cannot be read.
  std::optional<ValueSums> measured(const TableBox& box) const;
  /// Adds attributes and writes all except the values. `sums`: checksums of all parts. Errors: IoError, Cancelled.
  void finish(std::vector<Attribute> more, const ValueSums& sums);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
