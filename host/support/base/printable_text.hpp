#pragma once

#include <string>
#include <string_view>

namespace dolp {

/// Text that comes from files and command lines, safe to show: control characters, bytes that are not UTF-8, and
/// characters that change the text direction become "?". Tabs stay.
std::string printable_line(std::string_view text);

}  // namespace dolp
