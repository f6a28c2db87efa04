// Tables, which are NetCDF.
#include "fuzz.hpp"
#include "table/table_file.hpp"

/// HDF5 1.10 leaks memory on some damaged files.
extern "C" const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

void dolp::fuzz::read(const std::string& text) {
  static const InputFile file(".nc");
  file.write(text);
  refused([&] { dolp::read_table(file.path()); });
}
