// The whole text in the order that GLSL needs: every function before its first use.
#include "physics/elementary.glsl"
#include "physics/slope.glsl"
#include "physics/fresnel.glsl"
#include "physics/quadrature.glsl"
#include "physics/masking.glsl"
#include "physics/masking_table.glsl"
#include "physics/integrand.glsl"
#include "physics/moments.glsl"
