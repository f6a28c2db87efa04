// Fuzzes the reader of tables in NetCDF.
#include "fuzz.hpp"
#include "table/table_file.hpp"

/// The leak sanitizer ignores leaks of HDF5 1.10, which occur with some damaged files.
extern "C" const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

void dolp::fuzz::read(const std::string& text) {
  static const InputFile file(".nc");
  file.write(text);
  refused([&] { dolp::read_table(file.path()); });
}
