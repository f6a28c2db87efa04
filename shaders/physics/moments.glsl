// The moments of one entry: Gauss rules on the smooth pieces of the slope axis, of orders that follow from the digits
// wanted (orders.glsl).

// A piece [a, b] of the slope axis. X = asinh(t/scale) is linear in y(v), which takes up square-root ends:
// v, v^2 (at a), 1 - (1-v)^2 (at b), v^2 (3 - 2v) (both).
struct Piece {
  real start;   // X at a
  real extent;  // in X
  bool root_at_a;
  bool root_at_b;
  real mass;    // share of the facets
  real digits;  // wanted
  int order;
  real lost;  // digits that the order does not allow
};

Piece make_piece(RuleNode rule, ThetaNode theta, ShapeNode shape, int number) {
  real a = theta.end[number];
  real b = min(theta.end[number + 1], shape.cut);
  Piece piece;
  piece.start = asinh_real(a / shape.scale);
  piece.extent = asinh_real(b / shape.scale) - piece.start;
  real exponent_a = slope_tail_exponent(shape, a);
  piece.mass = -exp_real(-exponent_a) * expm1_real(exponent_a - slope_tail_exponent(shape, b));
  piece.digits = digits_of_piece(rule, theta, shape, a, b, piece.mass);
  piece.root_at_a = mod(theta.kind[number], real(2.0)) > real(0.5);
  piece.root_at_b = b < shape.cut && theta.kind[number + 1] > real(1.5);
  real roots = (piece.root_at_a ? real(1.0) : real(0.0)) + (piece.root_at_b ? real(1.0) : real(0.0));
  real nodes = nodes_t(rule, theta, piece.digits, piece.extent, roots);
  piece.order = order_between(nodes, rule.largest_order);
  real growth = theta.t_growth * rule.t_growth;
  piece.lost = lost_digits(piece.digits, growth, theta.t_growth * rule.t_curvature, nodes, rule.largest_order);
  return piece;
}

// Sums over the slopes of a piece, or of all pieces.
struct SlopeSums {
  FacetSums sum;
  real doubt;             // of the azimuths
  real deficit_doubt;
  FacetSums null_first;   // sums of the slopes' two null rules
  FacetSums null_second;
  real mass;              // the rule's value of Piece::mass
  real deficit_scale;
  real evaluations;
};

// `spent` evaluations have gone into the pieces before.
SlopeSums piece_sums(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, uint table, Piece piece,
                     real spent) {
  SlopeSums sums = SlopeSums(no_facets(), real(0.0), real(0.0), no_facets(), no_facets(), real(0.0), real(0.0), real(0.0));
  int first_node = rule_offset(rule, kSectionGauss, piece.order);
  for (int i = 0; i < piece.order; ++i) {
    real4 node = rule_node(first_node + i);
    real v = node.x;
    real y = v;
    real dy = real(1.0);
    if (piece.root_at_a) {
      y = piece.root_at_b ? v * v * (real(3.0) - real(2.0) * v) : v * v;
      dy = piece.root_at_b ? real(6.0) * v * (real(1.0) - v) : real(2.0) * v;
    } else if (piece.root_at_b) {
      y = v * (real(2.0) - v);
      dy = real(2.0) * (real(1.0) - v);
    }
    real2 hyperbolic = sinh_cosh(piece.start + piece.extent * y);
    real t = shape.scale * hyperbolic.x;
    real du = shape.scale / shape.m * hyperbolic.y * piece.extent * dy;
    real density = real(2.0) * slope_density(shape, t) * du;
    real order_limit = (spent + sums.evaluations < rule.most_evaluations) ? rule.largest_order : real(1.0);
    real mass = kPi * density * node.y;
    real digits = digits_of_slope(rule, theta, shape, piece.digits, piece.order, t, mass);
    AzimuthSums term = azimuth_sums(rule, theta, shape, index, table, t, digits, order_limit);
    sums.sum = add_weighted(sums.sum, term.sum, density * node.y);
    sums.doubt += density * node.y * term.doubt;
    sums.deficit_doubt += density * node.y * term.deficit_doubt;
    sums.null_first = add_weighted(sums.null_first, term.sum, density * node.z);
    sums.null_second = add_weighted(sums.null_second, term.sum, density * node.w);
    sums.mass += mass;
    sums.deficit_scale += density * node.y * term.deficit_scale;
    sums.evaluations += term.evaluations;
  }
  return sums;
}

real null_size(real first, real second) { return sqrt(first * first + second * second); }

// A piece's sums as the moments of an entry, and its doubts. Multiplied by the ratio of its true mass to the rule's: the
// error that the density P alone makes cancels.
MomentsNode piece_moments(Piece piece, SlopeSums sums) {
  real ratio = (sums.mass > real(0.0)) ? piece.mass / sums.mass : real(1.0);
  FacetSums first = sums.null_first;
  FacetSums second = sums.null_second;
  real null_t = max(null_size(first.r_i, second.r_i), null_size(first.r_q, second.r_q));
  MomentsNode node;
  node.r_i = ratio * sums.sum.r_i;
  node.r_q = ratio * sums.sum.r_q;
  node.albedo = ratio * sums.sum.albedo;
  node.deficit = ratio * sums.sum.deficit;
  real digits_t = piece.digits - piece.lost;
  node.doubt = doubt(sums.sum.r_i, null_t, digits_t) + sums.doubt;
  node.deficit_doubt = doubt(sums.deficit_scale, null_size(first.deficit, second.deficit), digits_t) +
                       sums.deficit_doubt;
  node.deficit_scale = ratio * sums.deficit_scale;
  node.evaluations = sums.evaluations;
  return node;
}

MomentsNode add_moments(MomentsNode a, MomentsNode b) {
  return MomentsNode(a.r_i + b.r_i, a.r_q + b.r_q, a.albedo + b.albedo, a.deficit + b.deficit, a.doubt + b.doubt,
                     a.deficit_doubt + b.deficit_doubt, a.deficit_scale + b.deficit_scale,
                     a.evaluations + b.evaluations);
}

MomentsNode moments_entry(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, uint table) {
  real reached = min(theta.end[int(theta.piece_count)], shape.cut);
  real beyond = theta.c * slope_tail(shape, reached);
  MomentsNode total =
      MomentsNode(real(0.0), real(0.0), real(0.0), beyond, real(0.0), real(0.0), beyond, real(0.0));
  for (int number = 0; number < int(theta.piece_count); ++number) {
    if (theta.end[number] < shape.cut) {
      Piece piece = make_piece(rule, theta, shape, number);
      total = add_moments(total, piece_moments(piece, piece_sums(rule, theta, shape, index, table, piece, total.evaluations)));
    }
  }
  return total;
}
