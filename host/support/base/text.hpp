// Reads text that people wrote: numbers, lines, and names with typing errors. Writes numbers, and text that is safe to
// display.
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

/// The pieces of a text between separators. There is at least one piece.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The lines of a text without their ends (LF or CRLF). Leaves out a UTF-8 byte order mark at the start and blank lines
/// at the end.
std::vector<std::string_view> split_lines(std::string_view text);

/// `text` with ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The finite decimal number in a text, which may have blanks around it but nothing else. Independent of the locale.
/// Errors: nullopt for all other texts, for example nan, inf, 1e999 and 1e-999.
std::optional<double> parse_number(std::string_view text);

/// The shortest text that reads back as this double; or "nan", "inf" or "-inf".
std::string number_text(double value);
/// Appends number_text(value).
void append_number(std::string& text, double value);

/// The shortest text that reads back as this double, for messages and scenes: 100000 instead of number_text's 1e+05.
std::string format_number(double value);

/// Number of single-character insertions, deletions and replacements between two words. Compares the first 80 bytes and
/// ignores case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance from `name`, or the first of these. `candidates` must not be empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The candidate that a mistyped or shortened name probably means; nullopt if no candidate is similar. `candidates`
/// must not be empty.
std::optional<std::string> near_name(std::string_view name, const std::vector<std::string>& candidates);

/// `text` as one line, cut to a length that suits a message.
std::string one_line(std::string_view text);

/// Text from files and command lines, made safe to display: control characters, bytes that are not UTF-8, and
/// characters that change the text direction become "?". Tabs stay.
std::string printable_line(std::string_view text);

/// "a, b, c".
std::string join(const std::vector<std::string>& words);

/// Largest size in bytes of a scene, and of most other inputs.
inline constexpr std::size_t kMostTextBytes = 16U << 20U;

/// The bytes of a file, or of stdin for "-".
/// Errors: InputError that begins with `prefix`, if the input cannot be read, is longer than `most_bytes` or contains a
/// zero byte.
std::string read_text(const std::string& path, const std::string& prefix, std::size_t most_bytes = kMostTextBytes);

/// Refuses "-", a pipe or a device where an input or the window names a file. A call that opened it could wait forever.
/// Errors: InputError that begins with `prefix`.
void check_named_file(const std::string& path, const std::string& prefix);

/// The bytes of a file that an input names. Errors: the errors of check_named_file() and read_text().
std::string read_named_file(const std::string& path, const std::string& prefix,
                            std::size_t most_bytes = kMostTextBytes);

/// Refuses a path that is not a regular file or cannot be examined. Errors: InputError that begins with `prefix`.
void check_regular_file(const std::string& path, const std::string& prefix);

/// The name of an input for messages: "stdin" for "-".
std::string input_name(const std::string& path);

/// `text` in single quotes, as an argument for any shell.
std::string shell_quoted(const std::string& text);

}  // namespace dolp
