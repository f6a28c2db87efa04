// Everything the kernel reads, computed by the host in double; the evaluators narrow it to the precision they run in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "evaluate/moments.hpp"

namespace dolp {

/// The structures and constants of shaders/interface.glsl with real = double.
namespace kernel {
using real = double;
#include "shaders/interface.glsl"  // NOLINT: one text for host and shaders
}  // namespace kernel

/// Inputs of one run of the kernel. The lists match those of the request, position by position.
struct KernelData {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  std::vector<kernel::ThetaNode> thetas;
  std::vector<kernel::ShapeNode> shapes;
  std::vector<kernel::IndexNode> indices;
  std::vector<std::array<double, 2>> rule_nodes;
  bool needs_masking_table() const { return masking == Masking::kIntegral || masking == Masking::kSmith; }
};

/// Splits, orders, nodes and constants for a request at its tolerance. Pure.
KernelData kernel_data(const MomentsRequest& request);

/// Turns what the kernel returned for one entry into moments with error bounds, `unit_roundoff` being that of the
/// kernel's precision.
Moments moments_from_kernel(const kernel::MomentsNode& node, const MomentsRequest& request, const KernelData& data,
                            const MomentsEntry& entry, double unit_roundoff);

}  // namespace dolp
