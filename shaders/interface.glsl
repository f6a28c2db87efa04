// Interface of host and shaders: bindings, specialization constants, push constants, structures. Both read this file.
// The structures contain only `real` (float or double). So std430 packs them tightly, and the host may treat an array
// of them as an array of numbers. Counts stored as `real` are small integers.

// ---- Bindings of descriptor set 0: storage buffers, and texel buffers from DOLP_BINDING_RULE_NODES on ----------------
#define DOLP_BINDING_THETAS 0         // ThetaNode[]
#define DOLP_BINDING_SHAPES 1         // ShapeNode[]
#define DOLP_BINDING_INDICES 2        // IndexNode[]
#define DOLP_BINDING_TASKS 3          // uvec4[]: theta, first shape (among the bound ones), index, task word
#define DOLP_BINDING_MASKING_TABLE 4  // real4[]: one table per bound shape, see physics/masking.glsl
#define DOLP_BINDING_MOMENTS 5        // MomentsNode[]: one for each member of each task of the dispatch
#define DOLP_BINDING_RULE 6           // RuleNode: one for all tasks
#define DOLP_BINDING_RULE_NODES 7     // real2[]: see physics/quadrature.glsl
#define DOLP_BINDING_MASKING_NODES 8  // the masking table again, for reading
// slopes.comp reads directions, indices, rule and rule nodes. Instead of the tasks and the moments it has:
#define DOLP_BINDING_SLOPES DOLP_BINDING_TASKS      // SlopeNode[]: one for each invocation
#define DOLP_BINDING_AZIMUTHS DOLP_BINDING_MOMENTS  // AzimuthNode[]: one for each invocation
// mueller.comp reads the rule nodes. Instead of the directions and the moments it has:
#define DOLP_BINDING_BEAMS DOLP_BINDING_THETAS      // BeamNode[]: one for each entry of the dispatch
#define DOLP_BINDING_MUELLERS DOLP_BINDING_MOMENTS  // MuellerNode[]: one for each entry of the dispatch

// ---- Specialization constants --------------------------------------------------------------------------------------
#define DOLP_SPEC_LOCAL_SIZE 0
#define DOLP_SPEC_DISTRIBUTION 1  // DOLP_CAUCHY | DOLP_GAUSSIAN
#define DOLP_SPEC_MASKING 2       // DOLP_MASKING_*
#define DOLP_SPEC_TOTAL_REFLECTION 3  // true if any index of the request has a critical_cos
#define DOLP_SPEC_MULTIPLE 4          // true if rays are followed through all their bounces
#define DOLP_SPEC_DIRECT 5            // true if the request needs the direct emission
#define DOLP_SPEC_COLUMN_COUNT 6      // number of columns, see physics/columns.glsl
#define DOLP_SPEC_COLUMNS 7           // kind of the columns, DOLP_COLUMNS_*
#define DOLP_SPEC_CURVES 8            // true if reflectances are read from tables, for films and measurements

#define DOLP_CAUCHY 0u
#define DOLP_GAUSSIAN 1u
#define DOLP_MASKING_NONE 0u
#define DOLP_MASKING_V_CAVITY 1u
#define DOLP_MASKING_INTEGRAL 2u
#define DOLP_MASKING_SMITH 3u
#define DOLP_COLUMNS_SKY 0u           // functions of a sky
#define DOLP_COLUMNS_RESPONSE 1u      // responses of the reflected light
#define DOLP_COLUMNS_SKY_RESPONSE 2u  // responses of the reflected light, weighted with a function of a sky
#define DOLP_COLUMNS_DIRECT 3u        // responses of the direct emission

// ---- Push constants: four uints, used by all entry points -----------------------------------------------------------
// count: tasks of this dispatch (moments.comp), slopes (slopes.comp), entries (mueller.comp) or shapes bound
// (masking_table.comp); first: the first of them, as a position in the bound buffers. Output i of a dispatch belongs to
// entry first + i, outputs i * DOLP_WIDTH and following to task first + i. largest_order: of the rule nodes.
// sky: log2 of the cells of a function, from DOLP_SKY_CORNERS_SHIFT on the number of its corners, whose cosines follow
// the cells, and from DOLP_SKY_START_SHIFT on where the cells begin among the rule nodes. Columns stand behind
// the other outputs of a dispatch, see moments.comp and slopes.comp.
#define DOLP_PUSH_CONSTANTS uint first; uint count; uint largest_order; uint sky;
#define DOLP_SKY_CORNERS_SHIFT 5
#define DOLP_SKY_START_SHIFT 10

