// The shaders' own source compiled as C++, in float and in double: a translation unit for each precision.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// The kernels of shaders/*.comp over one set of kernel data, which must outlive the object.
class CpuKernel {
 public:
  virtual ~CpuKernel() = default;

  /// Makes the masking tables of some shapes, in ascending order, and drops earlier ones. If the data needs tables,
  /// `moments` takes only entries of these shapes.
  virtual void build_masking_tables(std::vector<std::uint32_t> shapes) = 0;
  /// Adds DOLP_COLUMN_PARTS sums for each column of the data to `columns`.
  virtual kernel::MomentsNode moments(const MomentsEntry& entry, std::span<double> columns) = 0;

  /// The sums over the azimuths at a slope; `columns` gets the two sums of each column of the data.
  virtual kernel::AzimuthNode azimuths(const kernel::SlopeNode& slope, std::span<double> columns) = 0;

  /// f cos(theta_i) cos(theta_r) for k_s = 1 over the beam's power of two, in 1/sr. From the data it reads only the
  /// model and the rule nodes.
  virtual kernel::MuellerNode mueller(const kernel::BeamNode& beam) = 0;
};

std::unique_ptr<CpuKernel> make_cpu_kernel_float(const KernelData& data);
std::unique_ptr<CpuKernel> make_cpu_kernel_double(const KernelData& data);

}  // namespace dolp
