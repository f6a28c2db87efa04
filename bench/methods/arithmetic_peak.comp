#version 460
#extension GL_GOOGLE_include_directive : require
// Multiplies and adds as fast as the device can. Each invocation has twelve independent chains of operations. While one
// chain waits for a result, other chains continue.

#include "physics/prelude.glsl"
#include "interface.glsl"

layout(local_size_x_id = DOLP_SPEC_LOCAL_SIZE) in;
layout(push_constant) uniform PushConstants { DOLP_PUSH_CONSTANTS } push;
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer Results { real results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  real a = real(0.5) + real(i) * real(1e-7);  // depends on i, so that the compiler cannot compute the chains in advance
  real b = real(1.0) - a;
  real x0 = real(0.10), x1 = real(0.15), x2 = real(0.20), x3 = real(0.25), x4 = real(0.30), x5 = real(0.35);
  real x6 = real(0.40), x7 = real(0.45), x8 = real(0.50), x9 = real(0.55), x10 = real(0.60), x11 = real(0.65);
  for (int k = 0; k < DOLP_PEAK_TURNS; ++k) {
    for (int j = 0; j < 8; ++j) {
      x0 = x0 * a + b;
      x1 = x1 * a + b;
      x2 = x2 * a + b;
      x3 = x3 * a + b;
      x4 = x4 * a + b;
      x5 = x5 * a + b;
      x6 = x6 * a + b;
      x7 = x7 * a + b;
      x8 = x8 * a + b;
      x9 = x9 * a + b;
      x10 = x10 * a + b;
      x11 = x11 * a + b;
    }
  }
  if (i < push.count) results[i] = ((x0 + x1) + (x2 + x3)) + ((x4 + x5) + (x6 + x7)) + ((x8 + x9) + (x10 + x11));
}
