#pragma once

#include <string>

namespace dolp {

/// The shortest text that reads back as the same double; "nan", "inf" and "-inf" otherwise.
std::string number_text(double value);
/// The same at the end of a text.
void append_number(std::string& text, double value);

}  // namespace dolp
