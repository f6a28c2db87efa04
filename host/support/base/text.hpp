#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// Removes the characters of `ends` at both ends of a text.
std::string_view trim(std::string_view text, std::string_view ends = " \t");
std::vector<std::string_view> split(std::string_view text, char separator);  ///< returns at least one piece

/// The lines of a text without their ends (LF or CRLF). Skips a UTF-8 byte order mark, and blank lines after the text.
std::vector<std::string_view> split_lines(std::string_view text);

std::string lower_case(std::string_view text);  ///< changes only ASCII letters

/// The finite decimal number in a text, with a decimal point in every locale. The text may have blanks at both ends.
/// Returns nullopt for all other texts, for example nan, inf, 1e999 and 1e-999.
std::optional<double> parse_number(std::string_view text);

/// The shortest text that reads back as this double; or "nan", "inf" or "-inf".
std::string number_text(double value);
void append_number(std::string& text, double value);  ///< appends number_text(value)

/// Like number_text(), but writes 100000 instead of 1e+05. For messages and scenes.
std::string format_number(double value);

/// Number of letters to insert, delete or replace to turn `a` into `b`. Ignores case and the bytes after the 80th.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The first of the candidates with the smallest edit distance from `name`. `candidates` must not be empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The candidate that a mistyped or shortened name probably means; empty if no candidate is similar.
std::optional<std::string> near_name(std::string_view name, const std::vector<std::string>& candidates);

std::string one_line(std::string_view text);  ///< for messages: replaces line ends by blanks; cuts off a long text

/// Text from files and command lines, made safe to display: control characters, bytes that are not UTF-8, and
/// characters that change the text direction become "?". Tabs stay.
std::string printable_line(std::string_view text);

std::string join(const std::vector<std::string>& words);  ///< "a, b, c"

inline constexpr std::size_t kMostTextBytes = 16U << 20U;  ///< size limit of a scene, and of most other inputs

/// The bytes of a file, or of stdin for "-". Errors: InputError that begins with `prefix`, if the input cannot be read,
/// is longer than `most_bytes` or contains a zero byte.
std::string read_text(const std::string& path, const std::string& prefix, std::size_t most_bytes = kMostTextBytes);

/// Checks a file name from a scene or from the window of `dolp explore`. Refuses "-", pipes and devices, because
/// reading them could take forever. Errors: InputError that begins with `prefix`.
void check_named_file(const std::string& path, const std::string& prefix);

std::string read_named_file(const std::string& path, const std::string& prefix,
                            std::size_t most_bytes = kMostTextBytes);

/// Refuses a path that is not a regular file or cannot be examined. Errors: InputError that begins with `prefix`.
void check_regular_file(const std::string& path, const std::string& prefix);

std::string input_name(const std::string& path);    ///< name in messages: "stdin" if `path` is "-", else `path`
std::string shell_quoted(const std::string& text);  ///< `text` in single quotes, as one word of a shell command

}  // namespace dolp
