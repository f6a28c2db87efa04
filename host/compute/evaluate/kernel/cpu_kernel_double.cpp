#define DOLP_MOST_COLUMNS DOLP_COLUMNS
#define DOLP_KERNEL_NAMESPACE kernel_double
#define DOLP_DOUBLE
#include "evaluate/kernel/kernel_source.hpp"

namespace dolp {

std::unique_ptr<CpuKernel> make_cpu_kernel_double(const KernelData& data) {
  return std::make_unique<kernel_double::SourceKernel>(data);
}

}  // namespace dolp