// ---- Task word: task of an invocation of moments.comp, as bits -----------------------------------------------------
#define DOLP_TASK_MEMBERS_BITS 5u    // from bit 0: members of the row
#define DOLP_TASK_PIECE_SHIFT 5u     // number of the piece of the slope axis
#define DOLP_TASK_PIECE_BITS 6u
#define DOLP_TASK_ROOT_AT_START 11u   // bit: square root of the slope at the start of the piece
#define DOLP_TASK_ROOT_AT_END 12u    // bit: square root of the slope at the end of the piece
#define DOLP_TASK_ROOT_BEFORE_START 13u // bit: a square root at the breakpoint before the piece, facing it
#define DOLP_TASK_ROOT_AFTER_END 14u // bit: a square root at the breakpoint after the piece, facing it
#define DOLP_TASK_SPLIT_LINE 15u     // bit: the direction is split at the line b = pi/2 of `integral` or smith's cusp
#define DOLP_TASK_AZIMUTHS_SHIFT 16u // most azimuths of an arc, which bounds the iterations

// ---- Sizes ---------------------------------------------------------------------------------------------------------
#ifndef DOLP_WIDTH
#define DOLP_WIDTH 1             // entries of one invocation, see Row of physics/row.glsl
#endif
#define DOLP_ROW_WIDTH 4         // the larger of the two values of DOLP_WIDTH
#ifndef DOLP_MOST_COLUMNS
#define DOLP_MOST_COLUMNS 0      // 0 in kernels without columns
#endif
#define DOLP_COLUMNS 24          // largest number of columns of any kind
#define DOLP_SKY_FUNCTIONS 8     // largest number of functions of a sky: DOLP_MOST_COLUMNS in kernels for skies
#define DOLP_MOST_SKY_CORNERS 24 // most corners that split the azimuths
#define DOLP_COLUMN_PARTS 4      // numbers of a column in the output of moments.comp: i and q of the coarser and the finer rule
#define DOLP_MAX_PIECES 63       // pieces of the slope axis for one direction
#define DOLP_MAX_ARCS 13        // arcs of the azimuth for one slope, without the arcs of total reflection
// V-grooves, see physics/groove.glsl
#define DOLP_STEEPEST_SPLIT 20.0  // beyond this slope no beam that ends splits the azimuths
#define DOLP_MOST_SPLITS 8       // bounces at which a beam that ends may split the azimuths
#define DOLP_MOST_BOUNCES 32      // each computed separately; later bounces are combined in groups of 2, 4, 8 ...
#define DOLP_GROUPS_PER_DISTANCE 6 // bounces taken as one at once, over those before or after them
#define DOLP_MOST_DOUBLINGS 12
#define DOLP_LAST_BOUNCES (DOLP_MOST_BOUNCES << DOLP_MOST_DOUBLINGS)  // after more bounces no light is left
#define DOLP_CURVE_NODES 6       // rule nodes of a cell of a table of reflectances: a cubic for each of three quantities
#define DOLP_MAX_ORDER 128       // largest Gauss order of the rule nodes
#define DOLP_MASKING_OCTAVES 29  // octaves of v = 1 + tau/scale
#define DOLP_MASKING_CELL_BITS_FLOAT 3   // 2^bits cells per octave
#define DOLP_MASKING_CELL_BITS_DOUBLE 6
#define DOLP_MASKING_NODES(CELL_BITS) ((DOLP_MASKING_OCTAVES << (CELL_BITS)) + 1)

// ---- Structures ----------------------------------------------------------------------------------------------------

// Parameters of the orders of the Gauss rules; physics/orders.glsl has the formulas.
struct RuleNode {
  real digits;            // decimal digits required of the sums
  real t_nodes;           // slope axis: nodes of a piece for any number of digits,
  real t_digits;          // digits that the size of its singularities needs,
  real t_fall;            // and nodes per e-fold by which the density falls over the piece
  real phi_nodes;         // azimuth: nodes of an arc for any number of digits,
  real phi_digits;        // and digits that the size of its singularities needs
  real cluster_stretch;   // nodes per digit that make smith's cusp worth a cluster
  real split_bounces;     // with all bounces: number of bounces at which a beam that ends splits the azimuths,
  real dimmest;           // and the share of a ray's light below which it is not followed
  real cluster_below_q;   // below this q, arcs cluster their nodes where the limit b of `integral` meets pi/2
  real response_scale;    // for responses: 1 / c0
  real response_norm;     // for responses: 2 / asinh(1 / c0)
};

