# Writes the SPIR-V file MODULE to the C++ source OUTPUT as the span dolp::spirv::SYMBOL declared in spirv.hpp.
file(READ ${MODULE} hex HEX)
# SPIR-V is a stream of 32-bit words, which glslang writes in little-endian order.
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
file(WRITE ${OUTPUT} "#include \"spirv.hpp\"

namespace dolp::spirv {
namespace {
constexpr std::uint32_t ${SYMBOL}_words[] = {${words}};
}
constinit const std::span<const std::uint32_t> ${SYMBOL}{${SYMBOL}_words};
}  // namespace dolp::spirv
")
