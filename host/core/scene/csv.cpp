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
constexpr const char* kDecimalPoint = "numbers must have a decimal point";

/// The text inside the double quotes around a cell. A cell with further double quotes stays unchanged.
std::string_view unquoted(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  const std::string_view inner = is_quoted ? cell.substr(1, cell.size() - 2) : cell;
  return inner.find('"') == std::string_view::npos ? inner : cell;
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
    if (separator != ' ' || !cell.empty()) cells.push_back(cell);
    begin = i + 1;
  }
  return cells;
}

std::string names_of(const std::vector<CsvColumn>& columns) {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns)
    names.push_back(column.unit.empty() ? column.name : fmt::format("{} ({})", column.name, column.unit));
  return join(names);
}

std::optional<std::size_t> position_of(const std::vector<CsvColumn>& columns, std::string_view name) {
  const std::string wanted = lower_case(name);
  const auto found = std::ranges::find_if(columns, [&](const CsvColumn& column) {
    return lower_case(column.name) == wanted || (!wanted.empty() && lower_case(column.other_name) == wanted);
  });
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

void check_separators(const CsvReader& row, const std::vector<CsvColumn>& columns) {
  for (const auto& [character, name] : {std::pair(';', "semicolons"), {'\t', "tabs"}, {' ', "blanks"}}) {
    for (const std::string_view cell : row.cells()) {
      const std::vector<std::string_view> pieces = split(cell, character);
      const bool is_row = std::ranges::any_of(
          pieces, [&](std::string_view piece) { return parse_number(piece) || position_of(columns, trim(piece)); });
      if (pieces.size() > 1 && is_row)
        row.fail(fmt::format("{}: cells must be separated by commas, not {}; {}", one_line(row.line()), name,
                             kDecimalPoint));
    }
  }
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string name, CsvForm form)
    : lines_(split_lines(text)), name_(std::move(name)), form_(form) {
  const std::string blanks = std::string(" \t") + form_.separator;
  while (!lines_.empty() && lines_.back().find_first_not_of(blanks) == std::string_view::npos) lines_.pop_back();
}

bool CsvReader::next() {
  while (read_ < lines_.size()) {
    line_ = trim(lines_[read_++]);
    if (line_.empty() ? form_.has_blank_lines : line_.front() == '#') continue;
    cells_ = split_cells(line_, form_.separator);
    return true;
  }
  return false;
}

bool CsvReader::has_numbers() const {
  return std::ranges::any_of(cells_, [](std::string_view cell) { return parse_number(cell).has_value(); });
}

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
                     parse_number(with_point) ? std::string("; ") + kDecimalPoint : std::string()));
  }
  if (range && !range->contains(*value)) {
    const double size = std::abs(*value);
    const bool is_percent = range->max == 1.0 && size > 1.0 && size <= kWholeInPercent;
    fail(fmt::format("{} = {}: out of range{}{}", column, one_line(text), allowed,
                     is_percent ? ", a fraction and not percent" : ""));
  }
  return *value;
}

CsvColumns::CsvColumns(const CsvReader& header, std::vector<CsvColumn> known, const std::vector<std::string>& ignored)
    : known_(std::move(known)) {
  check_separators(header, known_);
  if (std::ranges::all_of(header.cells(), [](std::string_view cell) { return parse_number(cell).has_value(); }))
    header.fail("the columns must be named first: " + names_of(known_));
  for (const std::string_view cell : header.cells()) {
    names_.emplace_back(cell);
    const std::optional<std::size_t> column = position_of(known_, cell);
    if (!column && std::ranges::find(ignored, cell) == ignored.end()) header.fail(unknown_column(cell, known_));
    if (column && std::ranges::find(cells_, column) != cells_.end())
      header.fail(fmt::format("column \"{}\" appears twice", known_[*column].name));
    cells_.push_back(column);
  }
  std::vector<std::string> missing;
  for (const CsvColumn& column : known_) {
    if (!column.is_required || has(column.name)) continue;
    missing.push_back(fmt::format("column \"{}\" is missing, a number in {}", column.name, column.range.text()));
  }
  if (!missing.empty()) header.fail(fmt::format("{}", fmt::join(missing, "; ")));
}

CsvColumns::CsvColumns(std::vector<CsvColumn> known) : known_(std::move(known)) {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    cells_.emplace_back(i);
    names_.push_back(known_[i].name);
  }
}

CsvColumns CsvColumns::first_of(CsvReader& reader, std::vector<CsvColumn> known,
                                const std::vector<std::string>& ignored) {
  if (!reader.next()) reader.fail("the file is empty; a line of column names is expected: " + names_of(known));
  return {reader, std::move(known), ignored};
}

std::optional<std::size_t> CsvColumns::cell_of(std::string_view name) const {
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (cells_[cell] && known_[*cells_[cell]].name == name) return cell;
  }
  return std::nullopt;
}

std::optional<double> CsvColumns::number(const CsvReader& row, std::string_view name) const {
  check_width(row);
  const std::optional<std::size_t> cell = cell_of(name);
  return cell ? std::optional(number_at(row, *cell)) : std::nullopt;
}

double CsvColumns::number_at(const CsvReader& row, std::size_t cell) const {
  const CsvColumn& column = known_[*cells_[cell]];
  if (cell < row.cells().size()) {
    const std::optional<double> value = parse_number(row.cells()[cell]);
    if (value && column.range.contains(*value)) return *value;
    if (!value) check_separators(row, known_);
  }
  return row.number(cell, column.name, &column.range);  // throws, because the value is missing or not allowed
}

void CsvColumns::check_width(const CsvReader& row) const {
  const std::size_t width = row.cells().size();
  if (width == cells_.size()) return;
  check_separators(row, known_);
  if (width < cells_.size()) return;  // number() will report the first column without a value
  row.fail(fmt::format("{}: one value too many after column {}; there are {} columns{}",
                       one_line(row.cells()[cells_.size()]), names_.back(), cells_.size(),
                       width == 2 * cells_.size() ? std::string("; ") + kDecimalPoint : std::string()));
}

std::string unknown_column(std::string_view name, const std::vector<CsvColumn>& known) {
  std::vector<std::string> names;
  for (const CsvColumn& column : known) names.push_back(column.name);
  const std::optional<std::string> near = near_name(name, names);
  return fmt::format("column \"{}\" is unknown; {}allowed are {}", one_line(name),
                     near ? fmt::format("the nearest known is {}, ", *near) : "", names_of(known));
}

}  // namespace dolp
