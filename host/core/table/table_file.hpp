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

/// Appends the first cells of a row to `text`, each with a comma after it. The results of the row follow.
using RowStart = std::function<void(std::string& text, std::size_t row)>;

/// Names of the quantities and, if `has_status`, of the status, separated by commas.
std::string result_header(const Quantities& quantities, bool has_status = true);

/// CSV rows. Each row has the cells that `start` appends, then the quantities in the given order, then the status.
std::string result_rows(const ResultColumns& results, std::size_t rows, const Quantities& quantities,
                        const RowStart& start);

Quantities in_csv_order(const Quantities& quantities);

/// Writes points with their results as CSV. A file is complete or absent; standard output ("-") gets all rows at once.
class ResultCsv {
 public:
  /// `columns`: names of the columns whose cells `start` appends. Errors: IoError.
  ResultCsv(const std::filesystem::path& path, const std::string& columns, const Quantities& quantities,
            RowStart start);
  /// Adds the results of the next points. Errors: IoError; Cancelled when interrupted().
  void append(std::span<const PointResult> results);
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
TableFormat format_of(const std::filesystem::path& path);

/// Refuses an output path that a table cannot have, before the table is computed.
/// Domain: suffix .nc, .csv or .npy in a folder that can be written to, or "-" (CSV on standard output).
/// Errors: InputError for another suffix, IoError for a folder or file that cannot be written.
void check_output_path(const std::filesystem::path& path);

/// The suffix of the path chooses the format.
/// .nc: NetCDF-4 with the conventions CF-1.8. Its coordinates are wavelength, n and k if the table has these axes, and
/// theta, sigma, q. The status is an int, because CF-1.8 has no unsigned int. Nothing is compressed.
/// .csv and "-": one row per entry, with the columns `wavelength_um,n,k,theta_deg,sigma,q` and the variables. Each
/// attribute is a line `# name: value` before the header. After a newline inside a value the next line begins with `#`
/// and three blanks. Each number is the shortest text that reads back as the same double.
/// .npy: a structured array with the shape of the axes, without attributes. Its fields have the names of the columns in
/// a .csv, so `t["dolp"][i, j, k]` and `t["theta_deg"][:, 0, 0]` work.
/// Errors: errors of check_output_path; IoError if writing fails, and then the target is unchanged.
void write_table(const TableValues& table, const std::filesystem::path& path);

/// The texts of a .csv or .npy file: its beginning, and the rows of a part. The parts follow in the order of the table.
std::string table_start(const TableLayout& layout, TableFormat format);
std::string table_rows(const TableValues& part, const TableLayout& layout, TableFormat format);

/// Reads a whole table that was written as .nc. Errors: errors of TableReader.
TableValues read_table(const std::filesystem::path& path);

}  // namespace dolp
