// Number of nodes for a piece of the slope axis or an arc of the azimuth: a policy, independent of the sums.
//
// A Gauss rule of n nodes on [0, 1] is wrong by e^(-2 n mu) where the integrand's next singularity y0 lies on the
// ellipse with the interval's ends as foci and cosh(mu) = |y0| + |y0 - 1| (Trefethen 2013, chapter 19): a decimal digit
// costs ln(10) / (2 mu) nodes. Where the singularities of the azimuth lie is known exactly; RuleNode scales the law
// with fitted numbers (host/compute/plan/rule.hpp). The less a piece carries, the fewer digits it needs.

CONST real kHalfLn10 = real(1.15129254649702284);
CONST real kLn10 = real(2.30258509299404568402);
CONST real kInverseLn10 = real(0.43429448190325182765);
CONST real kWideResolution = real(0.1);   // of a root beside an arc, from which on it is a singularity like others
CONST real kSharpResolution = real(1e-6);
CONST real kMoreDigits = real(0.3);  // of the slope axis, for each digit beyond
CONST real kPlainDigits = real(7.0);
CONST real kLeastWeight = real(1e-20);  // so that at 90 degrees all slopes weigh the same

// acosh(1 + gap), without cancellation.
real acosh_above_1(real gap) { return log1p_real(gap + sqrt(gap) * sqrt(gap + real(2.0))); }

// |y| + |y - 1| - 1 for y = a + i b, without cancellation: how far y is from [0, 1].
real gap_beside_unit(real a, real b) {
  real to_0 = sqrt(a * a + b * b);
  real to_1 = sqrt((a - real(1.0)) * (a - real(1.0)) + b * b);
  real off_axis = b * b / max(to_0 + abs(a), real(1e-30)) + b * b / max(to_1 + abs(a - real(1.0)), real(1e-30));
  return off_axis + real(2.0) * (max(a - real(1.0), real(0.0)) + max(-a, real(0.0)));
}

// A singularity of the integrand, in the upper half plane of its variable.
struct Singularity {
  real re;
  real im;
};

// acos(u).
real arc_cosine(real u) {
  real angle = real(2.0) * atan_unit(sqrt((real(1.0) - abs(u)) / (real(1.0) + abs(u))));
  return u < real(0.0) ? kPi - angle : angle;
}

// arccos(a + i b), from the distances of cos(phi) to +-1 (Hull, Fairgrieve and Tang 1997).
Singularity singularity_at(real a, real b) {
  real to_minus_1 = sqrt((a + real(1.0)) * (a + real(1.0)) + b * b);
  real to_1 = sqrt((a - real(1.0)) * (a - real(1.0)) + b * b);
  real gap = gap_beside_unit(real(0.5) * (a + real(1.0)), real(0.5) * b);
  return Singularity(arc_cosine(clamp(real(0.5) * (to_minus_1 - to_1), real(-1.0), real(1.0))), acosh_above_1(gap));
}

real nodes_per_digit(real mu) { return kHalfLn10 / max(mu, real(1e-3)); }

int order_between(real nodes, int limit) { return int(clamp(floor(nodes + real(0.5)), real(1.0), real(limit))); }

// The coarser rule of a pair, whose distance from the finer one bounds the error. Below three nodes two rules may agree
// by chance more often than not: there it is the finer one.
int coarse_order(int order) {
  int fewer = (8 * order + 5) / 10;
  return (fewer < 3) ? order + 1 : fewer;
}

// ---- Slope axis ----------------------------------------------------------------------------------------------------

// Contribution of facets of slope t to the albedo, c + s t without masking. The cavities let through no more than 2 c.
real weight_of_slope(ThetaNode theta, real t) {
  real bare = theta.c + theta.s * t;
  return kMasking == DOLP_MASKING_V_CAVITY ? min(bare, max(real(2.0) * theta.c, kLeastWeight)) : bare;
}

