#version 460
#extension GL_GOOGLE_include_directive : require
// Divides and takes square roots. The host measures their errors (host/compute/evaluate/vulkan/arithmetic.cpp).
#include "physics/prelude.glsl"
#include "interface.glsl"

layout(local_size_x_id = DOLP_SPEC_LOCAL_SIZE) in;
layout(push_constant) uniform PushConstants { DOLP_PUSH_CONSTANTS } push;
layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Operands { real2 operands[]; };
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer Results { real results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  real2 operand = operands[i];
  results[3u * i] = operand.x / operand.y;
  results[3u * i + 1u] = real(1.0) / operand.y;  // drivers may have a faster way than for other quotients
  results[3u * i + 2u] = sqrt(abs(operand.y));
}
