// Slope samples. Without masking and with v-cavity masking, the sums over the azimuths at a slope do not depend on the
// slope distribution. The slope samples of a direction and an index are these sums along the slope axis. Integrals over
// them, with the weights of a distribution, are its moments.
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

/// Positions in KernelData: a direction of a request, an index, and the shapes whose moments are wanted.
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
  double digits = 0.0;  ///< digits that the sum over the azimuths needs
};

/// The two rules of a piece of the slope axis: `fine` slopes from `first`, then `coarse` slopes.
struct SampledPiece {
  double start = 0.0;
  double end = 0.0;
  std::uint32_t first = 0;
  std::uint32_t fine = 0;
  std::uint32_t coarse = 0;
  std::uint32_t direction_piece = 0;  ///< the piece of KernelData::pieces that contains it
};

/// Slopes at which a direction and an index are sampled for all their shapes. They follow only from the entries.
struct SlopeSamples {
  SampledEntries entries;
  double cut = 0.0;  ///< the largest slope
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
  /// Writes the moments of the shapes to the positions of their entries in the request. `azimuths` has the kernel's
  /// results, for these samples from `first`; `unit_roundoff` belongs to the kernel's precision.
  void integrate(const SlopeSamples& samples, const SampledAzimuths& azimuths, std::size_t first, double unit_roundoff,
                 std::span<Moments> moments) const;
  /// Plans, computes and integrates samples with the kernel source compiled for the CPU.
  void compute(SampledEntries entries, CpuKernel& kernel, double unit_roundoff, std::span<Moments> moments) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The wanted entries of the directions `first` to `last` - 1 of a request.
std::vector<SampledEntries> sampled_entries(const MomentsRequest& request, const KernelData& data, std::size_t first,
                                            std::size_t last);

}  // namespace dolp
