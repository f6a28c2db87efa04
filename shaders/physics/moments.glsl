// The moments of one entry: Gauss rules on the smooth pieces of the slope axis, twice, with fewer nodes the second time.

// Nodes for a piece that starts at slope a: the fewer, the smaller the share of the moments beyond a.
int piece_order(ThetaNode theta, ShapeNode shape, real a) {
  real lever = theta.s * max(a - shape.m, real(0.0)) / (theta.c + theta.s * shape.m);
  real log_share = min(log1p_real(lever) - slope_tail_exponent(shape, a), real(0.0));
  real order = theta.order_t + theta.order_per_e * log_share;
  return int(clamp(order, real(3.0), real(DOLP_MAX_ORDER)));
}

// The piece [a, b] with `order_t` slopes and `order_phi` azimuths an arc. X = asinh(t/scale) is linear in y(v), which
// takes up square-root ends: v, v^2 (at a), 1 - (1-v)^2 (at b), v^2 (3 - 2v) (both).
FacetSums piece_sums(ThetaNode theta, ShapeNode shape, IndexNode index, uint table, real a, real b, bool root_at_a,
                     bool root_at_b, int order_t, int order_phi) {
  real x_a = asinh_real(a / shape.scale);
  real length = asinh_real(b / shape.scale) - x_a;
  FacetSums sum = no_facets();
  for (int i = 0; i < order_t; ++i) {
    real2 node = rule_node(gauss_offset(order_t) + i);
    real v = node.x;
    real y = v;
    real dy = real(1.0);
    if (root_at_a) {
      y = root_at_b ? v * v * (real(3.0) - real(2.0) * v) : v * v;
      dy = root_at_b ? real(6.0) * v * (real(1.0) - v) : real(2.0) * v;
    } else if (root_at_b) {
      y = v * (real(2.0) - v);
      dy = real(2.0) * (real(1.0) - v);
    }
    real2 hyperbolic = sinh_cosh(x_a + length * y);
    real t = shape.scale * hyperbolic.x;
    real du = shape.scale / shape.m * hyperbolic.y * length * dy * node.y;
    FacetSums term = azimuth_sums(theta, shape, index, table, t, order_phi);
    sum = add_weighted(sum, term, real(2.0) * slope_density(shape, t) * du);
  }
  return sum;
}

MomentsNode moments_entry(ThetaNode theta, ShapeNode shape, IndexNode index, uint table) {
  FacetSums total = no_facets();
  FacetSums difference = no_facets();
  real reached = real(0.0);
  for (int piece = 0; piece < int(theta.piece_count); ++piece) {
    real a = theta.end[piece];
    real b = min(theta.end[piece + 1], shape.cut);
    if (b > a) {
      bool root_at_a = mod(theta.kind[piece], real(2.0)) > real(0.5);
      bool root_at_b = b < shape.cut && theta.kind[piece + 1] > real(1.5);
      int order_t = piece_order(theta, shape, a);
      int order_phi = int(theta.order_phi);
      FacetSums fine =
          piece_sums(theta, shape, index, table, a, b, root_at_a, root_at_b, order_t, order_phi);
      FacetSums coarse = piece_sums(theta, shape, index, table, a, b, root_at_a, root_at_b,
                                    coarse_order_t(order_t), coarse_order_phi(order_phi));
      total = add_weighted(total, fine, real(1.0));
      difference.r_i += abs(fine.r_i - coarse.r_i);
      difference.r_q += abs(fine.r_q - coarse.r_q);
      difference.albedo += abs(fine.albedo - coarse.albedo);
      difference.deficit += abs(fine.deficit - coarse.deficit);
      difference.evaluations += coarse.evaluations;
      reached = b;
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
