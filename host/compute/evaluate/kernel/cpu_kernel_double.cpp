#define DOLP_MOST_COLUMNS DOLP_COLUMNS
#define DOLP_KERNEL_NAMESPACE kernel_double
#define DOLP_DOUBLE

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace dolp::kernel_double {
using real = double;
using real2 = glm::dvec2;
using real4 = glm::dvec4;
}  // namespace dolp::kernel_double

#include "evaluate/kernel/kernel_source.hpp"

namespace dolp {

std::unique_ptr<CpuKernel> make_cpu_kernel_double(const KernelData& data) {
  return std::make_unique<kernel_double::SourceKernel>(data);
}

}  // namespace dolp
