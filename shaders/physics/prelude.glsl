// The only file of the kernel source whose text depends on the language.
//
// GLSL: the build defines DOLP_DOUBLE when it compiles a module in double.
// C++: the class that includes the kernel source lies in a namespace that defines `real`, its vectors real2 and real4
// of GLM, and GLSL's functions (sqrt, clamp, ldexp ...). Functions that read data (masking_node, rule_node) are members
// of the class.
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
