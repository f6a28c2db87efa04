// Computes the moments of a row of entries (row.glsl) on one piece of the slope axis: a Gauss rule over the slopes,
// with a sum over the azimuths at each slope. Two rules compute each moment: one gives the result, and the difference
// between both gives the error bound (host/compute/plan/error_bounds.cpp). coarse_order() chooses the second rule.

CONST real kNearRoot = real(0.2);

Piece make_piece(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Task task) {
  ShapeNode shape = row.shape[0];
  real a = task.start;
  real b = min(task.end, shape.cut);
  real exponent_a = common_exponent(a / shape.m);
  real exponent_b = common_exponent(b / shape.m);
  Piece piece;
  piece.start = asinh_real(a / shape.scale);
  piece.extent = asinh_real(b / shape.scale) - piece.start;
  real largest_mass = real(0.0);
  piece.fall = real(0.0);
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    real factor = exponent_factor(row.shape[g]);
    piece.fall = max(piece.fall, factor * (exponent_b - exponent_a));
    piece.mass[g] = -exp_real(-factor * exponent_a) * expm1_real(factor * (exponent_a - exponent_b));
    largest_mass = max(largest_mass, piece.mass[g]);
  }
  piece.digits = digits_of_piece(rule, theta, shape, a, b, largest_mass);
  piece.root_at_a = task.root_at_start;
  bool ends_before_cut = b < shape.cut;
  piece.root_at_b = ends_before_cut && task.root_at_end;
  // A square root in a neighbouring piece counts as a root of this piece if it is nearer than kNearRoot * piece.extent.
  real end = piece.start + piece.extent;
  real before = asinh_real(task.before / shape.scale);
  bool is_near_a = piece.start - before < kNearRoot * piece.extent;
  bool has_near_a = task.root_before_start && is_near_a;
  bool has_far_a = task.root_before_start && !is_near_a;
  piece.root_at_a = piece.root_at_a || has_near_a;
  piece.root_before = choose(has_far_a, before, piece.start);
  real after = asinh_real(task.after / shape.scale);
  bool has_after = task.root_after_end && ends_before_cut;
  bool is_near_b = after - end < kNearRoot * piece.extent;
  bool has_near_b = has_after && is_near_b;
  bool has_far_b = has_after && !is_near_b;
  piece.root_at_b = piece.root_at_b || has_near_b;
  piece.root_after = choose(has_far_b, after, end);
  piece.order = order_between(slope_nodes(rule, theta, shape, index, task.has_split_line, piece), largest_order());
  return piece;
}

real2 position_on_piece(Piece piece, real v) {
  bool has_both = piece.root_at_a && piece.root_at_b;
  real2 both = real2(v * v * (real(3.0) - real(2.0) * v), real(6.0) * v * (real(1.0) - v));
  real2 at_a = real2(v * v, real(2.0) * v);
  real2 at_b = real2(v * (real(2.0) - v), real(2.0) * (real(1.0) - v));
  real2 one_or_none = choose(piece.root_at_a, at_a, choose(piece.root_at_b, at_b, real2(v, real(1.0))));
  return choose(has_both, both, one_or_none);
}

struct PieceSums {
  real4 member[DOLP_WIDTH];
  Columns columns[DOLP_WIDTH];
  real behind[DOLP_WIDTH];  // MomentsNode::behind
  real2 direct[DOLP_WIDTH];
  real evaluations;
};

PieceSums no_slopes() {
  PieceSums sums;
  sums.evaluations = real(0.0);
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    sums.member[g] = real4(real(0.0));
    sums.columns[g] = no_columns();
    sums.behind[g] = real(0.0);
    sums.direct[g] = real2(real(0.0), real(0.0));
  }
  return sums;
}

