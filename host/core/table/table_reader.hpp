// A table in a file, read part by part.
#pragma once

#include <dolp/errors.hpp>
#include <filesystem>
#include <memory>
#include <span>

#include "table/table_box.hpp"
#include "table/values_hash.hpp"

namespace dolp {

/// An open .nc table. Errors of all: InputError for a file that cannot be opened, is not such a table, is damaged, or
/// claims more values than a file of its size can hold.
class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path);
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;
  ~TableReader();

  const TableHead& head() const;
  /// The quantities that the table has.
  const Quantities& quantities() const;
  bool has_status() const;

  TableValues read(const TableBox& box) const;
  /// The values of some entries, at ascending positions: each quantity has one for each of them. All are read, part by
  /// part, and refused as by check_hash. Errors: also Cancelled.
  TableValues read_entries(std::span<const std::size_t> positions, const Progress& progress) const;

  /// Contribution of a part that was read to the hash.
  ValueSums sums_of(const TableValues& part, const TableBox& box) const;
  /// Refuses values that differ from the written ones, or whose hash is missing, by the sums over all parts.
  void check_hash(const ValueSums& sums) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
