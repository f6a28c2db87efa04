// Constants and buffers of the kernel source in GLSL. In C++ they are members of the class that includes the source.
layout(local_size_x_id = DOLP_SPEC_LOCAL_SIZE) in;
layout(constant_id = DOLP_SPEC_DISTRIBUTION) const uint kDistribution = DOLP_CAUCHY;
layout(constant_id = DOLP_SPEC_MASKING) const uint kMasking = DOLP_MASKING_NONE;
layout(constant_id = DOLP_SPEC_TOTAL_REFLECTION) const bool kTotalReflection = false;
#ifdef DOLP_SINGLE_SCATTERING
const bool kIsMultiple = false;
#else
layout(constant_id = DOLP_SPEC_MULTIPLE) const bool kIsMultiple = false;
#endif
layout(constant_id = DOLP_SPEC_DIRECT) const bool kHasDirect = false;
layout(constant_id = DOLP_SPEC_CURVES) const bool kHasCurves = false;
const bool kHasOrders = DOLP_ORDERS == 1;
#if DOLP_MOST_COLUMNS > 0
layout(constant_id = DOLP_SPEC_COLUMN_COUNT) const uint kColumnCount = 0u;
layout(constant_id = DOLP_SPEC_COLUMNS) const uint kColumns = DOLP_COLUMNS_SKY;
// Number of functions in the table of a sky: one for each column, but only one for all responses (columns.glsl).
int sky_functions() { return kColumns == DOLP_COLUMNS_SKY ? int(kColumnCount) : 1; }
#else
const uint kColumns = DOLP_COLUMNS_SKY;
#endif

layout(push_constant) uniform PushConstants { DOLP_PUSH_CONSTANTS } push;

layout(constant_id = DOLP_SPEC_STORED_NODES) const bool kStoredNodes = false;
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Rule { RuleNode rule; real2 stored_nodes[]; };
layout(std430, binding = DOLP_BINDING_SHAPES) readonly buffer Shapes { ShapeNode shapes[]; };
layout(std430, binding = DOLP_BINDING_MASKING_TABLE) writeonly buffer MaskingTable { real4 masking_table[]; };

// Texel buffers hold the data that neighbouring invocations read at different positions. From a storage buffer,
// processors without AVX-512 read such data slowly: one lane after the other. Some devices allow only 65,536 texels, so
// a longer list of rule nodes is in a storage buffer. Masking tables are always texels (RowTiles::blocks()).
#ifdef DOLP_DOUBLE
layout(binding = DOLP_BINDING_RULE_NODES) uniform usamplerBuffer rule_nodes;
layout(binding = DOLP_BINDING_MASKING_NODES) uniform usamplerBuffer masking_nodes;
real2 to_real2(uvec4 texel) { return real2(packDouble2x32(texel.xy), packDouble2x32(texel.zw)); }
real2 texel_node(int i) { return to_real2(texelFetch(rule_nodes, i)); }
real4 masking_node(uint i) {
  return real4(to_real2(texelFetch(masking_nodes, int(2u * i))), to_real2(texelFetch(masking_nodes, int(2u * i + 1u))));
}
#else
layout(binding = DOLP_BINDING_RULE_NODES) uniform samplerBuffer rule_nodes;
layout(binding = DOLP_BINDING_MASKING_NODES) uniform samplerBuffer masking_nodes;
real2 texel_node(int i) { return texelFetch(rule_nodes, i).xy; }
real4 masking_node(uint i) { return texelFetch(masking_nodes, int(i)); }
#endif
// The Gauss rules come first and always fit in the texels. They have no branch: with one in their loops, a driver took
// four times as long to compile a kernel.
real2 rule_node(int i) { return texel_node(i); }
real2 table_node(int i) {
  if (kStoredNodes) return stored_nodes[i];
  return texel_node(i);
}

int largest_order() { return int(push.largest_order); }
int sky_cells() { return 1 << int(push.sky & ((1u << DOLP_SKY_CORNERS_SHIFT) - 1u)); }
int pushed_corners() { return int((push.sky >> DOLP_SKY_CORNERS_SHIFT) & ((1u << (DOLP_SKY_START_SHIFT - DOLP_SKY_CORNERS_SHIFT)) - 1u)); }
int sky_start() { return int(push.sky >> DOLP_SKY_START_SHIFT); }
void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
