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

  /// Builds a masking table for each of `shapes`, and drops all earlier tables. `shapes` are ascending positions in
  /// KernelData::shapes. If the masking needs tables, moments() accepts only entries with these shapes.
  virtual void build_masking_tables(std::vector<std::uint32_t> shapes) = 0;
  /// Returns the moments of `entry`. Adds the sums of the columns (physics/columns.glsl) to `columns`.
  virtual kernel::MomentsNode moments(const MomentsEntry& entry, std::span<double> columns) = 0;

  /// Returns the sums over the azimuths of the facets with one slope. Writes the sums of the columns to `columns`.
  virtual kernel::AzimuthNode azimuths(const kernel::SlopeNode& slope, std::span<double> columns) = 0;
};

std::unique_ptr<CpuKernel> make_cpu_kernel_float(const KernelData& data);
std::unique_ptr<CpuKernel> make_cpu_kernel_double(const KernelData& data);

}  // namespace dolp
