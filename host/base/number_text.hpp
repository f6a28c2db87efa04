#pragma once

#include <string>

namespace dolp {

/// The shortest text that reads back as the same double; "nan", "inf" and "-inf" otherwise.
std::string number_text(double value);

}  // namespace dolp
