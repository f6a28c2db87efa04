#include "scene/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <optional>
#include <utility>

#include "base/text.hpp"

namespace dolp {
namespace {

constexpr double kWholeInPercent = 100.0;

/// The text between double quotes; a cell with further quotes in it stays unchanged.
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

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string name, CsvForm form)
    : lines_(split_lines(text)), name_(std::move(name)), form_(form) {}

bool CsvReader::next() {
  while (read_ < lines_.size()) {
    line_ = trim(lines_[read_++]);
    if (line_.empty() ? form_.has_blank_lines : line_.front() == '#') continue;
    cells_ = split_cells(line_, form_.separator);
    return true;
  }
  return false;
}

std::size_t CsvReader::line_number() const { return form_.first_line + std::max(read_, std::size_t{1}) - 1; }

std::string CsvReader::where() const { return fmt::format("{}:{}: ", name_, line_number()); }

void CsvReader::fail(const std::string& what) const { throw InputError(where() + what); }

double CsvReader::number(std::size_t cell, std::string_view column, const NumberRange* range) const {
  const std::string allowed = range ? "; must be a number in " + range->text() : "";
  const std::string_view text = cell < cells_.size() ? cells_[cell] : std::string_view{};
  if (range && text.empty()) fail(fmt::format("{}: the value is missing{}", column, allowed));
  const std::optional<double> value = parse_number(text);
  if (!value) fail(fmt::format("{} = {}: not a number{}", column, one_line(text), allowed));
  if (range && !range->contains(*value)) {
    const bool is_percent = range->max == 1.0 && std::abs(*value) <= kWholeInPercent;
    fail(fmt::format("{} = {}: out of range{}{}", column, one_line(text), allowed,
                     is_percent ? ", a fraction and not percent" : ""));
  }
  return *value;
}

std::size_t CsvReader::position(std::string_view column, const NumberRange& range) const {
  const auto found = std::ranges::find(cells_, column);
  if (found == cells_.end()) fail(fmt::format("column \"{}\" is missing, a number in {}", column, range.text()));
  return static_cast<std::size_t>(found - cells_.begin());
}

}  // namespace dolp