// The same of all facets: those up to slope t1 send every ray up, those between t1 and t2 about half of them.
real weight_of_shape(ThetaNode theta, ShapeNode shape) {
  real t1 = theta.c / (real(1.0) + theta.s);
  real t2 = (real(1.0) + theta.s) / max(theta.c, real(1e-15));
  real typical = real(0.6) * shape.m;
  real exponent = slope_tail_exponent(shape, t1);
  real beyond = exp_real(-exponent);
  real below = -expm1_real(-exponent);
  return max(below * weight_of_slope(theta, min(typical, t1)) +
                 real(0.5) * (beyond - slope_tail(shape, t2)) * weight_of_slope(theta, clamp(typical, t1, t2)),
             kLeastWeight);
}

// Digits required of a part that carries a share of the albedo: fewer by the logarithm of the share.
real digits_of_share(RuleNode rule, real share) {
  return max(rule.digits + kInverseLn10 * log_unit(min(share, real(1.0))), real(0.0));
}

// The same of the slopes in [a, b].
real digits_of_piece(RuleNode rule, ThetaNode theta, ShapeNode shape, real a, real b, real mass) {
  real typical = weight_of_slope(theta, clamp(shape.m, a, b));
  return digits_of_share(rule, mass * typical / weight_of_shape(theta, shape));
}

// The same of the azimuths at slope t, one of `order` slopes of a piece, that represents `mass` of the facets: fewer
// than those of the piece where it carries less than its part. `all` is weight_of_shape.
real digits_of_slope(RuleNode rule, ThetaNode theta, real all, real digits, int order, real t, real mass) {
  return min(digits_of_share(rule, real(order) * mass * weight_of_slope(theta, t) / all), digits);
}

// Nodes for each digit on a piece, from a singularity at X = re + i im. A root at an end makes the abscissa the root of
// the distance from it.
real piece_cost(Piece piece, real re, real im) {
  real2 z = real2((re - piece.start) / piece.extent, im / piece.extent);
  real from_root = piece.root_at_b ? real(1.0) - z.x : z.x;
  if (piece.root_at_a) from_root = z.x < real(0.5) ? z.x : from_root;  // the nearer one
  real2 y = (piece.root_at_a || piece.root_at_b) ? sqrt_upper(from_root, z.y) : z;
  return nodes_per_digit(acosh_above_1(gap_beside_unit(y.x, y.y)));
}

// An essential singularity exp(-1/x^2) at an end costs a rule nodes in proportion to the square of the digits that it
// is felt at.
real essential_nodes(ShapeNode shape, real digits) {
  real wanted = max(digits - kInverseLn10 / (shape.m * shape.m), real(0.0));
  return real(0.25) * wanted * wanted;
}

// acosh(y) for y >= 1, 0 below: the real part of asinh(i y), whose imaginary part is pi/2 then.
real real_part_of_asinh(real y) { return acosh_above_1(max(y - real(1.0), real(0.0))); }

// The same from one of Fresnel's coefficients in the plane of incidence, cos(beta) = re + i im: at t = (cos(beta) - c)
// / s, as long as that is small.
real fresnel_piece_cost(ThetaNode theta, ShapeNode shape, Piece piece, real re, real im) {
  real unit = max(theta.s, real(1e-6)) * shape.scale;
  real x = (re - theta.c) / unit;
  real bent = asinh_real(abs(x));
  return piece_cost(piece, x < real(0.0) ? -bent : bent, im / (unit * max(abs(x), real(1.0))));
}

// The same from Fresnel's branch point cos(beta) = b on a line where arcs end: the horizon, sec(alpha) = 2 b / c, or
// theta_r = theta, sec(alpha) = b / c; `ratio` is the 2 or the 1. Total reflection has breakpoints at these slopes.
real line_piece_cost(ThetaNode theta, ShapeNode shape, IndexNode index, Piece piece, real ratio) {
  real stretch = ratio / max(theta.c, real(1e-12));
  real2 sec = real2(stretch * index.branch_re, stretch * index.branch_im);
  real2 t = sqrt_upper(sec.x * sec.x - sec.y * sec.y - real(1.0), real(2.0) * sec.x * sec.y);
  // Re asinh(z) = Im arccos(i z), Im asinh(z) = Re arccos(i z) - pi/2, for z = (t.x + i t.y) / scale.
  Singularity x = singularity_at(-t.y / shape.scale, t.x / shape.scale);
  return piece_cost(piece, x.im, x.re - real(0.5) * kPi);
}

