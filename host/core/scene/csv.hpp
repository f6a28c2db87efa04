// Comma-separated text, as people and programs write it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>

namespace dolp {

struct CsvForm {
  char separator = ',';         ///< with ' ', any number of blanks separates two cells
  bool has_blank_lines = true;  ///< leaves blank lines out; lines that begin with # are always left out
  std::size_t first_line = 1;
};

/// Goes through a text line by line: `for (CsvReader row(text, name); row.next();)`.
///
/// Accepts what split_lines does. A cell in double quotes may hold separators; its value is the text between the
/// quotes. Leaves out rows without any value at the end of the text. All views are into `text`.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string name, CsvForm form = {});

  /// The next line that holds cells; false after the last.
  bool next();

  /// The line, and its cells, without blanks at both ends.
  std::string_view line() const { return line_; }
  const std::vector<std::string_view>& cells() const { return cells_; }
  /// True if a cell is a number.
  bool has_numbers() const;

  std::size_t line_number() const;

  /// "file:line: ", the beginning of every message about the line, or about the first before there is one.
  std::string where() const;
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in a cell, whose column is called `column`.
  /// Errors: InputError that names file, line, column and value and, with `range`, what is allowed.
  double number(std::size_t cell, std::string_view column, const NumberRange* range = nullptr) const;

 private:
  std::vector<std::string_view> lines_;
  std::string name_;
  CsvForm form_;
  std::size_t read_ = 0;  // lines
  std::string_view line_;
  std::vector<std::string_view> cells_;
};

/// A column that a file may have.
struct CsvColumn {
  std::string name;
  NumberRange range = {};
  bool is_required = false;
  std::string other_name = {};  ///< another name that the column may have
  std::string unit = {};        ///< for messages, if the name has no unit
};

/// The columns of a file, found by the names in its header, in any order and in upper or lower case.
class CsvColumns {
 public:
  /// Leaves out columns whose names are in `ignored`.
  /// Errors: InputError for a name that is unknown, with the nearest known one if it is near, or appears twice; for a
  /// required column that is missing; for another separator; for a line of numbers.
  CsvColumns(const CsvReader& header, std::vector<CsvColumn> known, const std::vector<std::string>& ignored = {});

  /// All known columns in their order, for rows without a header.
  explicit CsvColumns(std::vector<CsvColumn> known);
  /// Reads the header as well. Errors: InputError for a text without one.
  static CsvColumns first_of(CsvReader& reader, std::vector<CsvColumn> known,
                             const std::vector<std::string>& ignored = {});

  bool has(std::string_view name) const { return cell_of(name).has_value(); }

  /// The position of each cell's column among the known columns; nullopt for a column that is left out.
  const std::vector<std::optional<std::size_t>>& cells() const { return cells_; }

  /// The number that a row has in a column; nullopt for a column that the file lacks.
  /// Errors: InputError with column, value and range, and for a row with more cells than the header.
  std::optional<double> number(const CsvReader& row, std::string_view name) const;
  double number_at(const CsvReader& row, std::size_t cell) const;

  /// Refuses a row with other separators, or with more cells than the header.
  void check_width(const CsvReader& row) const;

 private:
  std::optional<std::size_t> cell_of(std::string_view name) const;

  std::vector<CsvColumn> known_;
  std::vector<std::optional<std::size_t>> cells_;
  std::vector<std::string> names_;  // in the file
};

/// Message about an unknown column: the allowed columns, and the nearest name if it is near.
std::string unknown_column(std::string_view name, const std::vector<CsvColumn>& known);

}  // namespace dolp
