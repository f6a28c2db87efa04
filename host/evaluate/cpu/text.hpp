// The shaders' own text compiled as C++, in float and in double: a translation unit for each precision.
#pragma once

#include <cstddef>
#include <memory>

#include "plan/kernel_data.hpp"

namespace dolp {

/// The two kernels of shaders/*.comp over one set of kernel data, which must outlive the object.
class KernelText {
 public:
  virtual ~KernelText() = default;

  /// Fills the masking table of one shape; needed before `moments` of its entries when the data needs tables.
  virtual void build_masking_table(std::size_t shape) = 0;
  virtual kernel::MomentsNode moments(const MomentsEntry& entry) = 0;

  /// f cos(theta_i) cos(theta_r) of one geometry for k_s = 1, in 1/sr; `shape` and `index` are positions in the data.
  virtual kernel::MuellerNode mueller(const kernel::GeometryNode& geometry, std::size_t shape, std::size_t index) = 0;
};

std::unique_ptr<KernelText> make_kernel_text_float(const KernelData& data);
std::unique_ptr<KernelText> make_kernel_text_double(const KernelData& data);

}  // namespace dolp
