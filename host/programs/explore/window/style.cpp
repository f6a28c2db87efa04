#include "explore/window/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

namespace dolp::explore {
namespace {

struct Rgb {
  int r, g, b;
};

constexpr std::array kViridis = {
    Rgb{68, 1, 84},    Rgb{72, 24, 106},  Rgb{71, 45, 123},  Rgb{66, 64, 134},  Rgb{59, 82, 139},  Rgb{51, 99, 141},
    Rgb{44, 114, 142}, Rgb{38, 130, 142}, Rgb{33, 145, 140}, Rgb{31, 160, 136}, Rgb{40, 174, 128}, Rgb{63, 188, 115},
    Rgb{94, 201, 98},  Rgb{132, 212, 75}, Rgb{173, 220, 48}, Rgb{216, 226, 25}, Rgb{253, 231, 37}};

constexpr std::array kRedBlue = {Rgb{5, 48, 97},     Rgb{33, 102, 172},  Rgb{67, 147, 195},  Rgb{146, 197, 222},
                                 Rgb{209, 229, 240}, Rgb{247, 247, 247}, Rgb{253, 219, 199}, Rgb{244, 165, 130},
                                 Rgb{214, 96, 77},   Rgb{178, 24, 43},   Rgb{103, 0, 31}};

constexpr Themed kOrange{IM_COL32(230, 159, 0, 255), IM_COL32(196, 124, 0, 255)};
constexpr Themed kSkyBlue{IM_COL32(86, 180, 233, 255), IM_COL32(0, 114, 178, 255)};
constexpr Themed kGreen{IM_COL32(0, 158, 115, 255), IM_COL32(0, 134, 98, 255)};
constexpr Themed kYellow{IM_COL32(240, 228, 66, 255), IM_COL32(150, 138, 0, 255)};
constexpr Themed kBlue{IM_COL32(0, 114, 178, 255), IM_COL32(50, 150, 205, 255)};
constexpr Themed kVermilion{IM_COL32(213, 94, 0, 255), IM_COL32(190, 70, 0, 255)};
constexpr Themed kPurple{IM_COL32(204, 121, 167, 255), IM_COL32(170, 80, 130, 255)};

ImU32 with_alpha(ImU32 colour, ImU32 alpha) { return (colour & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT); }

constexpr const char* kFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

bool has_greek() {
  constexpr ImWchar kTheta = 0x3B8;
  return ImGui::GetFont()->FindGlyphNoFallback(kTheta) != nullptr;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 42> kNames = {{
    {"θ", "theta"}, {"σ", "sigma"}, {"ρ", "rho"}, {"ε", "eps"}, {"λ", "lambda"}, {"τ", "tau"},    {"π", "pi"},
    {"α", "alpha"}, {"β", "beta"},  {"η", "eta"}, {"Δ", "d"},   {"δ", "d"},      {"φ", "phi"},    {"ω", "omega"},
    {"µ", "u"},     {"°", " deg"},  {"±", "+-"},  {"≤", "<="},  {"≥", ">="},     {"√", "sqrt"},   {"²", "^2"},
    {"⁴", "^4"},    {"·", "*"},     {"×", "x"},   {"−", "-"},   {"–", "-"},      {"→", "->"},     {"∫", "int"},
    {"…", "..."},   {"⁻", "^-"},    {"¹", "1"},   {"≈", "~"},   {"∞", "inf"},    {"Λ", "Lambda"}, {"γ", "gamma"},
    {"ν", "nu"},    {"‖", "|"},     {"▲", "^"},   {"•", "*"},   {"“", "\""},     {"”", "\""},     {"Ω", "Omega"},
}};

/// The colour at a position from 0 to 1, by linear interpolation between equally spaced `colours`.
ImU32 colour_at(std::span<const Rgb> colours, double position) {
  const double steps = std::clamp(position, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(steps), colours.size() - 2);
  const double part = steps - static_cast<double>(below);
  const auto mixed = [&](int Rgb::*channel) {
    const double a = colours[below].*channel, b = colours[below + 1].*channel;
    return static_cast<int>(std::lround(a + part * (b - a)));
  };
  return IM_COL32(mixed(&Rgb::r), mixed(&Rgb::g), mixed(&Rgb::b), 255);
}

}  // namespace

bool is_light() { return ImGui::GetStyleColorVec4(ImGuiCol_WindowBg).y > 0.5F; }

void set_theme(bool light) {
  light ? ImGui::StyleColorsLight() : ImGui::StyleColorsDark();
  ImGui::GetStyle().FrameBorderSize = light ? 1.0F : 0.0F;
  ImGui::GetStyle().Colors[ImGuiCol_ModalWindowDimBg] = {0.0F, 0.0F, 0.0F, 0.55F};
  for (const ImGuiCol ground : {ImGuiCol_PopupBg, ImGuiCol_WindowBg}) ImGui::GetStyle().Colors[ground].w = 1.0F;
}

ImU32 viridis(double position) { return colour_at(kViridis, position); }
ImU32 diverging(double position) { return colour_at(kRedBlue, position); }
CurveStyle current_style() { return {kSkyBlue, 0.0F, 0.0F}; }
CurveStyle overlay_style() { return {kOrange, 9.0F, 5.0F}; }

CurveStyle pin_style(std::size_t pin) {
  const std::array kStyles = {CurveStyle{kYellow, 3.0F, 4.0F}, CurveStyle{kPurple, 14.0F, 5.0F},
                              CurveStyle{kGreen, 6.0F, 3.0F},  CurveStyle{kVermilion, 2.0F, 3.0F},
                              CurveStyle{kBlue, 18.0F, 3.0F},  CurveStyle{kTextColour, 5.0F, 9.0F}};
  return kStyles[pin % kStyles.size()];
}

CurveStyle stale(const CurveStyle& style) { return {with_alpha(style.colour, 96), style.dash, style.gap}; }
ImU32 band_colour(const CurveStyle& style) { return with_alpha(style.colour, (style.colour >> IM_COL32_A_SHIFT) / 4); }

void load_font(float pixels) {
  ImGuiIO& io = ImGui::GetIO();
  if (std::filesystem::exists(kFontFile)) {
    // Ranges of code points: Latin, Greek, punctuation, super- and subscripts, arrows, mathematics, shapes.
    static constexpr std::array<ImWchar, 15> kRanges = {0x20,   0xFF,   0x370,  0x3FF,  0x2010, 0x2027, 0x2070, 0x209F,
                                                        0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};
    if (io.Fonts->AddFontFromFileTTF(kFontFile, pixels, nullptr, kRanges.data())) return;
  }
  io.Fonts->AddFontDefault();
}

float scaled(float pixels) { return pixels * ImGui::GetFontSize() / kFontPixels; }

std::string ascii(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const auto named = std::ranges::find_if(kNames, [&](const auto& sign) { return text.starts_with(sign.first); });
    const bool is_named = named != kNames.end();
    plain += is_named ? named->second : text.substr(0, 1);
    text.remove_prefix(is_named ? named->first.size() : 1);
  }
  return plain;
}

std::string shown(std::string_view text) { return has_greek() ? std::string(text) : ascii(text); }

std::string in_lines(std::string text, float width) {
  constexpr std::size_t kNone = std::string::npos;
  std::size_t line = 0;  // position at which the current line begins
  std::size_t space = kNone;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const bool is_end = i == text.size() || text[i] == '\n';
    if (!is_end && text[i] != ' ') continue;
    if (space != kNone && ImGui::CalcTextSize(text.data() + line, text.data() + i).x > width) {
      text[space] = '\n';
      line = space + 1;
    }
    space = is_end ? kNone : i;
    if (is_end) line = i + 1;
  }
  return text;
}

