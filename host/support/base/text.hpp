// Reads text written by people: numbers, lines, and names with typing errors. Writes numbers, and text safe to show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dolp {

/// `text` without blanks (space, tab) at both ends.
std::string_view trim(std::string_view text);

/// The pieces between separators; always at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The lines without their ends (LF or CRLF), a leading UTF-8 byte order mark and the blank lines at the end removed.
std::vector<std::string_view> split_lines(std::string_view text);

/// ASCII lower case.
std::string lower_case(std::string_view text);

/// A finite decimal number that fills `text` except for blanks around it; independent of the locale.
/// Errors: nullopt for all other texts, also for nan, inf, 1e999 and 1e-999.
std::optional<double> parse_number(std::string_view text);

/// The shortest text that reads back as the same double; "nan", "inf" and "-inf" otherwise.
std::string number_text(double value);
/// Appends number_text(value).
void append_number(std::string& text, double value);

/// The shortest text that reads back as the same double, for messages and scenes: 100000, not number_text's 1e+05.
std::string format_number(double value);

/// Number of single-character insertions, deletions and replacements between the beginnings of two words, 80 bytes of
/// each, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate with the least edit distance, the first of equals; `candidates` is not empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The candidate that a mistyped or shortened name most likely means; nullopt if all are far from it. `candidates` is
/// not empty.
std::optional<std::string> near_name(std::string_view name, const std::vector<std::string>& candidates);

/// `text` on one line and short enough for a message.
std::string one_line(std::string_view text);

/// Text from files and command lines, safe to show: control characters, bytes that are not UTF-8, and characters that
/// change the text direction become "?". Tabs stay.
std::string printable_line(std::string_view text);

/// "a, b, c".
std::string join(const std::vector<std::string>& words);

/// The most bytes of a scene and of most other inputs.
inline constexpr std::size_t kMostTextBytes = 16U << 20U;

/// A file's bytes, or stdin's for "-".
/// Errors: InputError, "`prefix`cannot be read: reason", and for more than `most_bytes` or a zero byte among them.
std::string read_text(const std::string& path, const std::string& prefix, std::size_t most_bytes = kMostTextBytes);

/// Refuses a pipe, a device or stdin as a file that an input names or the window opens, so that no call waits for it.
/// Errors: InputError that begins with `prefix`.
void check_named_file(const std::string& path, const std::string& prefix);

/// The bytes of a file that an input names. Errors: the errors of check_named_file() and read_text().
std::string read_named_file(const std::string& path, const std::string& prefix,
                            std::size_t most_bytes = kMostTextBytes);

/// Refuses a path that is not a regular file or cannot be examined. Errors: InputError that begins with `prefix`.
void check_regular_file(const std::string& path, const std::string& prefix);

/// The name of an input for messages: "stdin" for "-".
std::string input_name(const std::string& path);

/// `text` in single quotes, for any shell.
std::string shell_quoted(const std::string& text);

}  // namespace dolp
