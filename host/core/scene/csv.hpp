#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>

namespace dolp {

struct CsvForm {
  /// ' ' means any number of blanks and tabs. nullopt: the line of names decides among semicolon, comma, tab and
  /// blanks.
  std::optional<char> separator = ',';
  bool has_blank_lines = true;  ///< true: blank lines are skipped; false: below the names they are one empty cell
  std::size_t first_line = 1;
};

bool is_comment_line(std::string_view line);  ///< true if `line` begins with #, ! or %
bool is_nan_text(std::string_view cell);      ///< true for "nan" in upper or lower case

/// The separators in a line, outside quotes, from the likeliest to the least likely; a comma if there is none.
std::vector<char> separators_in(std::string_view line);

/// The cells of a line, without blanks at both ends. With the separator ' ', text in brackets belongs to the cell
/// before it, as in "wavelength (um)".
std::vector<std::string_view> split_cells(std::string_view line, char separator);

/// Goes through a text line by line: `for (CsvReader row(text, name); row.next();)`. A cell in double quotes may have
/// separators. Skips comment lines, and lines without values at the end. `text` must outlive the reader.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string name, CsvForm form = {});

  /// Goes to the next line that has cells; false after the last line.
  bool next();
  /// Makes the next call of next() stay at this line.
  void stay() { stays_ = true; }

  /// The line and its cells, without blanks at both ends.
  std::string_view line() const { return line_; }
  const std::vector<std::string_view>& cells() const { return cells_; }
  bool has_numbers() const;
  bool has_only_numbers() const;  ///< true if each cell is a number or nan

  /// The next line that has cells; empty after the last line.
  std::string_view line_below() const;
  /// The comment lines above the first line with cells.
  const std::vector<std::string_view>& comments() const { return comments_; }

  /// Separates this line and the lines below it by `separator`, if the form leaves the separator open.
  void separate_by(char separator);
  std::optional<char> separator() const { return separator_; }  ///< nullopt if each line has its own

  std::size_t line_number() const;

  /// "file:line: ", with which a message begins. Before the first next() it names the first line.
  std::string where() const;
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in a cell of the line. Errors: InputError that names file, line, `column`, value and `range`.
  double number(std::size_t cell, std::string_view column, const NumberRange* range = nullptr) const;

 private:
  bool has_cells(std::string_view line) const;
  void split_line();

  std::vector<std::string_view> lines_;
  std::string name_;
  CsvForm form_;
  std::optional<char> separator_;
  std::size_t read_ = 0;  // lines
  bool stays_ = false;
  std::string_view line_;
  std::vector<std::string_view> cells_, comments_;
};

}  // namespace dolp
