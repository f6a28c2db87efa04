// The task of an invocation of moments.comp, decoded from the task word of interface.glsl.
struct Task {
  int members;
  int piece;
  bool root_at_start;
  bool root_at_end;
  bool root_before_start;  // the integrand has a square root at the start of the preceding piece
  bool root_after_end;     // the integrand has a square root at the end of the next piece
  bool has_split_line;
  int most_azimuths;
  real before;  // slope at the start of the preceding piece
  real start;
  real end;
  real after;   // slope at the end of the next piece
  real last;    // slope at the end of the last piece
};

bool has_bit(uint word, uint bit) { return ((word >> bit) & 1u) == 1u; }

Task unpack_task(uint word) {
  Task task;
  task.members = int(word & ((1u << DOLP_TASK_MEMBERS_BITS) - 1u));
  task.piece = int((word >> DOLP_TASK_PIECE_SHIFT) & ((1u << DOLP_TASK_PIECE_BITS) - 1u));
  task.root_at_start = has_bit(word, DOLP_TASK_ROOT_AT_START);
  task.root_at_end = has_bit(word, DOLP_TASK_ROOT_AT_END);
  task.root_before_start = has_bit(word, DOLP_TASK_ROOT_BEFORE_START);
  task.root_after_end = has_bit(word, DOLP_TASK_ROOT_AFTER_END);
  task.has_split_line = has_bit(word, DOLP_TASK_SPLIT_LINE);
  task.most_azimuths = int(word >> DOLP_TASK_AZIMUTHS_SHIFT);
  return task;
}

// Only C++ calls this. In moments.comp, a copy of the ThetaNode would take a driver half a second to compile.
Task with_slopes(Task task, ThetaNode theta) {
  task.before = theta.end[max(task.piece - 1, 0)];
  task.start = theta.end[task.piece];
  task.end = theta.end[min(task.piece + 1, DOLP_MAX_PIECES)];
  task.after = theta.end[min(task.piece + 2, DOLP_MAX_PIECES)];
  task.last = theta.end[DOLP_MAX_PIECES];
  return task;
}

// A piece of the slope axis from t = a to t = b. On the piece, X = asinh(t/scale) is a linear function of y in [0, 1].
// A Gauss rule has its nodes in v, and a map y(v) removes square roots of the integrand at the ends: y = v^2 for a root
// at a, y = 1 - (1-v)^2 for a root at b, y = v^2 (3 - 2v) for roots at both, else y = v.
struct Piece {
  real start;   // X at a
  real extent;  // in X
  bool root_at_a;
  bool root_at_b;
  real root_before;       // X at a, or at the start of the preceding piece if a square root lies there, far from a
  real root_after;        // X at b, or at the end of the next piece if a square root lies there, far from b
  real mass[DOLP_WIDTH];  // share of the facets on the piece, for each entry of a row
  real fall;              // ln(share of facets steeper than a / share of facets steeper than b), the largest of a row
  real digits;            // digits that the most demanding entry of a row requires
  int order;
};

// The position of a singularity of the integrand over the azimuths, in the upper half plane of phi.
struct Singularity {
  real re;
  real im;
  real gap;  // cosh(im) - 1
};

// The singularities at one slope. They are the same for all arcs of azimuths (arcs.glsl).
struct Singularities {
  Singularity pole;     // pole of R_p
  Singularity branch;   // zero of w = sqrt(N^2 - sin^2(beta))
  Singularity density;  // the density of in-plane slopes is singular at cot(theta_r) = +- i m
  Singularity kappa;    // `integral`: pole of kappa (masking.glsl), at cot(theta_r) = -t
  Singularity cusp;     // smith: cusp of Lambda, at theta_r = 0
  real cusp_digits;     // digits that the cusp must be accurate to
};

// One slope of the facets, with what the sum over the azimuths needs.
struct Slope {
  real t;
  real digits;        // digits required of the sum over the azimuths
  MaskingTerms masking_in;
  bool has_split_line;
  int most_azimuths;
  bool is_coarse;
  int order;          // first azimuthal order, SlopeNode::order
  SkyPlace sky;
  real weight[DOLP_WIDTH];  // factor of this slope in AzimuthSums::columns, for each entry of the row (row.glsl)
  Singularities singular;
};
