#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>

namespace dolp {

struct CsvForm {
  char separator = ',';         ///< if it is ' ', any number of blanks separates two cells
  bool has_blank_lines = true;  ///< true: blank lines are skipped; false: a blank line is one empty cell
  std::size_t first_line = 1;
};

/// Goes through a text line by line: `for (CsvReader row(text, name); row.next();)`. A cell in double quotes may have
/// separators. Skips lines that begin with #, and lines without values at the end. `text` must outlive the reader.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string name, CsvForm form = {});

  /// Goes to the next line that has cells; false after the last line.
  bool next();

  /// The line and its cells, without blanks at both ends.
  std::string_view line() const { return line_; }
  const std::vector<std::string_view>& cells() const { return cells_; }
  bool has_numbers() const;

  std::size_t line_number() const;

  /// "file:line: ", with which a message begins. Before the first next() it names the first line.
  std::string where() const;
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in a cell of the line. Errors: InputError that names file, line, `column`, value and `range`.
  double number(std::size_t cell, std::string_view column, const NumberRange* range = nullptr) const;

 private:
  std::vector<std::string_view> lines_;
  std::string name_;
  CsvForm form_;
  std::size_t read_ = 0;  // lines
  std::string_view line_;
  std::vector<std::string_view> cells_;
};

struct CsvColumn {
  std::string name;
  NumberRange range = {};
  bool is_required = false;
  std::string other_name = {};  ///< a second name that the column may have
  std::string unit = {};        ///< unit for messages, if `name` does not contain it
};

/// The columns of a file. The header may name them in any order, in upper or lower case.
class CsvColumns {
 public:
  /// Ignores the columns in `ignored`. Errors: InputError for a repeated, missing or unknown name, for a separator
  /// other than the comma, and for numbers instead of names. The message about an unknown name lists the known names.
  CsvColumns(const CsvReader& header, std::vector<CsvColumn> known, const std::vector<std::string>& ignored = {});

  /// For a file without a header. Its rows have all columns in the order of `known`.
  explicit CsvColumns(std::vector<CsvColumn> known);
  /// Reads the first line of a text as a header. Errors: errors of CsvColumns, and InputError for a text without lines.
  static CsvColumns first_of(CsvReader& reader, std::vector<CsvColumn> known,
                             const std::vector<std::string>& ignored = {});

  bool has(std::string_view name) const { return cell_of(name).has_value(); }

  /// For each cell of a row, the position of its column in the list of known columns; nullopt if the column is ignored.
  const std::vector<std::optional<std::size_t>>& cells() const { return cells_; }

  /// The number of `row` in the column `name`; nullopt if the file lacks this column. Errors: InputError for a bad row.
  std::optional<double> number(const CsvReader& row, std::string_view name) const;
  double number_at(const CsvReader& row, std::size_t cell) const;

  /// Refuses a row with a separator other than the comma, or with more cells than the header.
  void check_width(const CsvReader& row) const;

 private:
  std::optional<std::size_t> cell_of(std::string_view name) const;

  std::vector<CsvColumn> known_;
  std::vector<std::optional<std::size_t>> cells_;
  std::vector<std::string> names_;  // column names in the file's header
};

std::string unknown_column(std::string_view name, const std::vector<CsvColumn>& known);

}  // namespace dolp
