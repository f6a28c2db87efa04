// Slope samples are sums over the facet azimuth, for one direction and one refractive index, at some slopes. Without
// masking and with v-cavity masking, they do not depend on the slope distribution, so all distributions share them. The
// moments of a distribution are sums over the samples, weighted with its density.
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

/// True if the moments of this request are sums over slope samples, false if the kernel sums over the slopes.
bool has_slope_samples(const MomentsRequest& request);

struct SampledSlope {
  double t = 0.0;
  double dt = 0.0;
  double digits = 0.0;  ///< decimal digits to which the sum over the azimuths is needed
};

/// A piece of the slope axis with two Gauss rules. In SlopeSamples::slopes, the `fine` nodes of the finer rule begin at
/// the position `first`. The `coarse` nodes of the coarser rule follow.
struct SampledPiece {
  double start = 0.0;
  double end = 0.0;
  std::uint32_t first = 0;
  std::uint32_t fine = 0;
  std::uint32_t coarse = 0;
  std::uint32_t direction_piece = 0;  ///< number of the direction's piece (see Pieces) that contains this piece
};

/// The slopes at which the kernel computes samples for a bundle. All its entries share them.
struct SlopeSamples {
  std::size_t bundle = 0;  ///< position in KernelData::bundles
  double cut = 0.0;        ///< largest slope; steeper facets are left out
  std::vector<SampledPiece> pieces;
  std::vector<SampledSlope> slopes;
  std::size_t orders = 1;  ///< azimuthal orders: first all slopes have samples of order 0, then of order 1, ...

  std::size_t nodes() const { return orders * slopes.size(); }
};

struct SampledAzimuths {
  SampledAzimuths(std::size_t slopes, const KernelData& data)
      : nodes(slopes), per_slope(column_azimuths(data)), columns(slopes * per_slope) {}
  std::span<double> slope_columns(std::size_t slope) {
    return std::span(columns).subspan(slope * per_slope, per_slope);
  }

  std::vector<kernel::AzimuthNode> nodes;
  std::size_t per_slope;
  std::vector<double>
      columns;  ///< for each slope, the sums i and q, or i, q and u, of each column (physics/columns.glsl)
};

/// Plans slope samples and integrates over them. Any thread may use it. `data` must outlive the object.
class SlopeSampling {
 public:
  explicit SlopeSampling(const KernelData& data);
  ~SlopeSampling();

  SlopeSamples plan(std::size_t bundle) const;
  /// Appends what the kernel needs for each slope and each group of `at_once` azimuthal orders.
  void append(const SlopeSamples& samples, std::size_t at_once, std::vector<kernel::SlopeNode>& nodes) const;
  /// Computes the moments of samples.bundle from the kernel's sums over the azimuths. The sums for samples.slopes[0]
  /// and order 0 are in azimuths.nodes[first].
  void integrate(const SlopeSamples& samples, const SampledAzimuths& azimuths, std::size_t first, double unit_roundoff,
                 std::span<Moments> moments) const;
  void compute(std::size_t bundle, CpuKernel& kernel, double unit_roundoff, std::span<Moments> moments) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp
