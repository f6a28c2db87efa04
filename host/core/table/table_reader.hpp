#pragma once

#include <dolp/errors.hpp>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// Reads a .nc table part by part. Errors of all calls: InputError for a file that cannot be opened, is not a table of
/// dolp, is damaged, or claims more values than a file of its size can hold.
class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path);
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;
  ~TableReader();

  const TableLayout& layout() const;
  const TableHead& head() const { return layout().head; }

  TableValues read(const GridBox& box) const;
  /// Reads the entries at the ascending `positions`, and checks the hash of the whole table. May also throw Cancelled.
  TableValues read_entries(std::span<const std::size_t> positions, const Progress& progress) const;

  ValueSums value_sums(const TableValues& part, const GridBox& box) const;
  /// Refuses a file that lacks a hash, or whose values changed since dolp wrote them. `sums`: checksums of the table.
  void check_hash(const ValueSums& sums) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The attributes of a table, from which table_scene() restores the scene. Does not look at axes and values, so the
/// file may hold a part of a table. Errors: InputError.
std::vector<Attribute> read_attributes(const std::filesystem::path& path);

/// In a part of a table that xarray saved, axes may have one value and no dimension. Returns the columns of these axes,
/// such as "sigma", or keys of a scene, such as "path.transmittance", with their values.
std::vector<std::pair<std::string, double>> read_lone_values(const std::filesystem::path& path);

}  // namespace dolp
