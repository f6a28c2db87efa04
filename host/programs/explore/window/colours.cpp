#include "explore/window/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dolp::explore {
namespace {

struct Rgb {
  int r, g, b;
};

constexpr std::array<Rgb, 17> kViridis = {{{68, 1, 84},
                                           {72, 24, 106},
                                           {71, 45, 123},
                                           {66, 64, 134},
                                           {59, 82, 139},
                                           {51, 99, 141},
                                           {44, 114, 142},
                                           {38, 130, 142},
                                           {33, 145, 140},
                                           {31, 160, 136},
                                           {40, 174, 128},
                                           {63, 188, 115},
                                           {94, 201, 98},
                                           {132, 212, 75},
                                           {173, 220, 48},
                                           {216, 226, 25},
                                           {253, 231, 37}}};

constexpr ImU32 kOrange = IM_COL32(230, 159, 0, 255);
constexpr ImU32 kSkyBlue = IM_COL32(86, 180, 233, 255);
constexpr ImU32 kGreen = IM_COL32(0, 158, 115, 255);
constexpr ImU32 kYellow = IM_COL32(240, 228, 66, 255);
constexpr ImU32 kBlue = IM_COL32(0, 114, 178, 255);
constexpr ImU32 kVermilion = IM_COL32(213, 94, 0, 255);
constexpr ImU32 kPurple = IM_COL32(204, 121, 167, 255);

ImU32 with_alpha(ImU32 colour, ImU32 alpha) { return (colour & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT); }

}  // namespace

ImU32 viridis(double position) {
  const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double part = place - static_cast<double>(below);
  const auto mixed = [&](int Rgb::*channel) {
    const double a = kViridis[below].*channel;
    const double b = kViridis[below + 1].*channel;
    return static_cast<int>(std::lround(a + part * (b - a)));
  };
  return IM_COL32(mixed(&Rgb::r), mixed(&Rgb::g), mixed(&Rgb::b), 255);
}

CurveStyle current_style() { return {kSkyBlue, 0.0F, 0.0F}; }

CurveStyle overlay_style() { return {kOrange, 9.0F, 5.0F}; }

CurveStyle pin_style(std::size_t pin) {
  constexpr std::array<CurveStyle, 6> kStyles = {{{kYellow, 3.0F, 4.0F},
                                                  {kPurple, 14.0F, 5.0F},
                                                  {kGreen, 6.0F, 3.0F},
                                                  {kVermilion, 2.0F, 3.0F},
                                                  {kBlue, 18.0F, 3.0F},
                                                  {kTextColour, 5.0F, 9.0F}}};
  return kStyles[pin % kStyles.size()];
}

CurveStyle stale(const CurveStyle& style) {
  constexpr ImU32 kAlpha = 96;
  return {with_alpha(style.colour, kAlpha), style.dash, style.gap};
}

ImU32 band_colour(const CurveStyle& style) {
  constexpr ImU32 kPart = 4;  // of the curve's own
  return with_alpha(style.colour, (style.colour >> IM_COL32_A_SHIFT) / kPart);
}

}  // namespace dolp::explore
