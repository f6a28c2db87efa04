#pragma once

#include <netcdf.h>
#include <netcdf_mem.h>

#include <cerrno>
#include <cstdint>
#include <mutex>
#include <vector>

#include "table/table.hpp"

namespace dolp {

/// The calls of netCDF-C hold this lock, because they are not safe in threads.
inline std::mutex& netcdf_lock() {
  static std::mutex lock;
  return lock;
}

/// An open netCDF file, or none.
class NetcdfFile {
 public:
  NetcdfFile() = default;
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  /// Calls nc_abort, because nc_close keeps a file open if it fails, for example on a full disk.
  ~NetcdfFile() {
    if (is_open_) call(nc_abort);
  }

  /// Opens a file by open(&id), which calls nc_open or nc__create. This and close() return the status of netCDF-C.
  template <class Open>
  int open(const Open& open) {
    const std::scoped_lock lock(netcdf_lock());
    const int status = open(&id_);
    is_open_ = status == NC_NOERR;
    return status;
  }
  int close() {
    const int status = call(nc_close);
    is_open_ = status != NC_NOERR;
    return status;
  }
  /// Returns the status of function(file, arguments...), a call of netCDF-C.
  template <class Function, class... Arguments>
  int call(const Function& function, Arguments... arguments) const {
    const std::scoped_lock lock(netcdf_lock());
    return function(id_, arguments...);
  }

 private:
  int id_ = 0;
  bool is_open_ = false;
};

inline bool is_lack_of_memory(int status) { return status == NC_ENOMEM || status == ENOMEM; }

/// The place of a box of entries in a variable.
struct Hyperslab {
  std::vector<std::size_t> first, count;

  /// A variable may have `width` values per entry in a last dimension. Other variables ignore this dimension.
  Hyperslab(const TableHead& head, const GridBox& box, std::size_t width) {
    for (const Axis axis : kAllAxes) {
      if (head.axes[axis].empty()) continue;
      first.push_back(box.first[axis]);
      count.push_back(box.count[axis]);
    }
    first.push_back(0);
    count.push_back(width);
  }
};

inline int get_values(const NetcdfFile& file, int variable, const Hyperslab& at, double* values) {
  return file.call(nc_get_vara_double, variable, at.first.data(), at.count.data(), values);
}
inline int get_values(const NetcdfFile& file, int variable, const Hyperslab& at, std::uint32_t* values) {
  return file.call(nc_get_vara_uint, variable, at.first.data(), at.count.data(), values);
}

}  // namespace dolp
