#pragma once

#include <dolp/results.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/atomic_file.hpp"
#include "table/table.hpp"

namespace dolp {

/// Appends the leading cells of CSV row `row` to `text`, each with a comma after it. The results follow them.
using RowStart = std::function<void(std::string& text, std::size_t row)>;

/// CSV rows `first` to `last` - 1 of the results. A row has the cells that `start` appends, the quantities in the given
/// order, the derivatives, the status.
std::string result_rows(const ResultColumns& results, std::size_t first, std::size_t last, const Quantities& quantities,
                        const RowStart& start);

Quantities in_csv_order(const Quantities& quantities);

/// Writes points with their results as CSV. A file is complete or absent; standard output ("-") gets all rows at once.
class ResultCsv {
 public:
  /// `columns`: names of the columns whose cells `start` appends. Errors: IoError.
  ResultCsv(const std::filesystem::path& path, const std::string& columns, const TableLayout& layout, RowStart start);
  /// Adds the results of the next points. Errors: IoError; Cancelled when interrupted().
  void append(const ResultColumns& results);
  /// Completes the file. Errors: IoError; Cancelled when interrupted().
  void commit();

 private:
  void write(const std::string& text);

  Quantities quantities_;
  RowStart start_;
  std::optional<AtomicFile> file_;  ///< nullopt for standard output
  std::string text_;                ///< rows for standard output
  std::size_t done_ = 0;
};

enum class TableFormat { kNetcdf, kCsv, kNpy };

/// Errors: InputError for an unknown suffix.
TableFormat table_format(const std::filesystem::path& path);

/// Refuses an unsuitable output path before the table is computed. Errors: InputError if the suffix is not .nc, .csv or
/// .npy; IoError if the folder or file cannot be written. "-" is standard output.
void check_output_path(const std::filesystem::path& path);

/// The suffix of the path chooses the format.
/// .nc: a classic format of netCDF, with the conventions CF-1.8.
/// .csv and "-": one row per entry. The columns are the axes of the table, such as `wavelength_um,theta_deg`, then the
/// variables. Each attribute is a line `# name: value` before the header; further lines of a value begin with `#   `.
/// .npy: a structured array with the shape of the axes and the column names of a .csv, such as `t["dolp"][i, j, k]`.
void write_table(const TableValues& table, const std::filesystem::path& path);

/// The text of a .csv or .npy file is table_start(), then table_rows() of each part in the order of the table.
std::string table_start(const TableLayout& layout, TableFormat format);
std::string table_rows(const TableValues& part, const TableLayout& layout, TableFormat format);

/// Reads a whole table that was written as .nc. Errors: errors of TableReader.
TableValues read_table(const std::filesystem::path& path);

}  // namespace dolp
