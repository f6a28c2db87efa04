// The interface between host and shaders. Structures have only members of type `real` (float or double), so std430
// packs them tightly and the host may treat them as arrays. Counts are `real`, too. They are exact, as they are small.

// ---- Bindings of descriptor set 0: storage buffers; from DOLP_BINDING_RULE_NODES, texel buffers ---------------------
#define DOLP_BINDING_THETAS 0         // ThetaNode[]
#define DOLP_BINDING_SHAPES 1         // ShapeNode[]
#define DOLP_BINDING_INDICES 2        // IndexNode[]
#define DOLP_BINDING_TASKS 3          // uvec4[]: positions in THETAS, SHAPES and INDICES, and the task word (see below)
#define DOLP_BINDING_MASKING_TABLE 4  // real4[]: written by masking_table.comp, one table per ShapeNode
#define DOLP_BINDING_MOMENTS 5        // MomentsNode[]: the output, DOLP_WIDTH nodes per task
#define DOLP_BINDING_RULE 6           // RuleNode: one for all tasks; real2[]: the rule nodes if DOLP_SPEC_STORED_NODES
#define DOLP_BINDING_RULE_NODES 7     // real2[]: nodes of the Gauss rules, see physics/quadrature.glsl
#define DOLP_BINDING_MASKING_NODES 8  // the masking tables as texels, from which moments.comp reads
#define DOLP_BINDING_SLOPES DOLP_BINDING_TASKS      // SlopeNode[]: the input, one node per invocation
#define DOLP_BINDING_AZIMUTHS DOLP_BINDING_MOMENTS  // AzimuthNode[]: the output, one node per invocation

// ---- Specialization constants --------------------------------------------------------------------------------------
#define DOLP_SPEC_LOCAL_SIZE 0
#define DOLP_SPEC_DISTRIBUTION 1  // DOLP_CAUCHY | DOLP_GAUSSIAN
#define DOLP_SPEC_MASKING 2       // DOLP_MASKING_*
#define DOLP_SPEC_TOTAL_REFLECTION 3  // true if any index has total reflection (IndexNode::critical_cos > 0)
#define DOLP_SPEC_MULTIPLE 4          // true if rays are followed through all bounces in a groove
#define DOLP_SPEC_DIRECT 5            // true if the request needs the emission straight to the viewer
#define DOLP_SPEC_COLUMN_COUNT 6      // number of columns. A column is a sum over the facets, see physics/columns.glsl
#define DOLP_SPEC_COLUMNS 7           // kind of the columns, DOLP_COLUMNS_*
#define DOLP_SPEC_CURVES 8            // true if reflectances come from tables, for films and measured reflectances
#define DOLP_SPEC_STORED_NODES 9      // true if there are more rule nodes than texels in a buffer of the device

#define DOLP_CAUCHY 0u
#define DOLP_GAUSSIAN 1u
#define DOLP_MASKING_NONE 0u
#define DOLP_MASKING_V_CAVITY 1u
#define DOLP_MASKING_INTEGRAL 2u
#define DOLP_MASKING_SMITH 3u
#define DOLP_COLUMNS_SKY 0u           // integrands of r_i and r_q times a function of the sky, see physics/columns.glsl
#define DOLP_COLUMNS_RESPONSE 1u      // responses: r_i and r_q with polynomials instead of the reflectances
#define DOLP_COLUMNS_SKY_RESPONSE 2u  // responses, with a function of the sky as a factor of the integrand
#define DOLP_COLUMNS_DIRECT 3u        // responses of the direct emission

// ---- Push constants of all entry points -----------------------------------------------------------------------------
// first, count: position of the first task (moments.comp), slope (slopes.comp) or shape (masking_table.comp), and their
// number. The outputs of the first two begin at position 0.
// largest_order: largest order of the rules in DOLP_BINDING_RULE_NODES.
// sky: from bit 0, log2 of the number of cells in the table of each function of the sky; from bit
// DOLP_SKY_CORNERS_SHIFT, the number of corners (kinks of the radiance over the zenith); from bit DOLP_SKY_START_SHIFT,
// the position of the first cell among the rule nodes. The cosines of the corners follow the cells.
#define DOLP_PUSH_CONSTANTS uint first; uint count; uint largest_order; uint sky;
#define DOLP_SKY_CORNERS_SHIFT 5
#define DOLP_SKY_START_SHIFT 10

