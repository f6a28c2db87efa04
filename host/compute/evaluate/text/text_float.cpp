#define DOLP_TEXT_NAMESPACE text_float

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace dolp::text_float {
using real = float;
using real2 = glm::vec2;
using real4 = glm::vec4;
}  // namespace dolp::text_float

#include "evaluate/text/text_body.hpp"

namespace dolp {

std::unique_ptr<KernelText> make_kernel_text_float(const KernelData& data) {
  return std::make_unique<text_float::TextKernel>(data);
}

}  // namespace dolp
