// Pictures that scripts in Python draw.
#pragma once

#include <string>

namespace dolp {

/// Runs a script of /usr/bin/python3 with `path` as its argument and `input` as its standard input.
/// Errors: IoError when Python or Matplotlib is missing or the picture cannot be written.
void draw_with_python(const char* script, const std::string& input, const std::string& path);

}  // namespace dolp