// ---- Task word: the bits that describe the task of an invocation of moments.comp ------------------------------------
#define DOLP_TASK_MEMBERS_BITS 5u    // bits 0 to 4: number of entries that the invocation computes
#define DOLP_TASK_PIECE_SHIFT 5u     // bits 5 to 10: index of the piece of the slope axis
#define DOLP_TASK_PIECE_BITS 6u
#define DOLP_TASK_ROOT_AT_START 11u   // bit: the integrand behaves like a square root at the start of the piece
#define DOLP_TASK_ROOT_AT_END 12u    // bit: square root at the end of the piece
#define DOLP_TASK_ROOT_BEFORE_START 13u // bit: square root at the start of the preceding piece
#define DOLP_TASK_ROOT_AFTER_END 14u // bit: square root at the end of the next piece
#define DOLP_TASK_SPLIT_LINE 15u     // bit: pieces or arcs are split at the kink of smith or `integral` masking
#define DOLP_TASK_AZIMUTHS_SHIFT 16u // bits 16 to 31: at most this many azimuth nodes on an arc; limits the loops

// ---- Sizes ---------------------------------------------------------------------------------------------------------
#ifndef DOLP_WIDTH
#define DOLP_WIDTH 1             // number of entries that one invocation computes, see Row of physics/row.glsl
#endif
#define DOLP_ROW_WIDTH 4         // DOLP_WIDTH in the kernels that compute several entries
#ifndef DOLP_ORDERS
#define DOLP_ORDERS 0            // 1 in kernels whose entries are azimuthal orders of one slope, see SlopeNode::order
#endif
#ifndef DOLP_MOST_COLUMNS
#define DOLP_MOST_COLUMNS 0      // largest number of columns in the kernel being compiled; 0 if it has no columns
#endif
#define DOLP_COLUMNS 24          // largest number of columns that any kernel computes
#define DOLP_SKY_FUNCTIONS 8     // largest number of functions of a sky; also of columns in the kernels for skies
#define DOLP_MOST_SKY_CORNERS 24 // largest number of corners of a sky that split the azimuths
#define DOLP_COLUMN_PARTS 4      // numbers per column: r_i and r_q by the coarser rule, r_i and r_q by the finer rule
#define DOLP_MAX_PIECES 63       // largest number of pieces of the slope axis for one direction
#define DOLP_MAX_ARCS 13         // largest number of azimuth arcs; total reflection and kinks split these arcs further
// V-grooves, see physics/groove.glsl
#define DOLP_STEEPEST_SPLIT 20.0  // for slopes below this, azimuths are split where the number of bounces changes
#define DOLP_MOST_SPLITS 8       // largest RuleNode::split_bounces
#define DOLP_MOST_BOUNCES 32      // rays with more bounces are followed in groups of 1, 2, 4, 8 ... bounces
#define DOLP_GROUPS_PER_DISTANCE 6 // a group of n > 1 bounces has at least 6 n bounces before it and 5 n after it
#define DOLP_MOST_DOUBLINGS 12    // a group has at most 2^12 bounces
#define DOLP_LAST_BOUNCES (DOLP_MOST_BOUNCES << DOLP_MOST_DOUBLINGS)  // a ray with more bounces is absorbed
#define DOLP_MOST_ROW_KINKS 24   // largest number of kinks of measured reflectances and corners of a sky together
#define DOLP_CURVE_ALIGNMENT 64  // tables of reflectances begin at multiples of this; so curve_start is exact in float
#define DOLP_CURVE_NODES 6       // pairs of numbers per cell of a reflectance table: 3 cubics with 4 coefficients each
// Azimuth nodes per radian that resolve cos(2 k phi), divided by k. Gauss rules on an arc without a map need more than
// 0.5. Errors stated at a width ratio of 3 fall to half from 0.5 to 0.7, and not further up to 1.
#define DOLP_NODES_OF_ORDER 0.7
#define DOLP_MAX_ORDER 128       // largest order (number of nodes) of a Gauss rule
#define DOLP_MASKING_OCTAVES 29  // octaves of v = 1 + tau / table_scale in a masking table, where tau is a slope
#define DOLP_MASKING_CELL_BITS_FLOAT 3   // a masking table has 2^bits cells per octave
#define DOLP_MASKING_CELL_BITS_DOUBLE 6
#define DOLP_MASKING_NODES(CELL_BITS) ((DOLP_MASKING_OCTAVES << (CELL_BITS)) + 1)

// ---- Structures ----------------------------------------------------------------------------------------------------

