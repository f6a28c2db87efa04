#version 460
#extension GL_GOOGLE_include_directive : require
// Computes one piece of the slope axis for a row of DOLP_WIDTH entries that differ only in the exponent q.

// This macro leaves out the code for several bounces, which only slopes.comp needs. So drivers compile faster.
#define DOLP_SINGLE_SCATTERING
#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"

#if DOLP_MOST_COLUMNS > 0
// The columns (physics/columns.glsl) follow all MomentsNodes: DOLP_COLUMN_PARTS numbers per column and entry.
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer ColumnsOut { real columns_out[]; };

void store_column(uint position, real value) {
  uint invocation = gl_GlobalInvocationID.x;
  if (invocation >= push.count) return;
  uint members = push.count * DOLP_WIDTH;
  columns_out[members * DOLP_MOMENTS_NUMBERS + invocation * (DOLP_WIDTH * DOLP_COLUMN_PARTS * kColumnCount) + position] = value;
}
#endif
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_TASKS) readonly buffer Tasks { uvec4 tasks[]; };
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer MomentsOut { MomentsNode moments[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 words = tasks[push.first + min(i, push.count - 1u)];
  Task task = unpack_task(words.w);
  ThetaNode theta;
  theta.c = thetas[words.x].c;
  theta.s = thetas[words.x].s;
  task.before = thetas[words.x].end[max(task.piece - 1, 0)];
  task.start = thetas[words.x].end[task.piece];
  task.end = thetas[words.x].end[min(task.piece + 1, DOLP_MAX_PIECES)];
  task.after = thetas[words.x].end[min(task.piece + 2, DOLP_MAX_PIECES)];
  task.last = thetas[words.x].end[DOLP_MAX_PIECES];
  Row row;
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    uint shape = words.y + uint(min(g, task.members - 1));
    row.shape[g] = shapes[shape];
    row.table[g] = shape * kMaskingNodes;
  }
  RowMoments result = piece_moments(rule, theta, row, indices[words.z], task);
  if (i < push.count) {
    for (int g = 0; g < DOLP_WIDTH; ++g) moments[i * DOLP_WIDTH + g] = result.member[g];
  }
}
