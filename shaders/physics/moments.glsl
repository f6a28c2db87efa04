// The moments of one entry: Gauss rules on the smooth pieces of the slope axis, twice, the second time with
// three quarters of the nodes (quadrature.glsl).

// How the order of a piece follows its length in X and its weight; found by scanning the domain for entries whose
// estimate misses the tolerance (tests/plan_test.cpp repeats the scan on a sample).
CONST real kOrderPerLength = real(0.08);
CONST real kUsualLength = real(3.5);
CONST real kRootShare = real(0.6);

// ln of the share of the moments that slopes beyond a carry, roughly: the tail, times (c + s a) / (c + s m) for the
// weight P t (c + s t) of the albedo.
real log_share(ThetaNode theta, ShapeNode shape, real a) {
  real lever = theta.s * max(a - shape.m, real(0.0)) / (theta.c + theta.s * shape.m);
  return min(log1p_real(lever) - slope_tail_exponent(shape, a), real(0.0));
}

// A piece [a, b] of the slope axis. X = asinh(t/scale) is linear in y(v), which takes up square-root ends:
// v, v^2 (at a), 1 - (1-v)^2 (at b), v^2 (3 - 2v) (both).
struct Piece {
  real start;   // X at a
  real extent;  // in X
  bool root_at_a;
  bool root_at_b;
  int order;
};

Piece make_piece(ThetaNode theta, ShapeNode shape, int number) {
  real a = theta.end[number];
  real b = min(theta.end[number + 1], shape.cut);
  Piece piece;
  piece.start = asinh_real(a / shape.scale);
  piece.extent = asinh_real(b / shape.scale) - piece.start;
  // The less a piece carries, the fewer nodes it needs; the longer it is in X, the more.
  real order = theta.order_t + theta.order_per_e * log_share(theta, shape, a);
  order *= real(1.0) + kOrderPerLength * max(piece.extent - kUsualLength, real(0.0));
  piece.order = int(clamp(order, real(3.0), theta.order_limit));
  // A square root at b is worth the nodes that it draws away from a only if there is something left at b.
  real order_at_b = theta.order_t + theta.order_per_e * log_share(theta, shape, b);
  piece.root_at_a = mod(theta.kind[number], real(2.0)) > real(0.5);
  piece.root_at_b = b < shape.cut && theta.kind[number + 1] > real(1.5) && order_at_b > kRootShare * theta.order_t;
  return piece;
}

FacetSums piece_sums(ThetaNode theta, ShapeNode shape, IndexNode index, uint table, Piece piece, int order_t,
                     int order_phi) {
  FacetSums sum = no_facets();
  for (int i = 0; i < order_t; ++i) {
    real2 node = rule_node(gauss_offset(order_t) + i);
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
    real du = shape.scale / shape.m * hyperbolic.y * piece.extent * dy * node.y;
    FacetSums term = azimuth_sums(theta, shape, index, table, t, order_phi);
    sum = add_weighted(sum, term, real(2.0) * slope_density(shape, t) * du);
  }
  return sum;
}

MomentsNode moments_entry(ThetaNode theta, ShapeNode shape, IndexNode index, uint table) {
  FacetSums total = no_facets();
  FacetSums difference = no_facets();
  real reached = min(theta.end[int(theta.piece_count)], shape.cut);
  for (int number = 0; number < int(theta.piece_count); ++number) {
    if (theta.end[number] < shape.cut) {
      Piece piece = make_piece(theta, shape, number);
      int order_phi = int(theta.order_phi);
      FacetSums fine = piece_sums(theta, shape, index, table, piece, piece.order, order_phi);
      FacetSums coarse = piece_sums(theta, shape, index, table, piece, coarse_order_t(piece.order),
                                    coarse_order_phi(order_phi));
      total = add_weighted(total, fine, real(1.0));
      difference.r_i += abs(fine.r_i - coarse.r_i);
      difference.r_q += abs(fine.r_q - coarse.r_q);
      difference.albedo += abs(fine.albedo - coarse.albedo);
      difference.deficit += abs(fine.deficit - coarse.deficit);
      difference.evaluations += coarse.evaluations;
    }
  }
  MomentsNode result;
  result.r_i = total.r_i;
  result.r_q = total.r_q;
  result.albedo = total.albedo;
  real beyond = theta.c * slope_tail(shape, reached);
  result.deficit = total.deficit + beyond;
  result.deficit_scale = total.deficit_scale + beyond;
  result.r_i_difference = difference.r_i;
  result.r_q_difference = difference.r_q;
  result.albedo_difference = difference.albedo;
  result.deficit_difference = difference.deficit;
  result.evaluations = total.evaluations + difference.evaluations;
  return result;
}
