// A table on disk, written part by part.
#pragma once

#include <vector>

#include "base/atomic_file.hpp"
#include "table/table.hpp"
#include "table/table_netcdf.hpp"

namespace dolp {

/// Place of a part of a table in the whole: from `first` on `count` values of each axis.
struct TableBox {
  PerAxis first = {};
  PerAxis count = {};
};

/// Boxes of at most `most` entries each, or of one, that follow each other in the order of the table.
std::vector<TableBox> boxes_in_order(const PerAxis& counts, std::size_t most);

/// The head of a part of a table.
TableHead head_of(const TableHead& whole, const TableBox& box);

/// A NetCDF-4 table under way in a file: its values may come in any order, each once.
class TableStore {
 public:
  /// `file` must outlive the object; nothing is written to it yet. Errors: std::bad_alloc.
  TableStore(const TableLayout& layout, AtomicFile& file);

  /// Puts the values of a part, which has the layout's quantities, in their places. Errors: IoError, Cancelled.
  void write(const TableValues& part, const PerAxis& first);
  /// Reads a part back. Errors: IoError.
  TableValues read(const TableBox& box) const;
  /// Writes the rest of the file, with more attributes, after all values. Errors: IoError, Cancelled.
  void finish(const std::vector<Attribute>& more);

  /// Contribution of the values written so far to the hash; restore it before a run continues.
  const ValuesHash::Sums& sums() const { return sums_; }
  void set_sums(ValuesHash::Sums sums) { sums_ = std::move(sums); }

 private:
  TableLayout layout_;
  AtomicFile& file_;
  NetcdfSkeleton skeleton_;
  ValuesHash::Sums sums_;
};

}  // namespace dolp
