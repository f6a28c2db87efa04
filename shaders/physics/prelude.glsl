// The only file that depends on the language.
//
// GLSL: the build defines DOLP_DOUBLE for the modules in double.
// C++:  the including class is in a namespace with `real`, its GLM types (real2, real4) and GLM's sqrt, abs, min, max,
// clamp, floor, ldexp, floatBitsToUint. The functions that read data (masking_node, rule_node) are members.
#ifdef __cplusplus
#define CONST static constexpr
#define precise
#else
#define CONST const
#ifdef DOLP_DOUBLE
#define real double
#define real2 dvec2
#define real4 dvec4
#else
#define real float
#define real2 vec2
#define real4 vec4
#endif
#endif
