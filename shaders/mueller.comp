#version 460
#extension GL_GOOGLE_include_directive : require
#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_BEAMS) readonly buffer Beams { BeamNode beams[]; };
layout(std430, binding = DOLP_BINDING_MUELLERS) writeonly buffer MuellersOut { MuellerNode muellers[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  MuellerNode result = mueller(beams[push.first + min(i, push.count - 1u)]);
  if (i < push.count) muellers[i] = result;
}
