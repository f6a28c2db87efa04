// The window's font, and substitutes for letters that it lacks.
#pragma once

#include <string>
#include <string_view>

namespace dolp::explore {

/// Loads DejaVu Sans at `pixels`, or, where it is not installed, keeps ImGui's own font, which has ASCII alone.
/// An ImGui context must be there.
void load_font(float pixels);

/// A UTF-8 text as the font can show it: Greek letters and signs by name without DejaVu Sans.
std::string shown(std::string_view text);

/// The same text in ASCII.
std::string ascii(std::string_view text);

}  // namespace dolp::explore
