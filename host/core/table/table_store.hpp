// A table on disk, written part by part.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/atomic_file.hpp"
#include "table/table.hpp"

namespace dolp {

/// A NetCDF-4 table that is being written. Its values may come in any order. Checksums of HDF5 protect names, shapes
/// and attributes; the hash protects the values. HDF5 makes everything except the values in memory, because it does not
/// survive a full disk. A text too long for an attribute is a variable of characters with the attribute's name.
class TableStore {
 public:
  /// `file` must outlive the object; nothing is written to it yet.
  /// Errors: IoError, also where files may not be as long as the table; std::bad_alloc.
  TableStore(const TableLayout& layout, AtomicFile& file);
  TableStore(const TableStore&) = delete;
  TableStore& operator=(const TableStore&) = delete;
  ~TableStore();

  /// Puts the values of a part, which has the layout's quantities, in their places; returns their sums, which the
  /// caller adds up. Errors: IoError, Cancelled.
  ValueSums write(const TableValues& part, const PerAxis& first);
  /// Reads a part back. Errors: IoError.
  TableValues read(const TableBox& box) const;
  /// The sums of a part as it is in the file now; nothing if it cannot be read.
  std::optional<ValueSums> measured(const TableBox& box) const;
  /// Writes the rest of the file, with more attributes. `sums`: sums over all values. Errors: IoError, Cancelled.
  void finish(std::vector<Attribute> more, const ValueSums& sums);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
