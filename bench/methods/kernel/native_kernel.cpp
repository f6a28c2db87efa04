// A build of the kernel source for this processor. bench/CMakeLists.txt compiles this file with flags for high speed.
#define DOLP_KERNEL_NAMESPACE native_kernel

#include "methods/kernel/lanes.hpp"

namespace dolp::bench::native_kernel {
using real = float;
using real2 = Vec2<float>;
using real4 = Vec4<float>;
constexpr real as_data(real number) { return number; }
}  // namespace dolp::bench::native_kernel

#include "methods/kernel/grouped_body.hpp"

namespace dolp::bench {

std::unique_ptr<GroupedKernel> make_native_kernel(const GroupedWork& work) { return native_kernel::kernel_for(work); }

}  // namespace dolp::bench
