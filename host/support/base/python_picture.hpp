#pragma once

#include <string>

namespace dolp {

/// Runs a script with /usr/bin/python3, and writes its standard output, a picture, to the file `path`. The script gets
/// `input` on standard input, and the suffix of `path` as argument. Errors: IoError, for example without Matplotlib.
void draw_with_python(const char* script, const std::string& input, const std::string& path);

}  // namespace dolp
