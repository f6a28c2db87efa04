#version 460
#extension GL_GOOGLE_include_directive : require
#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < push.count) build_masking_table(shapes[push.first + i], (push.first + i) * kMaskingNodes);
}
