#version 460
#extension GL_GOOGLE_include_directive : require
// Moments of one entry per invocation.

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_ENTRIES) readonly buffer Entries { uvec4 entries[]; };
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Rule { RuleNode rule; };
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer MomentsOut { MomentsNode moments[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 entry = entries[push.first + min(i, push.count - 1u)];
  MomentsNode result = moments_entry(rule, thetas[entry.x], shapes[entry.y], indices[entry.z], entry.y * kMaskingNodes);
  if (i < push.count) moments[i] = result;
}
