#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <dolp/errors.hpp>
#include <filesystem>
#include <memory>
#include <numeric>
#include <system_error>

#include "base/numbers.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMessageBytes = 80;

bool is_control(std::uint32_t code) {
  const bool is_ascii = (code < 0x20U && code != '\t') || code == 0x7FU;
  const bool is_separator = code == 0x2028U || code == 0x2029U;
  const bool turns_direction = code == 0x200EU || code == 0x200FU || code == 0x61CU ||
                               (code >= 0x202AU && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U);
  return is_ascii || (code >= 0x80U && code < 0xA0U) || is_separator || turns_direction;
}

}  // namespace

std::string_view trim(std::string_view text, std::string_view ends) {
  const std::size_t first = text.find_first_not_of(ends);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(ends) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const std::size_t end = text.find(separator);
    pieces.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> split_lines(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> lines = split(text, '\n');
  for (std::string_view& line : lines) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  }
  while (!lines.empty() && trim(lines.back()).empty()) lines.pop_back();
  return lines;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  // from_chars does not accept a leading plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

void append_number(std::string& text, double value) {
  std::array<char, 32> digits;
  if (std::isnan(value)) value = kNan;  // without a sign; a negative NaN would become "-nan"
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string format_number(double value) { return fmt::format("{}", value); }

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::string from = lower_case(a.substr(0, kMessageBytes));
  const std::string to = lower_case(b.substr(0, kMessageBytes));
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto distance = [name](std::string_view candidate) { return edit_distance(name, candidate); };
  return *std::ranges::min_element(candidates, {}, distance);
}

std::optional<std::string> near_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto distance = [name](std::string_view candidate) {
    const std::size_t cut = edit_distance(name.substr(0, candidate.size() + 1), candidate.substr(0, name.size() + 1));
    return std::min(edit_distance(name, candidate), cut + 1);
  };
  const std::string& nearest = *std::ranges::min_element(candidates, {}, distance);
  const auto [shorter, longer] = std::minmax({name.size(), nearest.size()});
  const bool is_near = distance(nearest) < shorter && 3 * distance(nearest) <= longer + 1;
  return is_near ? std::optional(nearest) : std::nullopt;
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool is_space = c == ' ' || (static_cast<unsigned char>(c) < 0x20);
    if (!is_space) line += c;
    if (is_space && !line.empty() && line.back() != ' ') line += ' ';
    if (line.size() > kMessageBytes) {
      // Removes the last UTF-8 character, which may be incomplete: up to three continuation bytes, and its first byte.
      for (int i = 0; i < 3 && (static_cast<unsigned char>(line.back()) & 0xC0U) == 0x80U; ++i) line.pop_back();
      line.pop_back();
      return line + "...";
    }
  }
  return line;
}

std::string printable_line(std::string_view text) {
  namespace utf = boost::locale::utf;
  std::string line;
  for (const char* next = text.data(); next != text.data() + text.size();) {
    const char* const start = next;
    const utf::code_point code = utf::utf_traits<char>::decode(next, text.data() + text.size());
    const bool is_utf8 = code != utf::illegal && code != utf::incomplete;
    if (!is_utf8) next = start + 1;
    line += is_utf8 && !is_control(code) ? std::string_view(start, static_cast<std::size_t>(next - start)) : "?";
  }
  return line;
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string read_text(const std::string& path, const std::string& prefix, std::size_t most_bytes) {
  const auto fail = [&](int code) {
    throw InputError(prefix + "cannot be read: " + std::generic_category().message(code));
  };
  struct Close {
    void operator()(std::FILE* file) const {
      if (file != stdin) std::fclose(file);
    }
  };
  const std::unique_ptr<std::FILE, Close> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) fail(errno);
  std::string text;
  std::vector<char> block(1U << 16U);
  for (;;) {
    const std::size_t got = std::fread(block.data(), 1, block.size(), file.get());
    text.append(block.data(), got);
    if (text.size() > most_bytes) throw InputError(fmt::format("{}is longer than {} bytes", prefix, most_bytes));
    if (std::ferror(file.get())) fail(errno);
    if (std::memchr(block.data(), 0, got)) throw InputError(prefix + "is not a text: it holds a zero byte");
    if (got < block.size()) return text;
  }
}

void check_named_file(const std::string& path, const std::string& prefix) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const bool may_be_read =
      // missing files and folders pass here, and read_text() refuses them
      is_regular_file(status) || is_directory(status) || !exists(status);
  if (path == "-" || !may_be_read) throw InputError(prefix + "is not a regular file");
}

std::string read_named_file(const std::string& path, const std::string& prefix, std::size_t most_bytes) {
  check_named_file(path, prefix);
  return read_text(path, prefix, most_bytes);
}

void check_regular_file(const std::string& path, const std::string& prefix) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (is_regular_file(status)) return;
  if (status.type() == std::filesystem::file_type::not_found) throw InputError(prefix + "there is no such file");
  throw InputError(prefix + (error ? "cannot be read: " + error.message() : "is not a regular file"));
}

std::string input_name(const std::string& path) { return path == "-" ? "stdin" : path; }

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return quoted + "'";
}

}  // namespace dolp
