#pragma once

#include <string>

namespace dolp {

/// Runs a script with /usr/bin/python3. The script gets `input` on standard input and the suffix of `path` as its
/// argument. The picture that it prints is written to `path`.
/// Errors: IoError if Python or Matplotlib is missing; the errors of write_text_atomically().
void draw_with_python(const char* script, const std::string& input, const std::string& path);

}  // namespace dolp
