// The moments of a group of entries, piece by piece: Gauss rules on the smooth pieces of the slope axis, of orders that follow from the digits
// wanted (orders.glsl).

// A piece [a, b] of the slope axis. X = asinh(t/scale) is linear in y(v), which takes up square-root ends:
// v, v^2 (at a), 1 - (1-v)^2 (at b), v^2 (3 - 2v) (both).
struct Piece {
  real start;   // X at a
  real extent;  // in X
  bool root_at_a;
  bool root_at_b;
  real mass[DOLP_GROUP];  // share of the facets
  real digits;            // wanted by the member that wants most
  int order;
  real lost;  // digits that the order does not allow
};

Piece make_piece(RuleNode rule, ThetaNode theta, Group group, int number) {
  ShapeNode shape = group.shape[0];
  real a = theta.end[number];
  real b = min(theta.end[number + 1], shape.cut);
  real exponent_a = common_exponent(a / shape.m);
  real exponent_b = common_exponent(b / shape.m);
  Piece piece;
  piece.start = asinh_real(a / shape.scale);
  piece.extent = asinh_real(b / shape.scale) - piece.start;
  real largest_mass = real(0.0);
  for (int g = 0; g < DOLP_GROUP; ++g) {
    real factor = exponent_factor(group.shape[g]);
    piece.mass[g] = -exp_real(-factor * exponent_a) * expm1_real(factor * (exponent_a - exponent_b));
    largest_mass = max(largest_mass, piece.mass[g]);
  }
  piece.digits = digits_of_piece(rule, theta, shape, a, b, largest_mass);
  piece.root_at_a = mod(theta.kind[number], real(2.0)) > real(0.5);
  piece.root_at_b = b < shape.cut && theta.kind[number + 1] > real(1.5);
  real roots = (piece.root_at_a ? real(1.0) : real(0.0)) + (piece.root_at_b ? real(1.0) : real(0.0));
  real nodes = nodes_t(rule, theta, piece.digits, piece.extent, roots);
  piece.order = order_between(nodes, rule.largest_order);
  real growth = theta.t_growth * rule.t_growth;
  piece.lost = lost_digits(piece.digits, growth, theta.t_growth * rule.t_curvature, nodes, rule.largest_order);
  return piece;
}

// Sums over the slopes of a piece, for each member of a group.
struct SlopeSums {
  FacetSums sum[DOLP_GROUP];
  real null_i[DOLP_GROUP];        // sizes of the slopes' null rules' sums
  real null_q[DOLP_GROUP];
  real null_deficit[DOLP_GROUP];
  real doubt[DOLP_GROUP];         // of the azimuths
  real deficit_doubt[DOLP_GROUP];
  real mass[DOLP_GROUP];          // the rule's value of Piece::mass
  real deficit_scale[DOLP_GROUP];
  real evaluations;
};

real null_size(real first, real second) { return sqrt(first * first + second * second); }

