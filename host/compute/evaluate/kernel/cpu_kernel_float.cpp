#define DOLP_MOST_COLUMNS DOLP_COLUMNS
#define DOLP_KERNEL_NAMESPACE kernel_float
#include "evaluate/kernel/kernel_source.hpp"

namespace dolp {

std::unique_ptr<CpuKernel> make_cpu_kernel_float(const KernelData& data) {
  return std::make_unique<kernel_float::SourceKernel>(data);
}

}  // namespace dolp
