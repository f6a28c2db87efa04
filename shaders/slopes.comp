#version 460
#extension GL_GOOGLE_include_directive : require
// Sums over the azimuths at one slope per invocation. The masking does not depend on the slope distribution, so the
// sums hold for every distribution (host/compute/evaluate/kernel/slope_samples.hpp).

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"

#if DOLP_MOST_COLUMNS > 0
// The columns (physics/columns.glsl) follow all AzimuthNodes: two numbers for each column of each node, or three if
// there are azimuthal orders.
layout(std430, binding = DOLP_BINDING_AZIMUTHS) writeonly buffer ColumnsOut { real columns_out[]; };

void store_column(uint position, real value) {
  uint each = (kHasOrders ? 3u * DOLP_WIDTH : 2u) * kColumnCount;
  uint nodes = push.count * (kHasOrders ? DOLP_WIDTH : 1u);
  columns_out[nodes * DOLP_AZIMUTH_NUMBERS + gl_GlobalInvocationID.x * each + position] = value;
}
#endif
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_SLOPES) readonly buffer Slopes { SlopeNode slopes[]; };
layout(std430, binding = DOLP_BINDING_AZIMUTHS) writeonly buffer AzimuthsOut { AzimuthNode azimuths[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  SlopeNode slope_node = slopes[push.first + min(i, push.count - 1u)];
  ThetaNode theta;
  theta.c = thetas[int(slope_node.theta)].c;
  theta.s = thetas[int(slope_node.theta)].s;
  SlopeResult result = integrate_azimuths(rule, theta, indices[int(slope_node.index)], slope_node);
  if (i < push.count) {
    for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
      azimuths[i * DOLP_ORDER_WIDTH + g] = result.node[g];
      store_azimuth_columns(g, result.columns[g]);
    }
  }
}