// Constants of the formulas in physics/orders.glsl, which compute the numbers of nodes of the Gauss rules.
struct RuleNode {
  real digits;            // decimal digits required of the moments
  real t_nodes;           // slope axis: constant part of the number of nodes of a piece
  real t_digits;          // slope axis: a fitted constant, added to the required digits
  real t_fall;            // slope axis: nodes per factor e by which the share of steeper facets falls within a piece
  real phi_nodes;         // azimuth: nodes per radian of an arc, in addition to the nodes that the digits require
  real phi_digits;        // azimuth: a fitted constant, added to the required digits
  real cluster_stretch;   // smith masking: nodes cluster at a cusp of G that costs more nodes per digit than this
  real split_bounces;     // V-grooves: at most this many lines where the number of bounces changes split the azimuths
  real dimmest;           // V-grooves: a ray is followed until less than this share of its light is left
  real cluster_below_q;   // masking `integral`: if q is below this, nodes cluster at the azimuth where G has a kink
  real response_scale;    // 1 / c0. The Chebyshev polynomials of responses resolve the finest detail at cos(beta) < c0
  real response_norm;     // 2 / asinh(1 / c0), for the same polynomials (chebyshev_at() in physics/columns.glsl)
};

// One direction theta, and the pieces of the slope axis t = tan(alpha) on which the integrand is smooth. The pieces may
// depend on the index or on the slope distribution. Then the direction has one ThetaNode for each set of pieces.
struct ThetaNode {
  real c;                         // cos(theta)
  real s;                         // sin(theta)
  real end[DOLP_MAX_PIECES + 1];  // piece k goes from slope end[k] to end[k + 1]; unused elements repeat the last end
};

// A slope at which slopes.comp sums over the azimuths (host/compute/evaluate/kernel/slope_samples.hpp).
struct SlopeNode {
  real t;
  real digits;         // digits that the sum over the azimuths needs
  real theta;          // position of the direction among the ThetaNodes
  real index;          // position of the index among the IndexNodes
  real most_azimuths;  // at most this many azimuth nodes on an arc, a range of azimuths with a smooth integrand
  real is_coarse;      // 1 if the slope belongs to the coarser rule, else 0
  real order;          // the first azimuthal order k that the invocation computes (physics/README.md, section 12)
};

struct ShapeNode {
  real m;              // sqrt(2) sigma
  real q_minus_1;      // q - 1, stored because a float q does not resolve it near 1; unused by the Gaussian
  real two_q_minus_3;  // 2q - 3, stored because a float q does not resolve it near 3/2; smith needs q > 3/2
  real marginal_norm;  // p(0), with the density p of the in-plane slopes
  real scale;          // the slope t is mapped to X with t = scale sinh(X)
  real cut;            // facets with a larger slope are left out
  real table_scale;    // the variable of the masking table is v = 1 + tau / table_scale, where tau is a slope
  real cusp_digits;    // smith: log10 of the relative error if Lambda's cusp, theta_r = 0, does not split the integral
};

struct IndexNode {
  real n2m1_re;       // Re(N^2 - 1)
  real n2m1_im;       // Im(N^2 - 1)
  real pole_re;       // pole of R_p as a function of cos(beta), -1 / sqrt(N^2 + 1)
  real pole_im;
  real branch_re;     // complex cos(beta) at which w = sqrt(N^2 - sin^2(beta)) is 0: i sqrt(N^2 - 1), with re, im >= 0
  real branch_im;
  real critical_cos;  // cos(beta) at which total reflection begins, sqrt(1 - Re N^2), if k is 0 or small; else 0
  real curve_start;   // position of the table of reflectances among the rule nodes, divided by DOLP_CURVE_ALIGNMENT
  real curve_cells;   // number of cells of the table of reflectances, negative if they are measured; 0 without a table
};

#define DOLP_AZIMUTH_NUMBERS 10  // how many members an AzimuthNode has
#define DOLP_MOMENTS_NUMBERS 13  // how many members a MomentsNode has

// Integrals over the azimuths from 0 to pi for the facets of slope t, without the weight P(t) t dt of this slope. The
// integrands of the azimuthal order k have the factor cos(2 k phi).
struct AzimuthNode {
  real r_i;
  real r_q;
  real albedo;
  real deficit;
  real behind;  // MomentsNode::behind
  real direct_i;
  real direct_q;
  real r_u;       // U of azimuthal order k > 0, with the factor sin(2 k phi); 0 for order 0
  real direct_u;
  real evaluations;
};

// Moments (physics/README.md, section 3) by the finer of two rules, and differences between the two rules.
struct MomentsNode {
  real r_i;
  real r_q;
  real albedo;
  real deficit;
  real behind;               // slope_sums() subtracts it to get `deficit`, which loses digits. So error bounds need it
  real many;                 // part of r_i from grooves with more bounces than DOLP_MOST_BOUNCES
  real direct_i;             // direct emission
  real direct_q;
  real reflected_difference; // larger of the differences in r_i and in r_q between the two rules
  real albedo_difference;
  real deficit_difference;
  real direct_difference;    // larger of the differences in direct_i and in direct_q between the two rules
  real evaluations;
};
