#include "explore/window/text.hpp"

#include <imgui.h>

#include <array>
#include <filesystem>
#include <utility>

namespace dolp::explore {
namespace {

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

}  // namespace

void load_font(float pixels) {
  ImGuiIO& io = ImGui::GetIO();
  if (std::filesystem::exists(kFontFile)) {
    // Latin with its signs, Greek, punctuation, super- and subscripts, arrows, mathematics, shapes.
    static constexpr std::array<ImWchar, 15> kRanges = {0x20,   0xFF,   0x370,  0x3FF,  0x2010, 0x2027, 0x2070, 0x209F,
                                                        0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};
    if (io.Fonts->AddFontFromFileTTF(kFontFile, pixels, nullptr, kRanges.data())) return;
  }
  io.Fonts->AddFontDefault();
}

std::string ascii(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [sign, name] : kNames) {
      if (!text.starts_with(sign)) continue;
      plain += name;
      text.remove_prefix(sign.size());
      found = true;
      break;
    }
    if (found) continue;
    plain += text.front();
    text.remove_prefix(1);
  }
  return plain;
}

std::string shown(std::string_view text) { return has_greek() ? std::string(text) : ascii(text); }

}  // namespace dolp::explore
