# Writes the C++ source OUTPUT, in which the assembler puts the SPIR-V file MODULE as the span dolp::spirv::SYMBOL that
# spirv.hpp declares. A compiler would take seconds to read the words as numbers.
file(SIZE ${MODULE} size)
math(EXPR count "${size} / 4")  # SPIR-V is a stream of 32-bit words
file(WRITE ${OUTPUT} "#include \"spirv.hpp\"

asm(R\"(
  .pushsection .rodata
  .balign 4
dolp_spirv_${SYMBOL}:
  .incbin \"${MODULE}\"
  .popsection
)\");
extern \"C\" const std::uint32_t dolp_spirv_${SYMBOL}[${count}];

namespace dolp::spirv {
constinit const std::span<const std::uint32_t> ${SYMBOL}{dolp_spirv_${SYMBOL}};
}  // namespace dolp::spirv
")
