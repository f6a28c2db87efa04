// The data that the kernel source reads, for the GLSL entry points; the C++ class that includes it has members instead.
layout(local_size_x_id = DOLP_SPEC_LOCAL_SIZE) in;
layout(constant_id = DOLP_SPEC_DISTRIBUTION) const uint kDistribution = DOLP_CAUCHY;
layout(constant_id = DOLP_SPEC_MASKING) const uint kMasking = DOLP_MASKING_NONE;
layout(constant_id = DOLP_SPEC_TOTAL_REFLECTION) const bool kTotalReflection = false;
layout(constant_id = DOLP_SPEC_MULTIPLE) const bool kIsMultiple = false;
layout(constant_id = DOLP_SPEC_DIRECT) const bool kHasDirect = false;

layout(push_constant) uniform PushConstants { DOLP_PUSH_CONSTANTS } push;

layout(std430, binding = DOLP_BINDING_SHAPES) readonly buffer Shapes { ShapeNode shapes[]; };
layout(std430, binding = DOLP_BINDING_RULE_NODES) readonly buffer RuleNodes { real2 rule_nodes[]; };
layout(std430, binding = DOLP_BINDING_MASKING_TABLE) buffer MaskingTable { real4 masking_table[]; };

int largest_order() { return int(push.largest_order); }
real2 rule_node(int i) { return rule_nodes[i]; }
real4 masking_node(uint i) { return masking_table[i]; }
void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
