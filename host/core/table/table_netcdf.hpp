// Layout of a table in a NetCDF-4 file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// The attribute that holds the hash of ValuesHash.
inline constexpr const char* kValuesHash = "values_hash";

/// A hash over the values of a table, only to detect damage. Values may come in any order: a sum of
/// their bits, each times an odd number that follows from its place, so that another value or place changes it.
class ValuesHash {
 public:
  /// With the axes and curves of the head.
  explicit ValuesHash(const TableHead& head);
  /// One number for each of the quantities and status.
  using Sums = std::vector<std::uint64_t>;
  static std::uint64_t sum(std::span<const double> values, std::size_t first_place);
  static std::uint64_t sum(std::span<const std::uint32_t> values, std::size_t first_place);
  std::string text(const Quantities& quantities, const Sums& sums) const;

 private:
  std::uint64_t hash_;
};

/// A NetCDF-4 file of a table without its values, which are to be put where it says; HDF5 protects names, shapes and
/// attributes with checksums, the hash the values. It is made in memory: HDF5 does not survive a disk that fills up. A
/// text too long for an attribute of the netCDF library is a variable of characters with the attribute's name.
class NetcdfSkeleton {
 public:
  /// Errors: std::bad_alloc.
  explicit NetcdfSkeleton(const TableLayout& layout);
  NetcdfSkeleton(const NetcdfSkeleton&) = delete;
  NetcdfSkeleton& operator=(const NetcdfSkeleton&) = delete;
  ~NetcdfSkeleton();

  /// Where the values of each of the quantities, and last of status (32 bits each) if it is there, begin in the file.
  const std::vector<std::uint64_t>& offsets() const;

  /// More attributes of the file, after those of the head.
  void add(const std::vector<Attribute>& attributes);

  /// Bytes of the file that are not values.
  struct Piece {
    std::uint64_t offset = 0;
    std::vector<char> bytes;
  };
  std::vector<Piece> pieces() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
