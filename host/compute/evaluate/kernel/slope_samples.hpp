// Where masking does not depend on the slope distribution, the sums over the azimuths at a slope serve every
// distribution: the slope samples of a direction and an index are these sums along the slope axis, and the moments of
// each distribution are their integral with the distribution's own weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "evaluate/kernel/cpu_kernel.hpp"
#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// True if the moments of a request are integrals over slope samples.
bool has_slope_samples(const MomentsRequest& request);

/// A direction of a request and an index, with the shapes of which moments are wanted: positions in KernelData.
struct SampledEntries {
  std::uint32_t direction = 0;
  std::uint32_t theta = 0;
  std::uint32_t index = 0;
  std::vector<std::uint32_t> shapes;
};

/// One slope of a rule, and its weight dt.
struct SampledSlope {
  double t = 0.0;
  double dt = 0.0;
  double digits = 0.0;  ///< wanted of the sum over the azimuths
};

/// The two rules of a piece of the slope axis: slopes first ... first + fine - 1, then those of the coarser one.
struct SampledPiece {
  double start = 0.0;
  double end = 0.0;
  std::uint32_t first = 0;
  std::uint32_t fine = 0;
  std::uint32_t coarse = 0;
  std::uint32_t direction_piece = 0;  ///< the piece of KernelData::pieces that it is in
};

/// Slopes at which a direction and an index are sampled for all their shapes. They follow from the entries alone.
struct SlopeSamples {
  SampledEntries entries;
  double cut = 0.0;  ///< slopes beyond it are left out
  std::vector<SampledPiece> pieces;
  std::vector<SampledSlope> slopes;
};

/// The kernel's results for slopes.
struct SampledAzimuths {
  SampledAzimuths(std::size_t slopes, const KernelData& data)
      : nodes(slopes), per_slope(column_azimuths(data)), columns(slopes * per_slope) {}
  std::span<double> columns_of(std::size_t slope) { return std::span(columns).subspan(slope * per_slope, per_slope); }

  std::vector<kernel::AzimuthNode> nodes;
  std::size_t per_slope;
  std::vector<double> columns;  ///< the two sums of each column, slope by slope
};

/// Plans slope samples of a request and integrates them. `data` must outlive it; any thread may call it.
class SlopeSampling {
 public:
  explicit SlopeSampling(const KernelData& data);
  ~SlopeSampling();

  SlopeSamples plan(SampledEntries entries) const;
  /// Appends the kernel's input, slope by slope.
  void append(const SlopeSamples& samples, std::vector<kernel::SlopeNode>& nodes) const;
  /// Puts the moments of their shapes at the places of their entries in the request; `azimuths` holds the
  /// kernel's result for each of its slopes from `first` on, `unit_roundoff` is that of its precision.
  void integrate(const SlopeSamples& samples, const SampledAzimuths& azimuths, std::size_t first, double unit_roundoff,
                 std::span<Moments> moments) const;
  /// Plans, takes and integrates samples with the kernel source compiled for the CPU.
  void compute(SampledEntries entries, CpuKernel& kernel, double unit_roundoff, std::span<Moments> moments) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The wanted entries of the directions `first` to `last` - 1 of a request.
std::vector<SampledEntries> sampled_entries(const MomentsRequest& request, const KernelData& data, std::size_t first,
                                            std::size_t last);

}  // namespace dolp