void coloured_text(ImU32 colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0.0F);  // lets ImGui break words longer than a line
  ImGui::TextUnformatted(in_lines(shown(text), ImGui::GetContentRegionAvail().x).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const ImGuiIO& io = ImGui::GetIO();
  const auto now_s = static_cast<float>(ImGui::GetTime());
  float& still_since_s = *ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID("still since"), now_s);
  const bool is_still = io.MouseDelta.x == 0.0F && io.MouseDelta.y == 0.0F && !ImGui::IsAnyMouseDown();
  if (!is_still) still_since_s = now_s;
  if (now_s - still_since_s < kTooltipDelay_s) return;
  // Puts the tooltip right of the ImGui window, or above the item if there is no room. Below, it would hide values.
  const float width = 28.0F * ImGui::GetFontSize();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 first = ImGui::GetItemRectMin(), last = ImGui::GetItemRectMax();
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowWidth() + gap;
  if (right + width < io.DisplaySize.x) {
    const bool is_low = first.y > 0.5F * io.DisplaySize.y;
    ImGui::SetNextWindowPos({right, is_low ? last.y : first.y}, ImGuiCond_Always, {0.0F, is_low ? 1.0F : 0.0F});
  } else {
    const float left = std::max(std::min(first.x, io.DisplaySize.x - width - 2.0F * gap), 0.0F);
    ImGui::SetNextWindowPos({left, first.y - gap}, ImGuiCond_Always, {0.0F, 1.0F});
  }
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(width + ImGui::GetStyle().WindowPadding.x);
  ImGui::TextUnformatted(in_lines(shown(text), width).c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace dolp::explore
