// Inputs of the pBRDF kernel for one entry, computed in double.
#pragma once

#include <vector>

#include "model/scattering.hpp"
#include "plan/geometry.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// Inputs of the kernel for one entry; the pBRDF is the kernel's result times 2^power.
struct Beam {
  kernel::BeamNode node{};
  int power = 0;
};

/// Makes the beams of a request, which must outlive the object. Pure.
///
/// The geometry, D and the reflection of the facet are computed here and not by the kernel: near the normal and the
/// retro direction, far down the slope distribution and near the critical angle their rounding in a float would be
/// amplified beyond 1e-5 of m00. D is handed over without its power of two, so that no float over- or underflows.
class BeamPlan {
 public:
  explicit BeamPlan(const ScatteringRequest& request);
  Beam operator()(const ScatteringEntry& entry) const;

  /// The kernel's result with its power of two restored, its error bound, and the further bounces that the request asks
  /// for; `unit_roundoff` is that of the kernel's precision.
  ScatteringMatrix matrix(const kernel::MuellerNode& node, const Beam& beam, const ScatteringEntry& entry,
                          double unit_roundoff) const;

  /// The kernel data besides the beams: the model and the rule nodes.
  const KernelData& data() const { return data_; }

 private:
  const ScatteringRequest& request_;
  KernelData data_;
  std::vector<BeamGeometry> geometries_;
};

/// ln(D / 4) at a slope.
double log_density(Distribution distribution, const SlopeShape& shape, double slope);

}  // namespace dolp