// Where smith's mean slope is about to diverge, L is about m tan(theta) / (pi (2q - 3)): G falls within the width
// tan(theta) + pi (2q - 3) / m beside theta_r = 0, as from a pole so far beyond the cusp. The pole carries the width's
// share.
real diverging_nodes(ThetaNode theta, ShapeNode shape, Piece piece) {
  real t = theta.s / (real(1.0) + theta.c);
  real cusp = asinh_real(t / shape.scale);
  real width = theta.s / max(theta.c, real(1e-12)) + kPi * shape.two_q_minus_3 / shape.m;
  real beside = real(0.5) * width / sqrt(shape.scale * shape.scale + t * t);
  bool is_below = piece.start + real(0.5) * piece.extent < cusp;
  real cost = piece_cost(piece, is_below ? cusp + beside : cusp - beside, real(0.0));
  return max(piece.digits + kInverseLn10 * log_unit(min(beside / piece.extent, real(1.0))), real(0.0)) * cost;
}

// Singularities of the integrand over the slopes: the cauchy's density at t = i m; the geometry at t = i; those of
// Fresnel's coefficients; and the square roots at the breakpoints beyond the piece's ends that face it. Before a rule
// converges it must resolve how the density falls over the piece, for which it takes nodes in proportion to the
// logarithm; a root and the map that takes it up make the integrand a polynomial of two degrees more.
real slope_nodes(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, bool has_split_line, Piece piece) {
  real cost = piece_cost(piece, real_part_of_asinh(real(1.0) / shape.scale), real(0.5) * kPi);
  if (kDistribution == DOLP_CAUCHY) {
    cost = max(cost, piece_cost(piece, real_part_of_asinh(shape.m / shape.scale), real(0.5) * kPi));
  }
  cost = max(cost, fresnel_piece_cost(theta, shape, piece, index.pole_re, index.pole_im));
  if (index.critical_cos <= real(0.0)) {
    cost = max(cost, fresnel_piece_cost(theta, shape, piece, index.branch_re, index.branch_im));
    cost = max(cost, line_piece_cost(theta, shape, index, piece, real(2.0)));
    if (kMasking == DOLP_MASKING_INTEGRAL) cost = max(cost, line_piece_cost(theta, shape, index, piece, real(1.0)));
  }
  if (piece.root_before < piece.start) cost = max(cost, piece_cost(piece, piece.root_before, real(0.0)));
  if (piece.root_after > piece.start + piece.extent) cost = max(cost, piece_cost(piece, piece.root_after, real(0.0)));
  // The roots of v^2 (3 - 2v) = y meet at v = -1/2 and 3/2.
  if (piece.root_at_a && piece.root_at_b) cost = max(cost, nodes_per_digit(acosh_above_1(real(1.0))));
  real roots = (piece.root_at_a ? real(1.0) : real(0.0)) + (piece.root_at_b ? real(1.0) : real(0.0));
  // The gaussian falls ever faster in X: all of it in the last unit.
  real steepest = (kDistribution == DOLP_GAUSSIAN) ? max(piece.extent, real(1.0)) : real(1.0);
  real resolved = min(piece.fall, piece.digits * kLn10) * steepest;
  // The poles' order, and weaker singularities, come to count with the digits.
  real digits = piece.digits + kMoreDigits * max(piece.digits - kPlainDigits, real(0.0));
  real nodes = rule.t_nodes + roots + rule.t_fall * resolved + (digits + rule.t_digits) * cost;
  // Split at smith's cusp, the gaussian's L has an essential singularity at an end: see line_nodes.
  if (kMasking == DOLP_MASKING_SMITH && kDistribution == DOLP_GAUSSIAN && has_split_line) {
    nodes = max(nodes, rule.t_nodes + essential_nodes(shape, piece.digits));
  }
  if (is_diverging(shape) && has_split_line) {
    nodes = max(nodes, rule.t_nodes + roots + diverging_nodes(theta, shape, piece));
  }
  return max(nodes, real(2.0));
}

