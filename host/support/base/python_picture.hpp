#pragma once

#include <string>

namespace dolp {

/// Runs a script with /usr/bin/python3. The script gets `input` on standard input and the suffix of `path` as its
/// argument. Writes the picture that the script prints to the file `path`.
/// Errors: IoError if the script fails, for example without Matplotlib; the errors of write_text_atomically().
void draw_with_python(const char* script, const std::string& input, const std::string& path);

}  // namespace dolp
