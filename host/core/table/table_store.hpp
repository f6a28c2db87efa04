#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/atomic_file.hpp"
#include "table/table.hpp"

namespace dolp {

/// Writes a table as a netCDF file in a classic format. Its values may come in any order.
class TableStore {
 public:
  enum class Earlier { kRemoved, kKept };
  /// Writes everything but the values to `file`, which must outlive the object. If `earlier` is kKept, the values of an
  /// earlier store with the same layout stay. Errors of all calls: IoError; Cancelled if interrupted(); std::bad_alloc.
  TableStore(const TableLayout& layout, AtomicFile& file, Earlier earlier = Earlier::kRemoved);
  TableStore(const TableStore&) = delete;
  TableStore& operator=(const TableStore&) = delete;
  ~TableStore();

  /// Writes a part. Returns the checksums of the part, for the caller to add up.
  ValueSums write(const TableValues& part, const PerAxis& first);
  TableValues read(const GridBox& box) const;
  /// The checksums of a part as the file contains it; nullopt if the part cannot be read.
  std::optional<ValueSums> measured(const GridBox& box) const;
  /// Adds attributes and closes the file. `sums`: checksums of all parts.
  void finish(std::vector<Attribute> more, const ValueSums& sums);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
