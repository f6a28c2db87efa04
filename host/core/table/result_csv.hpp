// Results as CSV: of points and of tables.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include <dolp/results.hpp>
#include "base/atomic_file.hpp"

namespace dolp {

/// Appends the cells of a row before those of its results, a comma after each.
using RowStart = std::function<void(std::string& text, std::size_t row)>;

/// The names of quantities and of the status, with commas between them.
std::string result_header(const Quantities& quantities, bool has_status = true);

/// A row for each result: its start, the quantities in the order given, the status.
std::string result_rows(const ResultColumns& results, std::size_t rows, const Quantities& quantities,
                        const RowStart& start);

/// Some quantities in the order of CSV files of points.
Quantities in_csv_order(const Quantities& quantities);

/// Writer of points and their results as CSV. The file is complete or absent. Rows go to a file as they come, and to
/// "-", standard output, when all are complete.
class ResultCsv {
 public:
  /// `columns`: the names of the cells that `start` appends. Errors: IoError.
  ResultCsv(const std::filesystem::path& path, const std::string& columns, const Quantities& quantities,
            RowStart start);
  /// Results of the points after those before. Errors: IoError; Cancelled when interrupted().
  void append(std::span<const PointResult> results);
  /// Errors: likewise.
  void commit();

 private:
  void write(const std::string& text);

  Quantities quantities_;
  RowStart start_;
  std::optional<AtomicFile> file_;  ///< none for standard output
  std::string text_;                ///< for standard output
  std::size_t done_ = 0;
};

}  // namespace dolp
