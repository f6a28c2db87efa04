#define DOLP_TEXT_NAMESPACE text_double
#define DOLP_DOUBLE

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace dolp::text_double {
using real = double;
using real2 = glm::dvec2;
using real4 = glm::dvec4;
}  // namespace dolp::text_double

#include "evaluate/text/text_body.hpp"

namespace dolp {

std::unique_ptr<KernelText> make_kernel_text_double(const KernelData& data) {
  return std::make_unique<text_double::TextKernel>(data);
}

}  // namespace dolp