// ---- Azimuth -------------------------------------------------------------------------------------------------------

// Nodes for each digit on an arc, from the singularity's place in the abscissa of the arc's rule. Rules that are even
// about the arc's centre converge as one of half the nodes in the square of their abscissa, clusters are in its root.
real arc_cost(Arc arc, Singularity at) {
  if (arc.section == kSectionCircle) return nodes_per_digit(at.im);
  real re = abs(at.re - arc.origin) / arc.span;
  real im = at.im / arc.span;
  re = (at.re - arc.origin) * arc.extent < real(0.0) ? -re : re;  // beyond the arc's beginning
  real2 y = real2(re, im);
  if (arc.section == kSectionHalf) y = real2(re * re - im * im, real(2.0) * re * im);
  if (arc.section == kSectionCluster) y = sqrt_upper(re, im);
  return nodes_per_digit(acosh_above_1(gap_beside_unit(y.x, y.y)));
}

// The singularities of Fresnel's coefficients: R_p's pole, at cos(beta) = -1 / sqrt(N^2 + 1), and the branch point of
// w, at cos^2(beta) = 1 - N^2. Beside a critical line w goes as the abscissa v of the cluster and the pole w = -N^2
// cos(beta) lies at v = -N^2 critical_cos / w of the arc's other end; beyond the line w is imaginary. Those at the
// bounce whose facet is turned by (cos, sin) from the vertical: cos(beta) = c sin + s x cos.
real bounce_cost(ThetaNode theta, IndexNode index, real2 facet, Arc arc) {
  real slant = theta.s * facet.x;
  real size = max(abs(slant), real(1e-15));
  real sign = (slant < real(0.0)) ? real(-1.0) : real(1.0);
  real offset = theta.c * facet.y;
  Singularity pole = singularity_at(sign * (index.pole_re - offset) / size, index.pole_im / size);
  Singularity branch = singularity_at(sign * (index.branch_re - offset) / size, index.branch_im / size);
  return max(arc_cost(arc, pole), arc_cost(arc, branch));
}

real fresnel_cost(RuleNode rule, ThetaNode theta, IndexNode index, real t, Arc arc) {
  if (arc.is_critical) {
    real sec = sqrt(real(1.0) + t * t);
    real2 end = (arc.extent < real(0.0)) ? arc.from : arc.to;
    real cos_beta = (theta.c + theta.s * t * cosine(end)) / sec;
    real w2 = cos_beta * cos_beta - index.critical_cos * index.critical_cos;
    real v = abs(index.n2m1_re + real(1.0)) * index.critical_cos / max(sqrt(abs(w2)), real(1e-15));
    v = min(v, real(1e9));
    return nodes_per_digit(acosh_above_1((w2 > real(0.0)) ? gap_beside_unit(-v, real(0.0)) : gap_beside_unit(real(0.0), v)));
  }
  real r = real(1.0) / sqrt(real(1.0) + t * t);
  real2 turn = real2(t * r, r);
  real cost = bounce_cost(theta, index, turn, arc);
  if (kIsMultiple) {
    // All bounces of the rays in the arc's middle.
    real2 step = multiply(turn, turn);
    real2 facet = turn;
    real2 middle = arc.from + arc.to;
    real x = (middle.x * middle.x - middle.y * middle.y) / (middle.x * middle.x + middle.y * middle.y);
    real least = max(theta.s * x * turn.x - theta.c * turn.y, real(0.0));
    for (int k = 1; k <= int(rule.split_bounces) + 2; ++k) {
      facet = multiply(facet, step);
      if (theta.c * facet.y + theta.s * x * facet.x <= least) break;
      cost = max(cost, bounce_cost(theta, index, facet, arc));
    }
  }
  return cost;
}

