#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// The kernel source, compiled as C++, for one set of kernel data. The data must outlive the object.
class CpuKernel {
 public:
  virtual ~CpuKernel() = default;

  /// Builds the masking tables of `shapes`, which must be in ascending order, and drops earlier tables. If the masking
  /// needs tables, `moments` accepts only entries with these shapes.
  virtual void build_masking_tables(std::vector<std::uint32_t> shapes) = 0;
  /// Returns the moments of `entry`, and adds DOLP_COLUMN_PARTS sums for each column of the data to `columns`.
  virtual kernel::MomentsNode moments(const MomentsEntry& entry, std::span<double> columns) = 0;

  /// Returns the sums over the azimuths at `slope`, and writes the two sums of each column of the data to `columns`.
  virtual kernel::AzimuthNode azimuths(const kernel::SlopeNode& slope, std::span<double> columns) = 0;

  /// The pBRDF f cos(theta_i) cos(theta_r) for k_s = 1, in 1/sr, divided by the power of two that BeamNode::density
  /// leaves out. It uses only the model and the rule nodes of the data.
  virtual kernel::MuellerNode mueller(const kernel::BeamNode& beam) = 0;
};

std::unique_ptr<CpuKernel> make_cpu_kernel_float(const KernelData& data);
std::unique_ptr<CpuKernel> make_cpu_kernel_double(const KernelData& data);

}  // namespace dolp
