#version 460
#extension GL_GOOGLE_include_directive : require
// What one piece of the slope axis adds to the moments of a row of entries, per invocation; the compiler is told the
// width of a row.

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_TASKS) readonly buffer Tasks { uvec4 tasks[]; };
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Rule { RuleNode rule; };
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer MomentsOut { MomentsNode moments[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 own = tasks[push.first + min(i, push.count - 1u)];
  Task task = task_of(own.w);
  Row row;
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    uint shape = own.y + uint(min(g, task.members - 1));
    row.shape[g] = shapes[shape];
    row.table[g] = shape * kMaskingNodes;
  }
  RowMoments result = piece_moments(rule, thetas[own.x], row, indices[own.z], task);
  if (i < push.count) {
    for (int g = 0; g < DOLP_WIDTH; ++g) moments[i * DOLP_WIDTH + g] = result.member[g];
  }
}