// Singularities of the masking of the reflected ray: the in-plane slopes' density at cot(theta_r) = +- i m, and for
// `integral` the pole of kappa at cot(theta_r) = -t.
real masking_cost(ThetaNode theta, ShapeNode shape, real t, Arc arc, int zone) {
  if (kMasking != DOLP_MASKING_SMITH && (kMasking != DOLP_MASKING_INTEGRAL || zone == 0)) return real(0.0);
  real sec2 = real(1.0) + t * t;
  real st = max(theta.s * t, real(1e-15));
  real scale = real(0.5) * sec2 / st;
  real offset = theta.c * scale - theta.c / st;
  // cos(theta_r) = i m / sqrt(1 - m^2)
  real width = real(1.0) - shape.m * shape.m;
  real cos_r = shape.m / sqrt(max(abs(width), real(1e-6)));
  Singularity density = singularity_at(offset + ((width > real(0.0)) ? real(0.0) : cos_r * scale),
                                       (width > real(0.0)) ? cos_r * scale : real(0.0));
  real cost = arc_cost(arc, density);
  if (kMasking == DOLP_MASKING_INTEGRAL) cost = max(cost, arc_cost(arc, singularity_at(offset - t / sqrt(sec2) * scale, real(0.0))));
  return cost;
}

// Smith's L goes as |theta_r|^(2q - 2) near the facet (tan(theta/2), phi = 0), where theta_r = 0: not smooth unless q
// is an integer, and the less so the smaller q. For the arc from phi = 0, theta_r = 0 lies at cosh(i phi) = 1 + (1 + c)
// (t - tan(theta/2))^2 / (2 s t). The gaussian's L is smooth, but grows beyond bounds toward imaginary theta_r: by the
// digits wanted at 1 / (m sqrt(digits ln 10)).
real cusp_nodes(ThetaNode theta, ShapeNode shape, real t, real digits, Arc arc) {
  if (kMasking != DOLP_MASKING_SMITH || shape.cusp_digits < real(-100.0)) return real(0.0);
  real away = t - theta.s / (real(1.0) + theta.c);
  real beside = real(0.0);
  if (kDistribution == DOLP_GAUSSIAN) {
    real zenith = real(1.0) / (shape.m * sqrt(max(digits, real(1.0)) * kLn10));
    beside = zenith / (real(1.0) + theta.c);  // as a slope
  }
  real rise = (real(1.0) + theta.c) * (away * away + beside * beside) / (real(2.0) * max(theta.s * t, real(1e-30)));
  real wanted = max(digits + shape.cusp_digits, real(0.0));
  return wanted * arc_cost(arc, Singularity(real(0.0), max(acosh_above_1(rise), real(1e-3))));
}

// The arc of a zone without total reflection.
Arc zone_arc(RuleNode rule, ThetaNode theta, ShapeNode shape, bool has_split_line, real t, real digits, real2 from,
             real2 to, int zone) {
  Arc arc = make_arc(from, to);
  if (kMasking == DOLP_MASKING_SMITH && has_split_line) {
    real wanted = max(digits + shape.cusp_digits, real(0.0));
    if (cusp_nodes(theta, shape, t, digits, arc) > rule.cluster_stretch * wanted) return make_root_arc(from, to, false);
  }
  // Where the limit b of `integral` meets pi/2, G goes as the distance to the power 2q - 1.
  bool is_rough_line = kMasking == DOLP_MASKING_INTEGRAL && kDistribution == DOLP_CAUCHY && zone == 2 &&
                       has_split_line && shape.q_minus_1 + real(1.0) < rule.cluster_below_q;
  return is_rough_line ? make_root_arc(from, to, false) : arc;
}

