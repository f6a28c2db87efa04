// The only file of the kernel source whose text depends on the language.
// GLSL: the build defines DOLP_DOUBLE if it compiles for double precision.
// C++: the including file defines `real`, the GLM types real2 and real4, and the functions of GLSL (sqrt, clamp, ldexp
// ...). The class that contains the kernel source has functions that read data (masking_node, rule_node).
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
