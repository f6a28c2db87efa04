#pragma once

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>

#include "table/table.hpp"

namespace dolp {

/// The bytes of a file, in memory of the netCDF library's.
class NetcdfBytes {
 public:
  NetcdfBytes(void* memory, std::size_t size) : memory_(memory, &std::free), size_(size) {}
  std::string_view view() const { return {static_cast<const char*>(memory_.get()), size_}; }

 private:
  std::unique_ptr<void, decltype(&std::free)> memory_;
  std::size_t size_;
};

/// A table as the bytes of a NetCDF-4 file. They are made in memory: HDF5 does not survive a disk that fills up.
///
/// Errors: IoError that names `path`.
NetcdfBytes netcdf_bytes(const Table& table, const std::filesystem::path& path);

}  // namespace dolp
