#include "verify/stored_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "base/text.hpp"
#include "model/choices.hpp"
#include "scene/csv.hpp"

namespace dolp {
namespace {

constexpr std::array<std::string_view, 17> kCaseColumns{
    "distribution",  "masking", "theta_deg", "sigma",   "q",         "n",         "k",
    "r_i",           "r_q",     "albedo",    "deficit", "r_i_error", "r_q_error", "albedo_error",
    "deficit_error", "case",    "origin"};

template <class Choice>
Choice choice(const CsvReader& row, std::size_t column) {
  const std::string_view word = row.cells()[column];
  const std::optional<Choice> found = named<Choice>(word);
  if (!found) {
    row.fail(fmt::format("{} = {}: must be one of {}", kCaseColumns[column], one_line(word),
                         fmt::join(Names<Choice>::kAll, ", ")));
  }
  return *found;
}

StoredCase parse_case(const CsvReader& row) {
  const std::size_t cells = row.cells().size();
  if (cells != kCaseColumns.size()) row.fail(fmt::format("{} cells, {} are expected", cells, kCaseColumns.size()));
  const auto number = [&row](std::size_t column) { return row.number(column, kCaseColumns[column]); };
  StoredCase stored;
  stored.distribution = choice<Distribution>(row, 0);
  stored.masking = choice<Masking>(row, 1);
  stored.theta_deg = number(2);
  stored.shape = {number(3), number(4)};
  stored.index = {number(5), number(6)};
  constexpr std::array kMoments{&Moments::r_i,          &Moments::r_q,          &Moments::albedo,
                                &Moments::deficit,      &Moments::r_i_error,    &Moments::r_q_error,
                                &Moments::albedo_error, &Moments::deficit_error};
  for (std::size_t i = 0; i < kMoments.size(); ++i) stored.moments.*kMoments[i] = number(7 + i);
  stored.name = row.cells()[15];
  stored.origin = row.cells()[16];
  return stored;
}

}  // namespace

std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name) {
  std::vector<StoredCase> cases;
  CsvReader row(text, name);
  const bool is_header = row.next() && std::ranges::equal(row.cells(), kCaseColumns);
  if (!is_header) row.fail(fmt::format("the columns must be {}", fmt::join(kCaseColumns, ",")));
  while (row.next()) cases.push_back(parse_case(row));
  return cases;
}

std::vector<StoredCase> read_stored_cases(const std::string& path) {
  return parse_stored_cases(read_text(path, path + ": "), path);
}

std::vector<StoredCase> hard_cases() { return parse_stored_cases(embedded_hard_cases_csv(), "hard_cases.csv"); }

}  // namespace dolp
