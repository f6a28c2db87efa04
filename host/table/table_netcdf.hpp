// How a table lies in a NetCDF-4 file.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "table/hdf5_handle.hpp"
#include "table/table.hpp"

namespace dolp {

/// A coordinate of a table in a file.
struct NetcdfAxis {
  const char* name;
  const char* long_name;
  const char* units;
  std::vector<double> Table::*values;
};
inline constexpr std::array<NetcdfAxis, 3> kNetcdfAxes = {{
    {"theta", "zenith angle", "degree", &Table::theta_deg},
    {"sigma", "roughness sigma of the slope distribution", "1", &Table::sigma},
    {"q", "exponent q of the slope distribution", "1", &Table::q},
}};

/// The attribute that holds values_hash.
inline constexpr const char* kValuesHash = "values_hash";

/// A hash over all axes and variables, by which damage is found; nothing more.
std::string values_hash(const Table& table);

/// A table as the bytes of a NetCDF-4 file. They are made in memory: HDF5 does not survive a disk that fills up.
///
/// HDF5 protects names, shapes and attributes with checksums, values_hash the values. A text too long for an attribute
/// of the netCDF library is a variable of characters with the attribute's name.
class NetcdfImage {
 public:
  /// Errors: std::bad_alloc.
  explicit NetcdfImage(const Table& table);
  std::string_view bytes() const { return bytes_; }

 private:
  Hdf5Handle file_;
  std::string_view bytes_;
};

}  // namespace dolp