// One direction theta, with the pieces of the slope axis t = tan(alpha) on which the integrand is smooth. Under total
// reflection the pieces also depend on the index, so a direction has a node for each such index. With `integral` and
// smith masking they depend on the slope distribution, which may need one more line.
struct ThetaNode {
  real c;                         // cos(theta)
  real s;                         // sin(theta)
  // ascending slopes; the last one also fills all later elements, and may exceed any cut
  real end[DOLP_MAX_PIECES + 1];
};

// One slope sample (host/compute/evaluate/kernel/slope_samples.hpp).
struct SlopeNode {
  real t;
  real digits;         // digits that the sum over the azimuths needs
  real theta;          // position of the direction
  real index;          // position of the index
  real most_azimuths;  // largest number of azimuths of an arc
  real is_coarse;      // 1: the slope belongs to the coarser rule
};

// One slope distribution.
struct ShapeNode {
  real m;              // sqrt(2) sigma
  real q_minus_1;      // exponent q minus 1, which a float q would not resolve near 1; unused by the Gaussian
  real two_q_minus_3;  // 2q minus 3, which a float q would not resolve near 3/2, where smith masking ends
  real marginal_norm;  // p(0) of the in-plane marginal
  real scale;          // w of the map t = w sinh(X)
  real cut;            // larger slopes are left out
  real table_scale;    // scale of the masking table: v = 1 + tau/table_scale
  real cusp_digits;    // log10 of the size of smith's cusp at theta_r = 0; below -100 without one
};

// One complex refractive index N = n + ik.
struct IndexNode {
  real n2m1_re;       // Re(N^2 - 1)
  real n2m1_im;       // Im(N^2 - 1)
  real pole_re;       // R_p's pole in cos(beta), -1 / sqrt(N^2 + 1)
  real pole_im;
  real branch_re;     // the branch point of w in cos(beta), i sqrt(N^2 - 1), with positive parts
  real branch_im;
  real critical_cos;  // sqrt(1 - Re N^2), where total reflection begins, sharply (k = 0) or nearly so; otherwise 0
  real curve_start;   // position of the table of reflectances among the rule nodes,
  real curve_cells;   // and its number of cells; 0 without a table
};

// One geometry of the pBRDF: incident beam, reflected beam, and the facet between them.
struct GeometryNode {
  real c_i;  // cos(theta_i)
  real s_i;
  real c_r;  // cos(theta_r)
  real s_r;
  real slope;  // tan(alpha)
  real cos_beta;
  real cos_2eta_i;
  real sin_2eta_i;
  real cos_2eta_r;
  real sin_2eta_r;
};

// One pBRDF to evaluate. The host computes whatever would cancel or overflow in a float: the geometry, the reflection
// of the facet and the density.
struct BeamNode {
  GeometryNode g;
  ShapeNode shape;  // has the scale and cut of physics/in_plane.glsl
  real density;     // D(alpha) / 4 [1/sr] without a power of two that the host keeps: in [1/2, 1), or 0
  // Mueller matrix of the facet in its own frame: [m00 m01 0 0; m01 m00 0 0; 0 0 cross_re -cross_im; 0 0 cross_im
  // cross_re], r_s* r_p = cross_re + i cross_im.
  real m00;
  real m01;
  real cross_re;
  real cross_im;
};

// A Mueller matrix, row by row.
struct MuellerNode {
  real m[16];
};

#define DOLP_AZIMUTH_NUMBERS 8  // numbers of an AzimuthNode
#define DOLP_MOMENTS_NUMBERS 13  // numbers of a MomentsNode

// The moments of the facets of one slope, per unit of P(t) t dt: sums over half of the azimuths.
struct AzimuthNode {
  real r_i;
  real r_q;
  real albedo;
  real deficit;
  real behind;  // MomentsNode::behind
  real direct_i;
  real direct_q;
  real evaluations;
};

// Moments times cos(theta) (shaders/physics/README.md, section 3), from the finer of two rules, and their distances
// from the coarser one (physics/moments.glsl).
struct MomentsNode {
  real r_i;
  real r_q;
  real albedo;
  real deficit;
  real behind;               // facets that face away from theta; the absorbed part counts them once in each direction
  real many;                 // part of r_i from grooves in which rays bounce more often than DOLP_MOST_BOUNCES
  real direct_i;             // direct emission
  real direct_q;
  real reflected_difference; // the larger difference of r_i and r_q
  real albedo_difference;
  real deficit_difference;
  real direct_difference;    // the larger difference of direct_i and direct_q
  real evaluations;
};