// The arc on one side of the critical line, or the whole zone where the line lies beyond. w^2 = cos^2(beta) -
// critical_cos^2 + i Im N^2 vanishes at or beside its end, as far away as w^2 there is of its range on the arc. Where
// that is far, the arc is like any other; where it is negligible, the root counts as sharp: the change
// by it is of the order of the resolution to the power 3/2.
Arc critical_arc(ThetaNode theta, IndexNode index, real t, real digits, real2 from, real2 to, bool at_end, Arc otherwise) {
  real level = index.critical_cos * index.critical_cos;
  real r2 = real(1.0) / (real(1.0) + t * t);
  real e_root = theta.c + theta.s * t * cosine(at_end ? to : from);
  real e_far = theta.c + theta.s * t * cosine(at_end ? from : to);
  real at_root = r2 * e_root * e_root - level;
  real range = max(abs(r2 * e_far * e_far - level), real(1e-30));
  real resolution = min(sqrt(at_root * at_root + index.n2m1_im * index.n2m1_im) / range, real(1.0));
  if (resolution > kWideResolution) return otherwise;
  Arc arc = make_root_arc(from, to, at_end);
  arc.is_critical = true;
  // Rounding leaves the line itself a little beside its place.
  bool is_felt = resolution > kSharpResolution && digits + real(1.5) * kInverseLn10 * log_unit(resolution) > real(0.0);
  arc.resolution = is_felt ? resolution : real(0.0);
  return arc;
}

// The gaussian's G goes as exp(-1/distance^2) there.
real line_nodes(ShapeNode shape, bool has_split_line, real digits, int zone) {
  bool is_line = kMasking == DOLP_MASKING_INTEGRAL && kDistribution == DOLP_GAUSSIAN && zone == 2 && has_split_line;
  return is_line ? essential_nodes(shape, digits) : real(0.0);
}

// A smoothed square root has singularities at v = asinh(sqrt(+-i)) / a = (0.76 +- 0.57 i) / a in the abscissa of
// place_on_arc; they carry resolution^(3/2) of the whole.
real resolution_nodes(real digits, real resolution) {
  if (resolution <= real(0.0)) return real(0.0);
  real wanted = max(digits + real(1.5) * kInverseLn10 * log_unit(resolution), real(0.0));
  real a = asinh_real(real(1.0) / sqrt(resolution));
  return wanted * nodes_per_digit(acosh_above_1(gap_beside_unit(real(0.76) / a, real(0.57) / a)));
}

// Nodes of an arc. With fewer than two on the whole half circle cos(2 phi) would not average out.
real arc_nodes(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, bool has_split_line, real t, real digits,
               Arc arc, int zone) {
  real map = nodes_per_digit(asinh_real(real(1.0) / max(abs(arc.extent), real(1e-9))));  // dphi = 4 dtau / (1 + tau^2)
  if (arc.section == kSectionHalf) map = real(0.5) * map;
  if (arc.section == kSectionCircle) map = real(0.0);
  real cost = max(max(map, fresnel_cost(rule, theta, index, t, arc)), masking_cost(theta, shape, t, arc, zone));
  // Before a rule converges it must resolve cos(phi) to cos(3 phi), for which it takes nodes in proportion to the arc,
  // and how place_on_arc spreads its nodes, e^(2 a v); a cluster's dphi goes as its abscissa, half a node more.
  real base = rule.phi_nodes * arc.span + (arc.section == kSectionCluster ? real(1.0) : real(0.5));
  if (arc.resolution > real(0.0)) base += real(0.5) * asinh_real(real(1.0) / sqrt(arc.resolution));
  real nodes = base + (digits + rule.phi_digits) * cost;
  nodes = max(nodes, base + cusp_nodes(theta, shape, t, digits, arc));
  nodes = max(nodes, base + resolution_nodes(digits, arc.resolution));
  nodes = max(nodes, base + line_nodes(shape, has_split_line, digits, zone));
  return (arc.section == kSectionCircle) ? max(nodes, real(2.0)) : nodes;
}
