#pragma once

#include <filesystem>
#include <string>

#include "table/table.hpp"

namespace dolp {

/// A table as the bytes of a NetCDF-4 file. They are made in memory: HDF5 does not survive a disk that fills up.
///
/// Errors: IoError that names `path`.
std::string netcdf_bytes(const Table& table, const std::filesystem::path& path);

}  // namespace dolp
