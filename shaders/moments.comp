#version 460
#extension GL_GOOGLE_include_directive : require
// What one piece of the slope axis adds to the moments of a group of entries, per invocation; the compiler is told the
// size of a group.

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
  Group group;
  for (int g = 0; g < DOLP_GROUP; ++g) {
    uint shape = entry.y + min(uint(g), (entry.w & 255u) - 1u);
    group.shape[g] = shapes[shape];
    group.table[g] = shape * kMaskingNodes;
  }
  GroupMoments result = piece_moments(rule, thetas[entry.x], group, indices[entry.z], int(entry.w >> 8));
  if (i < push.count) {
    for (int g = 0; g < DOLP_GROUP; ++g) moments[i * DOLP_GROUP + g] = result.member[g];
  }
}