PieceSums piece_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Task task, Piece piece, MaskingTerms masking_in,
                     bool is_coarse) {
  ShapeNode shape = row.shape[0];
  PieceSums sums = no_slopes();
  SkyPlace sky = sky_place();
  real mass[DOLP_WIDTH];
  for (int g = 0; g < DOLP_WIDTH; ++g) mass[g] = real(0.0);
  int fewer = min(coarse_order(piece.order), largest_order());
  int order = is_coarse ? fewer : piece.order;
  if (task.start >= shape.cut) order = 0;  // slopes above ShapeNode::cut are left out
  real all = weight_of_shape(theta, shape);
  int first_node = rule_offset(kSectionGauss, order);
  for (int i = 0; i < order; ++i) {
    real2 node = rule_node(first_node + i);
    real2 on_piece = position_on_piece(piece, node.x);
    real2 hyperbolic = sinh_cosh(piece.start + piece.extent * on_piece.x);
    real t = shape.scale * hyperbolic.x;
    real u = t / shape.m;
    real du = shape.scale / shape.m * hyperbolic.y * piece.extent * on_piece.y;
    real exponent = common_exponent(u);
    real weight[DOLP_WIDTH];
    real largest_weight = real(0.0);
    for (int g = 0; g < DOLP_WIDTH; ++g) {
      weight[g] = real(2.0) * node.y * slope_density(row.shape[g], u, exponent) * du;
      largest_weight = max(largest_weight, weight[g]);
    }
    Slope slope;
    slope.t = t;
    slope.digits = digits_of_slope(rule, theta, all, piece.digits, order, t, kPi * largest_weight);
    slope.masking_in = masking_in;
    if (kMasking == DOLP_MASKING_INTEGRAL) slope.masking_in = shadows(row, masking_in, theta.c, theta.s, t);
    slope.has_split_line = task.has_split_line;
    slope.most_azimuths = task.most_azimuths;
    slope.is_coarse = is_coarse;
    slope.order = 0;
    slope.sky = sky;
    for (int g = 0; g < DOLP_WIDTH; ++g) {
      slope.weight[g] = weight[g];
      if (kColumns == DOLP_COLUMNS_DIRECT) slope.weight[g] *= smith_g1(masking_in.value[g]);
    }
    AzimuthSums azimuths = slope_sums(rule, theta, row, index, slope, sums.columns);
    for (int g = 0; g < DOLP_WIDTH; ++g) {
      sums.member[g] += weight[g] * azimuths.member[g];
      sums.columns[g] = azimuths.columns[g];
      sums.behind[g] += weight[g] * azimuths.behind;
      if (kHasDirect) sums.direct[g] += weight[g] * smith_g1(masking_in.value[g]) * azimuths.direct[0];
      mass[g] += kPi * weight[g];
    }
    sums.evaluations += azimuths.evaluations;
  }
  // The exact share of facets on the piece, divided by the share that the rule gives, corrects the sums.
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    real ratio = choose(mass[g] > real(0.0), piece.mass[g] / mass[g], real(1.0));
    sums.member[g] *= ratio;
    sums.columns[g] = scaled_columns(sums.columns[g], ratio);
    sums.behind[g] *= ratio;
    sums.direct[g] *= ratio;
  }
  return sums;
}

struct RowMoments {
  MomentsNode member[DOLP_WIDTH];
};

// No piece contains the steepest facets. The light on them adds to the deficit (facet.glsl) of the first piece.
RowMoments piece_moments(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Task task) {
  real cut = row.shape[0].cut;
  Piece piece = make_piece(rule, theta, row, index, task);
  MaskingTerms masking_in = masking_of_direction(row, theta.c, theta.s);
  PieceSums coarse = no_slopes();
  PieceSums fine = no_slopes();
  int passes = min(task.members + 1, 2);  // always 2, but drivers cannot know it and do not unroll the loop
  for (int pass = 0; pass < passes; ++pass) {
    coarse = fine;
    fine = piece_sums(rule, theta, row, index, task, piece, masking_in, pass == 0);
    for (int g = 0; g < DOLP_WIDTH; ++g) store_columns(g, pass == 0, fine.columns[g]);
  }
  real reached = min(task.last, cut);
  RowMoments result;
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    real beyond = choose(task.piece == 0, theta.c * slope_tail(row.shape[g], reached), real(0.0));
    real4 sums = fine.member[g];
    real4 difference = abs(sums - coarse.member[g]);
    real2 direct = fine.direct[g];
    real direct_difference = max(abs(direct.x - coarse.direct[g].x), abs(direct.y - coarse.direct[g].y));
    result.member[g] = MomentsNode(sums.x, sums.y, sums.z, sums.w + beyond, fine.behind[g], real(0.0), direct.x,
                                   direct.y, max(difference.x, difference.y), difference.z, difference.w, direct_difference,
                                   fine.evaluations + coarse.evaluations);
  }
  return result;
}
