// Pictures that scripts in Python draw.
#pragma once

#include <string>

namespace dolp {

/// Runs a script of /usr/bin/python3 with `input` as its standard input and the suffix of `path` as its argument, and
/// writes what it prints, a picture, to `path`.
/// Errors: IoError if Python or Matplotlib is missing; the errors of write_text_atomically().
void draw_with_python(const char* script, const std::string& input, const std::string& path);

}  // namespace dolp
