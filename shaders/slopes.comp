#version 460
#extension GL_GOOGLE_include_directive : require
// Sums over the azimuths at one slope per invocation, of maskings that do not depend on the slope distribution: they
// serve every distribution (host/compute/evaluate/kernel/slope_samples.hpp).

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_SLOPES) readonly buffer Slopes { SlopeNode slopes[]; };
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Rule { RuleNode rule; };
layout(std430, binding = DOLP_BINDING_AZIMUTHS) writeonly buffer AzimuthsOut { AzimuthNode azimuths[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  SlopeNode own = slopes[push.first + min(i, push.count - 1u)];
  ThetaNode theta;
  theta.c = thetas[int(own.theta)].c;
  theta.s = thetas[int(own.theta)].s;
  AzimuthNode result = azimuths_of(rule, theta, indices[int(own.index)], own);
  if (i < push.count) azimuths[i] = result;
}
