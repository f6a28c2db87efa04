// Tables as files. The suffix chooses the format; every file is complete or absent.
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

/// Appends the first cells of a row, with a comma after each; the results follow.
using RowStart = std::function<void(std::string& text, std::size_t row)>;

/// The names of quantities and of the status, with commas between them.
std::string result_header(const Quantities& quantities, bool has_status = true);

/// A row for each result: its start, the quantities in the order given, the status.
std::string result_rows(const ResultColumns& results, std::size_t rows, const Quantities& quantities,
                        const RowStart& start);

/// The quantities in the order of CSV files of points.
Quantities in_csv_order(const Quantities& quantities);

/// Writer of points and their results as CSV. The file is complete or absent. Rows go to a file as they come, and to
/// "-", standard output, when all are complete.
class ResultCsv {
 public:
  /// `columns`: the names of the cells that `start` appends. Errors: IoError.
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
  std::optional<AtomicFile> file_;  ///< none for standard output
  std::string text_;                ///< for standard output
  std::size_t done_ = 0;
};

enum class TableFormat { kNetcdf, kCsv, kNpy };

/// The format that the suffix chooses. Errors: InputError for another suffix.
TableFormat format_of(const std::filesystem::path& path);

/// Refuses an output path for a table, before anything is computed for it.
///
/// Domain: a name ending in .nc, .csv or .npy in a folder that can be written to, or "-" (CSV on standard output).
/// Errors: InputError for another suffix, IoError for a folder or file that cannot be written.
void check_output_path(const std::filesystem::path& path);

/// Writes a table.
///
/// .nc: NetCDF-4, CF-1.8, coordinates wavelength, n, k where the table has them, theta, sigma, q; status is an int
/// (CF-1.8 has no unsigned int). Nothing is compressed. .csv and "-": one row per entry,
/// `wavelength_um,n,k,theta_deg,sigma,q` and the variables; attributes as `# name: value` lines before the header, a
/// newline inside a value going on with `#   `. Numbers are the shortest text that reads back as the same double. .npy:
/// a structured array of the shape of the axes with the named fields of the .csv, so that `t["dolp"][i, j, k]` and
/// `t["theta_deg"][:, 0, 0]` work. The format has no attributes. Errors: errors of check_output_path; IoError when
/// writing fails, after which the target is as it was.
void write_table(const TableValues& table, const std::filesystem::path& path);

/// The start of a .csv or .npy, and the rows of a part of the table; the parts follow each other.
std::string table_start(const TableLayout& layout, TableFormat format);
std::string table_rows(const TableValues& part, const TableLayout& layout, TableFormat format);

/// Reads a whole table that was written as .nc. Errors: errors of TableReader.
TableValues read_table(const std::filesystem::path& path);

}  // namespace dolp
