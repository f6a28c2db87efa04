#include "base/printable_text.hpp"

#include <cstddef>
#include <cstdint>

namespace dolp {
namespace {

/// A character, and the number of its bytes; 0 bytes where the text does not begin with UTF-8.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

Character first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80U) return {lead, 1};
  const std::size_t bytes = lead < 0xC2U ? 0 : lead < 0xE0U ? 2 : lead < 0xF0U ? 3 : lead < 0xF5U ? 4 : 0;
  if (bytes == 0 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_overlong = (bytes == 3 && code < 0x800U) || (bytes == 4 && code < 0x10000U);
  const bool is_surrogate = code >= 0xD800U && code <= 0xDFFFU;
  return is_overlong || is_surrogate || code > 0x10FFFFU ? Character{} : Character{code, bytes};
}

bool is_control(std::uint32_t code) {
  const bool is_ascii = (code < 0x20U && code != '\t') || code == 0x7FU;
  const bool is_separator = code == 0x2028U || code == 0x2029U;
  const bool turns_direction = code == 0x200EU || code == 0x200FU || code == 0x61CU ||
                               (code >= 0x202AU && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U);
  return is_ascii || (code >= 0x80U && code < 0xA0U) || is_separator || turns_direction;
}

}  // namespace

std::string printable_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const Character first = first_character(text);
    const bool is_shown = first.bytes > 0 && !is_control(first.code);
    const std::string_view bytes = text.substr(0, first.bytes > 0 ? first.bytes : 1);
    line += is_shown ? bytes : "?";
    text.remove_prefix(bytes.size());
  }
  return line;
}

}  // namespace dolp
