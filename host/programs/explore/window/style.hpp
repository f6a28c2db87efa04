#pragma once

#include <imgui.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace dolp::explore {

bool is_light();
void set_theme(bool light);

struct Themed {
  ImU32 dark, light;
  // NOLINTNEXTLINE(google-explicit-constructor): a Themed is an ImU32 for ImGui
  operator ImU32() const { return is_light() ? light : dark; }
};

/// The colour map "viridis" from dark at 0 to light at 1. Positions outside this range are clamped.
/// Source: S. van der Walt, N. Smith, viridis of Matplotlib (CC0); linear between seventeen equally spaced colours.
ImU32 viridis(double position);

/// The colour map "RdBu" from blue at 0 over white at 0.5 to red at 1, for values of both signs.
/// Source: C. Brewer, ColorBrewer (Apache License 2.0), linear between its eleven colours.
ImU32 diverging(double position);

/// The style of a curve. Any two styles also differ in their dashes, for readers who do not see colours.
struct CurveStyle {
  ImU32 colour;
  float dash;  ///< length of dashes in pixels; 0 for a solid line
  float gap;
};

/// Styles of the current curve, of the overlay, and of a pin. The overlay is the curve of the other slope distribution.
/// A pin is a kept curve; `pin` is its Pin::colour. Colours: M. Okabe, K. Ito, Color Universal Design (2008).
CurveStyle current_style();
CurveStyle overlay_style();
CurveStyle pin_style(std::size_t pin);
CurveStyle stale(const CurveStyle& style);   ///< a fainter style, for outdated or hidden curves
ImU32 band_colour(const CurveStyle& style);  ///< the style's colour, but more transparent, to fill areas

inline constexpr Themed kTextColour{IM_COL32(225, 228, 232, 255), IM_COL32(24, 26, 30, 255)};
inline constexpr Themed kDimColour{IM_COL32(150, 156, 163, 255), IM_COL32(96, 101, 108, 255)};
inline constexpr Themed kGridColour{IM_COL32(62, 66, 72, 255), IM_COL32(214, 217, 221, 255)};
inline constexpr Themed kPlotColour{IM_COL32(20, 21, 24, 255), IM_COL32(255, 255, 255, 255)};
inline constexpr Themed kBackground{IM_COL32(28, 31, 33, 255), IM_COL32(240, 241, 243, 255)};
inline constexpr Themed kLabelGround{IM_COL32(20, 21, 24, 215), IM_COL32(255, 255, 255, 215)};
inline constexpr Themed kBadColour{IM_COL32(110, 112, 116, 255), IM_COL32(150, 152, 156, 255)};
inline constexpr Themed kErrorColour{IM_COL32(255, 150, 110, 255), IM_COL32(178, 40, 0, 255)};
inline constexpr Themed kRefusedColour{IM_COL32(110, 48, 34, 255), IM_COL32(255, 200, 186, 255)};  // of a field
inline constexpr Themed kStaleVeil{IM_COL32(20, 21, 24, 150), IM_COL32(255, 255, 255, 150)};
inline constexpr Themed kIntervalColour{IM_COL32(90, 205, 130, 255), IM_COL32(0, 130, 60, 255)};
inline constexpr Themed kHeadingColour{IM_COL32(230, 179, 0, 255), IM_COL32(148, 98, 0, 255)};
inline constexpr Themed kCursorColour{IM_COL32(255, 255, 255, 200), IM_COL32(40, 40, 40, 200)};

/// Loads the font DejaVu Sans if it is installed, otherwise ImGui's ASCII font. Needs an ImGui context.
void load_font(float pixels);
inline constexpr float kFontPixels = 15.0F;  ///< default size of the font

float scaled(float pixels);                ///< `pixels` times the current text size, divided by kFontPixels
std::string shown(std::string_view text);  ///< `text`, or ascii(text) if the font has no Greek
std::string ascii(std::string_view text);  ///< `text` with names instead of Greek letters and signs

/// Breaks a text into lines of at most `width`, at spaces. A longer word stays whole.
std::string in_lines(std::string text, float width);

void coloured_text(ImU32 colour, const std::string& text);  ///< draws text at ImGui's cursor; breaks long lines

inline constexpr float kTooltipDelay_s = 0.5F;  ///< time that the mouse rests before a tooltip appears

void tooltip(const std::string& text);  ///< shows `text` while the mouse rests on the last item

}  // namespace dolp::explore
