#include "verify/stored_cases.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

constexpr std::string_view kHeader =
    "distribution,masking,theta_deg,sigma,q,n,k,r_i,r_q,albedo,deficit,r_i_error,r_q_error,albedo_error,"
    "deficit_error,case,origin";
constexpr std::array<const char*, 2> kDistributions{"cauchy", "gaussian"};
constexpr std::array<const char*, 4> kMaskings{"none", "v-cavity", "integral", "smith"};

/// The cells of one line, and where they stand.
class Line {
 public:
  Line(std::string_view text, std::string where)
      : cells_(split(text, ',')), names_(split(kHeader, ',')), where_(std::move(where)) {
    if (cells_.size() == names_.size()) return;
    throw InputError(fmt::format("{}{} cells, {} are expected", where_, cells_.size(), names_.size()));
  }

  std::string text(std::size_t column) const { return std::string(cells_[column]); }

  double number(std::size_t column) const {
    const std::optional<double> value = parse_number(cells_[column]);
    if (!value) fail(column, "a number");
    return *value;
  }

  /// The position of a word in a list that has the order of an enumeration.
  template <std::size_t N>
  std::size_t word(std::size_t column, const std::array<const char*, N>& words) const {
    for (std::size_t i = 0; i < N; ++i) {
      if (cells_[column] == words[i]) return i;
    }
    fail(column, "the name of a distribution or a masking");
  }

 private:
  [[noreturn]] void fail(std::size_t column, const char* allowed) const {
    throw InputError(fmt::format("{}{} = {}: must be {}", where_, names_[column], one_line(cells_[column]), allowed));
  }

  std::vector<std::string_view> cells_;
  std::vector<std::string_view> names_;
  std::string where_;
};

StoredCase parse_case(const Line& line) {
  StoredCase stored;
  stored.distribution = static_cast<Distribution>(line.word(0, kDistributions));
  stored.masking = static_cast<Masking>(line.word(1, kMaskings));
  stored.theta_deg = line.number(2);
  stored.shape = {line.number(3), line.number(4)};
  stored.index = {line.number(5), line.number(6)};
  constexpr std::array kMoments{&Moments::r_i,          &Moments::r_q,          &Moments::albedo,
                                &Moments::deficit,      &Moments::r_i_error,    &Moments::r_q_error,
                                &Moments::albedo_error, &Moments::deficit_error};
  for (std::size_t i = 0; i < kMoments.size(); ++i) stored.moments.*kMoments[i] = line.number(7 + i);
  stored.name = line.text(15);
  stored.origin = line.text(16);
  return stored;
}

}  // namespace

std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name) {
  const std::vector<std::string_view> lines = split_lines(text);
  std::vector<StoredCase> cases;
  bool has_header = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with('#')) continue;
    if (!has_header) {
      if (lines[i] != kHeader) throw InputError(fmt::format("{}:{}: the columns must be {}", name, i + 1, kHeader));
      has_header = true;
      continue;
    }
    cases.push_back(parse_case(Line(lines[i], fmt::format("{}:{}: ", name, i + 1))));
  }
  if (!has_header) throw InputError(fmt::format("{}:1: the columns must be {}", name, kHeader));
  return cases;
}

std::vector<StoredCase> read_stored_cases(const std::string& path) {
  return parse_stored_cases(read_text(path, path + ": "), path);
}

std::vector<StoredCase> hard_cases() { return parse_stored_cases(embedded_hard_cases_csv(), "hard_cases.csv"); }

}  // namespace dolp