SlopeSums piece_sums(RuleNode rule, ThetaNode theta, Group group, IndexNode index, Piece piece) {
  SlopeSums sums;
  real second_i[DOLP_GROUP];
  real second_q[DOLP_GROUP];
  real second_deficit[DOLP_GROUP];
  for (int g = 0; g < DOLP_GROUP; ++g) {
    sums.sum[g] = no_facets();
    sums.null_i[g] = real(0.0);
    sums.null_q[g] = real(0.0);
    sums.null_deficit[g] = real(0.0);
    second_i[g] = real(0.0);
    second_q[g] = real(0.0);
    second_deficit[g] = real(0.0);
    sums.doubt[g] = real(0.0);
    sums.deficit_doubt[g] = real(0.0);
    sums.mass[g] = real(0.0);
    sums.deficit_scale[g] = real(0.0);
  }
  sums.evaluations = real(0.0);
  ShapeNode shape = group.shape[0];
  Masked at_theta = looked_up(group, theta.c, theta.s);
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
    real u = t / shape.m;
    real du = shape.scale / shape.m * hyperbolic.y * piece.extent * dy;
    real exponent = common_exponent(u);
    real density[DOLP_GROUP];
    real largest_density = real(0.0);
    for (int g = 0; g < DOLP_GROUP; ++g) {
      density[g] = real(2.0) * slope_density(group.shape[g], u, exponent) * du;
      largest_density = max(largest_density, density[g]);
    }
    real digits = digits_of_slope(rule, theta, shape, piece.digits, piece.order, t, kPi * largest_density * node.y);
    AzimuthSums term = azimuth_sums(rule, theta, group, index, at_theta, t, digits);
    for (int g = 0; g < DOLP_GROUP; ++g) {
      int member = min(g, masked_members() - 1);
      real weight = density[g] * node.y;
      real first = density[g] * node.z;
      real second = density[g] * node.w;
      FacetSums facets = term.sum[member];
      sums.sum[g] = add_weighted(sums.sum[g], facets, weight);
      sums.null_i[g] += first * facets.r_i;
      sums.null_q[g] += first * facets.r_q;
      sums.null_deficit[g] += first * facets.deficit;
      second_i[g] += second * facets.r_i;
      second_q[g] += second * facets.r_q;
      second_deficit[g] += second * facets.deficit;
      sums.doubt[g] += weight * term.doubt[member];
      sums.deficit_doubt[g] += weight * term.deficit_doubt[member];
      sums.mass[g] += kPi * weight;
      sums.deficit_scale[g] += weight * term.deficit_scale[member];
    }
    sums.evaluations += term.evaluations;
  }
  for (int g = 0; g < DOLP_GROUP; ++g) {
    sums.null_i[g] = null_size(sums.null_i[g], second_i[g]);
    sums.null_q[g] = null_size(sums.null_q[g], second_q[g]);
    sums.null_deficit[g] = null_size(sums.null_deficit[g], second_deficit[g]);
  }
  return sums;
}

// The moments of the members of a group.
struct GroupMoments {
  MomentsNode member[DOLP_GROUP];
};

// Adds a piece's sums, and its doubts, to the moments of a group. Multiplied by the ratio of its true mass to the
// rule's: the error that the density P alone makes cancels.
void add_piece(Piece piece, SlopeSums sums, INOUT(GroupMoments) total) {
  real digits = piece.digits - piece.lost;
  for (int g = 0; g < DOLP_GROUP; ++g) {
    real ratio = (sums.mass[g] > real(0.0)) ? piece.mass[g] / sums.mass[g] : real(1.0);
    FacetSums facets = sums.sum[g];
    total.member[g].r_i += ratio * facets.r_i;
    total.member[g].r_q += ratio * facets.r_q;
    total.member[g].albedo += ratio * facets.albedo;
    total.member[g].deficit += ratio * facets.deficit;
    total.member[g].doubt += doubt(facets.r_i, max(sums.null_i[g], sums.null_q[g]), digits) + sums.doubt[g];
    total.member[g].deficit_doubt +=
        doubt(sums.deficit_scale[g], sums.null_deficit[g], digits) + sums.deficit_doubt[g];
    total.member[g].deficit_scale += ratio * sums.deficit_scale[g];
    total.member[g].evaluations += sums.evaluations;
  }
}

// What one piece adds to the moments of a group; the first also what lies beyond the last.
GroupMoments piece_moments(RuleNode rule, ThetaNode theta, Group group, IndexNode index, int number) {
  real cut = group.shape[0].cut;
  real reached = min(theta.end[int(theta.piece_count)], cut);
  GroupMoments total;
  for (int g = 0; g < DOLP_GROUP; ++g) {
    real beyond = (number == 0) ? theta.c * slope_tail(group.shape[g], reached) : real(0.0);
    total.member[g] = MomentsNode(real(0.0), real(0.0), real(0.0), beyond, real(0.0), real(0.0), beyond, real(0.0));
  }
  if (theta.end[number] < cut) {
    Piece piece = make_piece(rule, theta, group, number);
    add_piece(piece, piece_sums(rule, theta, group, index, piece), total);
  }
  return total;
}
