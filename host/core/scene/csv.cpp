#include "scene/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <utility>

#include "base/text.hpp"

namespace dolp {
namespace {

constexpr double kWholeInPercent = 100.0;
constexpr std::string_view kSeparators = ";,\t ";

/// The text inside the double quotes around a cell. A cell with further double quotes stays unchanged.
std::string_view unquoted(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  const std::string_view inner = is_quoted ? cell.substr(1, cell.size() - 2) : cell;
  return inner.find('"') == std::string_view::npos ? inner : cell;
}

bool begins_with_bracket(std::string_view cell) {
  return !cell.empty() && (cell.front() == '(' || cell.front() == '[');
}

bool are_numbers(const std::vector<std::string_view>& cells) {
  return std::ranges::all_of(cells, [](std::string_view cell) { return parse_number(cell) || is_nan_text(cell); });
}

}  // namespace

bool is_comment_line(std::string_view line) {
  const std::string_view text = trim(line);
  return !text.empty() && (text.front() == '#' || text.front() == '!' || text.front() == '%');
}

bool is_nan_text(std::string_view cell) { return lower_case(cell) == "nan"; }

std::vector<char> separators_in(std::string_view line) {
  std::string found;
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted) found += c;
  }
  std::vector<char> separators;
  for (const char separator : kSeparators) {
    if (found.find(separator) != std::string::npos) separators.push_back(separator);
  }
  if (separators.empty()) separators.push_back(',');
  return separators;
}

std::vector<std::string_view> split_cells(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    const auto separates = [separator](char c) { return c == separator || (separator == ' ' && c == '\t'); };
    const bool is_end = i == line.size() || (separates(line[i]) && !is_quoted);
    if (!is_end) continue;
    const std::string_view cell = unquoted(trim(line.substr(begin, i - begin)));
    const bool is_unit = separator == ' ' && begins_with_bracket(cell) && !cells.empty();
    if (is_unit && !begins_with_bracket(cells.back())) {
      const auto start = static_cast<std::size_t>(cells.back().data() - line.data());
      cells.back() = line.substr(start, i - start);
    } else if (separator != ' ' || !cell.empty()) {
      cells.push_back(cell);
    }
    begin = i + 1;
  }
  return cells;
}

CsvReader::CsvReader(std::string_view text, std::string name, CsvForm form)
    : lines_(split_lines(text)), name_(std::move(name)), form_(form), separator_(form.separator) {
  const std::string blanks = std::string(" \t") + (form_.separator ? std::string(1, *form_.separator) : ",;");
  while (!lines_.empty() && lines_.back().find_first_not_of(blanks) == std::string_view::npos) lines_.pop_back();
}

bool CsvReader::has_cells(std::string_view line) const {
  return line.empty() ? !form_.has_blank_lines : !is_comment_line(line);
}

bool CsvReader::next() {
  if (std::exchange(stays_, false)) return true;
  const bool is_above_cells = cells_.empty();
  while (read_ < lines_.size()) {
    line_ = trim(lines_[read_++]);
    if (is_above_cells && line_.empty()) continue;
    if (has_cells(line_)) {
      split_line();
      return true;
    }
    if (is_above_cells) comments_.push_back(line_);
  }
  return false;
}

void CsvReader::split_line() {
  cells_ = split_cells(line_, separator_.value_or(separators_in(line_).front()));
  if (form_.separator || (cells_.size() > 1 && parse_number(cells_.front()))) return;
  // Numbers may have another separator than the names above them. Below names with semicolons, a comma may be decimal.
  const bool has_blanks = !separator_ || *separator_ == ' ' || *separator_ == '\t';
  for (const char separator : separators_in(line_)) {
    std::vector<std::string_view> numbers = split_cells(line_, separator);
    const bool is_allowed = has_blanks || separator == ' ' || separator == '\t';
    if (is_allowed && are_numbers(numbers)) return cells_.swap(numbers);
  }
}

void CsvReader::separate_by(char separator) {
  if (form_.separator) return;
  separator_ = separator;
  split_line();
}

std::string_view CsvReader::line_below() const {
  const auto below = std::find_if(lines_.begin() + static_cast<std::ptrdiff_t>(read_), lines_.end(),
                                  [&](std::string_view line) { return has_cells(trim(line)); });
  return below == lines_.end() ? std::string_view{} : trim(*below);
}

bool CsvReader::has_numbers() const {
  return std::ranges::any_of(cells_, [](std::string_view cell) { return parse_number(cell).has_value(); });
}

bool CsvReader::has_only_numbers() const { return has_numbers() && are_numbers(cells_); }

std::size_t CsvReader::line_number() const { return form_.first_line + std::max(read_, std::size_t{1}) - 1; }

std::string CsvReader::where() const { return fmt::format("{}:{}: ", name_, line_number()); }

void CsvReader::fail(const std::string& what) const { throw InputError(where() + what); }

double CsvReader::number(std::size_t cell, std::string_view column, const NumberRange* range) const {
  const std::string allowed = range ? "; must be a number in " + range->text() : "";
  const std::string_view text = cell < cells_.size() ? cells_[cell] : std::string_view{};
  if (range && text.empty()) fail(fmt::format("{}: the value is missing{}", column, allowed));
  const std::optional<double> value = parse_number(text);
  if (!value) {
    std::string with_point(text);
    std::ranges::replace(with_point, ',', '.');
    fail(fmt::format("{} = {}: not a number{}{}", column, one_line(text), allowed,
                     parse_number(with_point) ? "; numbers must have a decimal point" : ""));
  }
  if (range && !range->contains(*value)) {
    const double size = std::abs(*value);
    const bool is_percent = range->max == 1.0 && size > 1.0 && size <= kWholeInPercent;
    fail(fmt::format("{} = {}: out of range{}{}", column, one_line(text), allowed,
                     is_percent ? ", a fraction and not percent" : ""));
  }
  return *value;
}

}  // namespace dolp
