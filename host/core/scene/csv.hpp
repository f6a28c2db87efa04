// Comma-separated text, as people and programs write it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>

namespace dolp {

struct CsvForm {
  char separator = ',';         ///< with ' ', any number of blanks separates two cells
  bool has_blank_lines = true;  ///< they are left out, as lines that begin with # always are
  std::size_t first_line = 1;
};

/// Goes through a text line by line: `for (CsvReader row(text, name); row.next();)`.
///
/// Accepts what split_lines does; a cell in double quotes may hold separators, and is what is between the quotes. All
/// views are into `text`.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::string name, CsvForm form = {});

  /// The next line that holds cells; false after the last.
  bool next();

  /// The line, and its cells, without blanks at both ends.
  std::string_view line() const { return line_; }
  const std::vector<std::string_view>& cells() const { return cells_; }

  std::size_t line_number() const;

  /// "file:line: ", the beginning of every message about the line, or about the first before there is one.
  std::string where() const;
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in a cell, whose column is called `column`.
  /// Errors: InputError that names file, line, column and value and, with `range`, what is allowed.
  double number(std::size_t cell, std::string_view column, const NumberRange* range = nullptr) const;

  /// The position of a column in this line of names. Errors: InputError where it is missing.
  std::size_t position(std::string_view column, const NumberRange& range) const;

 private:
  std::vector<std::string_view> lines_;
  std::string name_;
  CsvForm form_;
  std::size_t read_ = 0;  // lines
  std::string_view line_;
  std::vector<std::string_view> cells_;
};

}  // namespace dolp
