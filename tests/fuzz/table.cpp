// Fuzzes the reader of tables in NetCDF.
#include "fuzz.hpp"
#include "table/table_file.hpp"

void dolp::fuzz::read(const std::string& text) {
  static const InputFile file(".nc");
  file.write(text);
  refused([&] { dolp::read_table(file.path()); });
}
