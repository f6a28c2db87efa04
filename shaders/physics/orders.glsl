// Chooses the number of nodes of each Gauss rule, over a piece of the slope axis or an arc of azimuths.
// Map the piece or arc to [0, 1], and let y0 be the singularity of the integrand, in the complex plane, that is nearest
// to [0, 1]. A rule of n nodes has an error of about e^(-2 n mu), with cosh(mu) = |y0| + |y0 - 1| (Trefethen 2013,
// chapter 19). So each decimal digit of accuracy costs ln(10) / (2 mu) nodes. Fitted constants: struct RuleNode.

CONST real kHalfLn10 = real(1.15129254649702284);
CONST real kLn10 = real(2.30258509299404568402);
CONST real kInverseLn10 = real(0.43429448190325182765);
// If Arc::resolution is above this, the arc does not cluster its nodes at the azimuth where total reflection begins.
CONST real kWideResolution = real(0.1);
CONST real kSharpResolution = real(1e-6);  // a smaller Arc::resolution counts as 0
CONST real kMoreDigits = real(0.3);  // slope axis: a digit beyond kPlainDigits costs 1 + kMoreDigits times the nodes
CONST real kPlainDigits = real(7.0);
CONST real kLeastWeight = real(1e-20);  // replaces the weights that are 0 at 90 degrees

real acosh_above_1(real gap) { return log1p_real(gap + sqrt(gap) * sqrt(gap + real(2.0))); }

// |y| + |y - 1| - 1 for y = a + i b. It is 0 on [0, 1], and constant on each ellipse with the foci 0 and 1.
real gap_beside_unit(real a, real b) {
  real to_0 = sqrt(a * a + b * b);
  real to_1 = sqrt((a - real(1.0)) * (a - real(1.0)) + b * b);
  real off_axis = b * b / max(to_0 + abs(a), real(1e-30)) + b * b / max(to_1 + abs(a - real(1.0)), real(1e-30));
  return off_axis + real(2.0) * (max(a - real(1.0), real(0.0)) + max(-a, real(0.0)));
}

real arc_cosine(real u) {
  real angle = real(2.0) * atan_unit(sqrt((real(1.0) - abs(u)) / (real(1.0) + abs(u))));
  return choose(u < real(0.0), kPi - angle, angle);
}

// The complex azimuth phi with cos(phi) = a + i b, from the distances of a + i b to 1 and -1 (Hull et al. 1997).
Singularity singularity_at(real a, real b) {
  real to_minus_1 = sqrt((a + real(1.0)) * (a + real(1.0)) + b * b);
  real to_1 = sqrt((a - real(1.0)) * (a - real(1.0)) + b * b);
  real gap = gap_beside_unit(real(0.5) * (a + real(1.0)), real(0.5) * b);
  return Singularity(arc_cosine(clamp(real(0.5) * (to_minus_1 - to_1), real(-1.0), real(1.0))), acosh_above_1(gap), gap);
}

real nodes_per_digit(real mu) { return kHalfLn10 / max(mu, real(1e-3)); }
real nodes_per_digit_at(real gap) { return nodes_per_digit(acosh_above_1(gap)); }

int order_between(real nodes, int limit) { return int(clamp(floor(nodes + real(0.5)), real(1.0), real(limit))); }

// Order of the coarser rule. If it is below 3, a finer rule replaces it: rules with few nodes often agree by chance.
int coarse_order(int order) {
  int fewer = (8 * order + 5) / 10;
  return (fewer < 3) ? order + 1 : fewer;
}

// ---- Slope axis ----------------------------------------------------------------------------------------------------

// Upper bound of the contribution of a facet of slope t to the albedo: c + s t; with v-cavity masking also at most 2 c.
real weight_of_slope(ThetaNode theta, real t) {
  real bare = theta.c + theta.s * t;
  return kMasking == DOLP_MASKING_V_CAVITY ? min(bare, max(real(2.0) * theta.c, kLeastWeight)) : bare;
}

// Estimate of the light that all facets reflect upward: all light up to slope t1, half of it up to t2, none beyond.
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

// Digits required of a part of the integral that contributes `share` of the albedo.
real digits_of_share(RuleNode rule, real share) {
  return max(rule.digits + kInverseLn10 * log_unit(min(share, real(1.0))), real(0.0));
}

real digits_of_piece(RuleNode rule, ThetaNode theta, ShapeNode shape, real a, real b, real mass) {
  real typical = weight_of_slope(theta, clamp(shape.m, a, b));
  return digits_of_share(rule, mass * typical / weight_of_shape(theta, shape));
}

// Digits that the sum over the azimuths at the slope t needs. The slope is one of the `order` nodes of a piece, and has
// the weight `mass`, a share of all facets. The piece needs `digits` digits. `all` is weight_of_shape().
real digits_of_slope(RuleNode rule, ThetaNode theta, real all, real digits, int order, real t, real mass) {
  return min(digits_of_share(rule, real(order) * mass * weight_of_slope(theta, t) / all), digits);
}

// Nodes per digit on a piece because of a singularity at X = re + i im. If the integrand behaves like a square root at
// an end of the piece, the variable of the rule is the square root of the distance from this end.
real piece_cost(Piece piece, real re, real im) {
  real2 z = real2((re - piece.start) / piece.extent, im / piece.extent);
  bool is_nearer_to_a = z.x < real(0.5);
  bool starts_at_a = piece.root_at_a && is_nearer_to_a;
  bool starts_at_b = piece.root_at_b && !starts_at_a;
  bool has_root = piece.root_at_a || piece.root_at_b;
  real2 y = choose(has_root, sqrt_upper(choose(starts_at_b, real(1.0) - z.x, z.x), z.y), z);
  return nodes_per_digit_at(gap_beside_unit(y.x, y.y));
}

// Number of nodes for a term of the integrand like exp(-1/(m x)^2), where x (0 to 1) is the distance from an end of the
// piece or arc. The term is at most about exp(-1/m^2) = 10^-d, with d = kInverseLn10 / m^2. It leaves d digits intact.
real essential_nodes(ShapeNode shape, real digits) {
  real wanted = max(digits - kInverseLn10 / (shape.m * shape.m), real(0.0));
  return real(0.25) * wanted * wanted;
}

// Real part of asinh(i y): acosh(y) for y >= 1, else 0. The imaginary part is pi/2 for y >= 1.
real real_part_of_asinh(real y) { return acosh_above_1(max(y - real(1.0), real(0.0))); }

// Nodes per digit on a piece because Fresnel's coefficients are singular at cos(beta) = re + i im. For small slopes in
// the plane of incidence cos(beta) is about c + s t, so the singularity lies at t = (re + i im - c) / s.
real fresnel_piece_cost(ThetaNode theta, ShapeNode shape, Piece piece, real re, real im) {
  real unit = max(theta.s, real(1e-6)) * shape.scale;
  real x = (re - theta.c) / unit;
  real bent = asinh_real(abs(x));
  return piece_cost(piece, choose(x < real(0.0), -bent, bent), im / (unit * max(abs(x), real(1.0))));
}

// Nodes per digit on a piece because arcs end at a line: the horizon (`ratio` is 2) or theta_r = theta (`ratio` is 1).
// On this line cos(beta) = c sec(alpha) / ratio. At the complex slope with sec(alpha) = ratio * b / c it is equal to b,
// the branch point of Fresnel's coefficients. So the sum over the azimuths is singular at this slope.
real line_piece_cost(ThetaNode theta, ShapeNode shape, IndexNode index, Piece piece, real ratio) {
  real stretch = ratio / max(theta.c, real(1e-12));
  real2 sec = real2(stretch * index.branch_re, stretch * index.branch_im);
  real2 t = sqrt_upper(sec.x * sec.x - sec.y * sec.y - real(1.0), real(2.0) * sec.x * sec.y);
  // The slope z = (t.x + i t.y) / scale lies at X = asinh(z). If cos(x) = i z, then X = x.im + i (x.re - pi/2).
  Singularity x = singularity_at(-t.y / shape.scale, t.x / shape.scale);
  return piece_cost(piece, x.im, x.re - real(0.5) * kPi);
}

// Number of nodes for a piece that ends at the cusp of smith masking, if q is just above 3/2. G falls steeply there, as
// if it had a pole beyond the cusp, at the distance (tan(theta) + pi (2q - 3) / m) / 2 from the cusp on the slope axis.
real diverging_nodes(ThetaNode theta, ShapeNode shape, Piece piece) {
  real t = theta.s / (real(1.0) + theta.c);
  real cusp = asinh_real(t / shape.scale);
  real width = theta.s / max(theta.c, real(1e-12)) + kPi * shape.two_q_minus_3 / shape.m;
  real beside = real(0.5) * width / sqrt(shape.scale * shape.scale + t * t);
  bool is_below = piece.start + real(0.5) * piece.extent < cusp;
  real cost = piece_cost(piece, choose(is_below, cusp + beside, cusp - beside), real(0.0));
  return max(piece.digits + kInverseLn10 * log_unit(min(beside / piece.extent, real(1.0))), real(0.0)) * cost;
}

// The number of nodes of a piece. The nearest singularity of the integrand decides how many nodes a digit costs. The
// density is singular at the slope t = i m, and factors 1 + t^2 are 0 at t = i. Fresnel's coefficients and the far ends
// of neighbouring pieces have singularities, too. A steep density (Piece::fall) and square roots need further nodes.
real slope_nodes(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, bool has_split_line, Piece piece) {
  real cost = piece_cost(piece, real_part_of_asinh(real(1.0) / shape.scale), real(0.5) * kPi);
  if (kDistribution == DOLP_CAUCHY) {
    cost = max(cost, piece_cost(piece, real_part_of_asinh(shape.m / shape.scale), real(0.5) * kPi));
  }
  cost = max(cost, fresnel_piece_cost(theta, shape, piece, index.pole_re, index.pole_im));
  real branch = max(fresnel_piece_cost(theta, shape, piece, index.branch_re, index.branch_im),
                    line_piece_cost(theta, shape, index, piece, real(2.0)));
  if (kMasking == DOLP_MASKING_INTEGRAL) branch = max(branch, line_piece_cost(theta, shape, index, piece, real(1.0)));
  cost = max(cost, choose(index.critical_cos <= real(0.0), branch, real(0.0)));
  real before = piece_cost(piece, piece.root_before, real(0.0));
  cost = max(cost, choose(piece.root_before < piece.start, before, real(0.0)));
  real after = piece_cost(piece, piece.root_after, real(0.0));
  cost = max(cost, choose(piece.root_after > piece.start + piece.extent, after, real(0.0)));
  // The map y = v^2 (3 - 2v) removes the roots at v = 0 and 1. At v = 3/2 (y = 0) and v = -1/2 (y = 1) roots remain.
  bool has_two_roots = piece.root_at_a && piece.root_at_b;
  cost = max(cost, choose(has_two_roots, nodes_per_digit_at(real(1.0)), real(0.0)));
  real roots = (piece.root_at_a ? real(1.0) : real(0.0)) + (piece.root_at_b ? real(1.0) : real(0.0));
  // A Gaussian falls mostly in the last unit of X (struct Piece). On a long piece this is only the share 1 / extent.
  real steepest = (kDistribution == DOLP_GAUSSIAN) ? max(piece.extent, real(1.0)) : real(1.0);
  real resolved = min(piece.fall, piece.digits * kLn10) * steepest;
  // If many digits are required, weaker singularities and poles of higher order cost further nodes.
  real digits = piece.digits + kMoreDigits * max(piece.digits - kPlainDigits, real(0.0));
  real nodes = rule.t_nodes + roots + rule.t_fall * resolved + (digits + rule.t_digits) * cost;
  // If `has_split_line`, pieces end at the cusp of smith masking. For the Gaussian, essential_nodes() treats this cusp.
  if (kMasking == DOLP_MASKING_SMITH && kDistribution == DOLP_GAUSSIAN) {
    nodes = max(nodes, choose(has_split_line, rule.t_nodes + essential_nodes(shape, piece.digits), real(0.0)));
  }
  if (kMasking == DOLP_MASKING_SMITH && kDistribution == DOLP_CAUCHY) {
    bool is_split = is_diverging(shape) && has_split_line;
    nodes = max(nodes, choose(is_split, rule.t_nodes + roots + diverging_nodes(theta, shape, piece), real(0.0)));
  }
  return max(nodes, real(2.0));
}

// ---- Azimuth -------------------------------------------------------------------------------------------------------

// How far the singularity `at` is from an arc, as the gap with cosh(mu) = 1 + gap (head of this file). Let z = (azimuth -
// origin) / span. A rule of section `half` (quadrature.glsl) converges like a Gauss rule in y = z^2, and of section
// `cluster`, in y = sqrt(z).
real arc_gap(Arc arc, Singularity at) {
  real re = abs(at.re - arc.origin) / arc.span;
  real im = at.im / arc.span;
  re = choose((at.re - arc.origin) * arc.extent < real(0.0), -re, re);  // < 0 beyond arc.origin, outside the arc
  real2 y = choose(arc.section == kSectionHalf, real2(re * re - im * im, real(2.0) * re * im), real2(re, im));
  y = choose(arc.section == kSectionCluster, sqrt_upper(re, im), y);
  return choose(arc.section == kSectionCircle, at.gap, gap_beside_unit(y.x, y.y));
}

// A singularity at cos(beta) = re + i im. `facet` is (cos, sin) of the angle between the facet and the vertical, so
// cos(beta) = c facet.y + s cos(phi) facet.x.
Singularity facet_singularity(ThetaNode theta, real re, real im, real2 facet) {
  real slant = theta.s * facet.x;
  real size = max(abs(slant), real(1e-15));
  real sign = choose(slant < real(0.0), real(-1.0), real(1.0));
  return singularity_at(sign * (re - theta.c * facet.y) / size, im / size);
}

Singularity pole_at(ThetaNode theta, IndexNode index, real2 facet) {
  return facet_singularity(theta, index.pole_re, index.pole_im, facet);
}

Singularity branch_at(ThetaNode theta, IndexNode index, real2 facet) {
  return facet_singularity(theta, index.branch_re, index.branch_im, facet);
}

bool has_masking_integrals() { return kMasking == DOLP_MASKING_SMITH || kMasking == DOLP_MASKING_INTEGRAL; }

// Smith masking has a cusp at theta_r = 0, where Lambda behaves like |theta_r|^(2q - 2). Only the facet with t =
// tan(theta/2) and phi = 0 reflects to theta_r = 0. At another slope t the cusp lies at an imaginary azimuth i y, with
// cosh(y) = 1 + `rise`. For the gaussian y is larger: Lambda is negligible for theta_r < `zenith`.
Singularity cusp_at(ThetaNode theta, ShapeNode shape, real t, real digits) {
  real away = t - theta.s / (real(1.0) + theta.c);
  real beside = real(0.0);
  if (kDistribution == DOLP_GAUSSIAN) {
    real zenith = real(1.0) / (shape.m * sqrt(max(digits, real(1.0)) * kLn10));
    beside = zenith / (real(1.0) + theta.c);  // difference in slope that changes theta_r by `zenith`
  }
  real rise = (real(1.0) + theta.c) * (away * away + beside * beside) / (real(2.0) * max(theta.s * t, real(1e-30)));
  return Singularity(real(0.0), max(acosh_above_1(rise), real(1e-3)), rise);
}

Singularities singularities_at(ThetaNode theta, ShapeNode shape, IndexNode index, Slope slope) {
  real t = slope.t;
  real2 facet = facet_turn(t);
  Singularities all;
  all.pole = pole_at(theta, index, facet);
  all.branch = branch_at(theta, index, facet);
  all.density = all.kappa = all.cusp = all.pole;  // replaced if the masking has them
  all.cusp_digits = real(0.0);
  if (has_masking_integrals()) {
    real st = max(theta.s * t, real(1e-15));
    real scale = real(0.5) * (real(1.0) + t * t) / st;
    real offset = theta.c * scale - theta.c / st;
    // At cot(theta_r) = i m, cos(theta_r) = i m / sqrt(1 - m^2).
    real width = real(1.0) - shape.m * shape.m;
    real cos_r = scale * shape.m / sqrt(max(abs(width), real(1e-6)));
    bool is_imaginary = width > real(0.0);
    all.density =
        singularity_at(offset + choose(is_imaginary, real(0.0), cos_r), choose(is_imaginary, cos_r, real(0.0)));
    if (kMasking == DOLP_MASKING_INTEGRAL) all.kappa = singularity_at(offset - facet.x * scale, real(0.0));
  }
  if (kMasking == DOLP_MASKING_SMITH) {
    all.cusp = cusp_at(theta, shape, t, slope.digits);
    all.cusp_digits = max(slope.digits + shape.cusp_digits, real(0.0));
  }
  return all;
}

// The gap of Fresnel's reflectances on an arc with one end at the critical line, where total reflection begins. The arc
// has a Gauss rule in the variable sqrt(tau / T) of quadrature.glsl, which is 0 at this end. R_p has a pole at the
// distance v from 0.
real critical_gap(ThetaNode theta, IndexNode index, real t, Arc arc) {
  real sec = sqrt(real(1.0) + t * t);
  real2 end = choose(arc.extent < real(0.0), arc.from, arc.to);
  real cos_beta = (theta.c + theta.s * t * cosine(end)) / sec;
  real w2 = cos_beta * cos_beta - index.critical_cos * index.critical_cos;
  real v = abs(index.n2m1_re + real(1.0)) * index.critical_cos / max(sqrt(abs(w2)), real(1e-15));
  v = min(v, real(1e9));
  return choose(w2 > real(0.0), gap_beside_unit(-v, real(0.0)), gap_beside_unit(real(0.0), v));
}

// Number of nodes for the cusp of smith masking.
real cusp_nodes(ShapeNode shape, Singularities at, Arc arc) {
  if (kMasking != DOLP_MASKING_SMITH) return real(0.0);
  real nodes = at.cusp_digits * nodes_per_digit_at(arc_gap(arc, at.cusp));
  return choose(shape.cusp_digits < real(-100.0), real(0.0), nodes);
}

CONST real kFarGap = real(1e30);  // gap of a singularity that is too far away to count

// The gap of the singularity of Fresnel's reflectances that is nearest to an arc. With all bounces in a groove, the ray
// at the middle azimuth of the arc stands for all rays of the arc.
real fresnel_gap(RuleNode rule, ThetaNode theta, IndexNode index, Slope slope, Arc arc) {
  if (!kIsMultiple) return min(arc_gap(arc, slope.singular.pole), arc_gap(arc, slope.singular.branch));
  real2 turn = facet_turn(slope.t);
  real2 step = multiply(turn, turn);
  real2 facet = turn;
  real2 middle = arc.from + arc.to;
  real x = (middle.x * middle.x - middle.y * middle.y) / (middle.x * middle.x + middle.y * middle.y);
  real least = max(theta.s * x * turn.x - theta.c * turn.y, real(0.0));
  real gap = kFarGap;
  for (int bounces = int(rule.split_bounces) + 3; bounces > 0; --bounces) {
    gap = min(gap, min(arc_gap(arc, pole_at(theta, index, facet)), arc_gap(arc, branch_at(theta, index, facet))));
    facet = multiply(facet, step);
    if (theta.c * facet.y + theta.s * x * facet.x <= least) break;
  }
  return gap;
}

// The gap of the singularity of the masking toward the reflected ray that is nearest to an arc.
real masking_gap(Singularities at, Arc arc, int zone) {
  real gap = has_masking_integrals() ? arc_gap(arc, at.density) : kFarGap;
  if (kMasking == DOLP_MASKING_INTEGRAL) gap = choose(zone == 0, kFarGap, min(gap, arc_gap(arc, at.kappa)));
  return gap;
}

// The gap of the poles at +- i of dphi/dtau, the derivative of the map in Arc (arcs.glsl): sinh(mu) = 1/extent for a
// rule over tau, and twice this mu for a rule of section `half`.
real map_gap(Arc arc) {
  real sinh2 = real(1.0) / max(arc.extent * arc.extent, real(1e-18));
  real gap = choose(arc.section == kSectionHalf, real(2.0) * sinh2, sinh2 / (real(1.0) + sqrt(real(1.0) + sinh2)));
  return choose(arc.section == kSectionCircle, kFarGap, gap);
}

real nodes_per_digit_on(RuleNode rule, ThetaNode theta, IndexNode index, Slope slope, Arc arc, int zone) {
  real gap = fresnel_gap(rule, theta, index, slope, arc);
  if (kTotalReflection) gap = choose(arc.is_critical, critical_gap(theta, index, slope.t, arc), gap);
  return nodes_per_digit_at(min(min(gap, map_gap(arc)), masking_gap(slope.singular, arc, zone)));
}

// Clusters nodes at the beginning of the arc if it begins at a split line at which the masking is singular.
Arc masked_arc(RuleNode rule, ShapeNode shape, Slope slope, Arc arc, int zone, bool is_first) {
  bool has_root = is_first && slope.has_split_line;
  if (kMasking == DOLP_MASKING_SMITH) {
    bool is_cusp = cusp_nodes(shape, slope.singular, arc) > rule.cluster_stretch * slope.singular.cusp_digits;
    return with_root(arc, false, has_root && is_cusp);
  }
  if (kMasking == DOLP_MASKING_INTEGRAL && kDistribution == DOLP_CAUCHY) {
    // G has a term like x^(2q - 1), where x is the distance from the line b = pi/2 (arcs.glsl).
    bool is_rough = shape.q_minus_1 + real(1.0) < rule.cluster_below_q;
    bool is_line = zone == 2 && is_rough;
    return with_root(arc, false, has_root && is_line);
  }
  return arc;
}

// Clusters nodes at one end of the arc if total reflection begins there. Near this end the integrand contains the root
// w of w^2 = cos^2(beta) - critical_cos^2 + i Im N^2. Arc::resolution tells how much absorption (Im N^2) smooths w:
// it is |w^2| at this end, divided by the range of w^2 on the arc. If the resolution is large, nodes are not clustered.
Arc critical_arc(ThetaNode theta, IndexNode index, Slope slope, Arc arc, bool at_end, bool is_beside) {
  real t = slope.t;
  real level = index.critical_cos * index.critical_cos;
  real r2 = real(1.0) / (real(1.0) + t * t);
  real e_root = theta.c + theta.s * t * cosine(choose(at_end, arc.to, arc.from));
  real e_far = theta.c + theta.s * t * cosine(choose(at_end, arc.from, arc.to));
  real at_root = r2 * e_root * e_root - level;
  real range = max(abs(r2 * e_far * e_far - level), real(1e-30));
  real resolution = min(sqrt(at_root * at_root + index.n2m1_im * index.n2m1_im) / range, real(1.0));
  bool is_narrow = resolution <= kWideResolution;
  arc.is_critical = is_beside && is_narrow;
  arc = with_root(arc, at_end, arc.is_critical);
  // Without absorption, w^2 is 0 at this end. But rounding may change it slightly, so a tiny resolution counts as 0.
  bool is_smoothed = resolution > kSharpResolution;
  bool is_felt = slope.digits + real(1.5) * kInverseLn10 * log_unit(resolution) > real(0.0);
  bool is_resolved = is_smoothed && is_felt;
  is_resolved = is_resolved && arc.is_critical;
  arc.resolution = choose(is_resolved, resolution, real(0.0));
  return arc;
}

// Number of nodes for an arc that begins at the line b = pi/2 of arcs.glsl. There G has the term of essential_nodes().
real line_nodes(ShapeNode shape, Slope slope, int zone) {
  if (kMasking != DOLP_MASKING_INTEGRAL || kDistribution != DOLP_GAUSSIAN) return real(0.0);
  bool is_line = slope.has_split_line && zone == 2;
  return choose(is_line, essential_nodes(shape, slope.digits), real(0.0));
}

// Number of nodes for the root w of critical_arc(), which absorption smooths. With a = asinh(1 / sqrt(resolution)) the
// integrand is singular at v = (0.76 +- 0.57 i) / a (v: place_on_arc()). If ignored: relative error resolution^1.5.
real resolution_nodes(real digits, real resolution) {
  real wanted = max(digits + real(1.5) * kInverseLn10 * log_unit(resolution), real(0.0));
  real a = asinh_real(real(1.0) / sqrt(resolution));
  real nodes = wanted * nodes_per_digit_at(gap_beside_unit(real(0.76) / a, real(0.57) / a));
  return choose(resolution <= real(0.0), real(0.0), nodes);
}

// The number of nodes of an arc. An arc from 0 to pi gets at least two: with one node, cos(2 phi) does not average out.
real arc_nodes(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, Slope slope, Arc arc, int zone) {
  real cost = nodes_per_digit_on(rule, theta, index, slope, arc, zone);
  // The longer an arc, the more nodes resolve cos(phi), cos(2 phi) and cos(3 phi). A rule of the section `cluster`
  // needs half a node more than other rules. If place_on_arc() moves the nodes, the rule needs `spread` nodes more.
  real base = rule.phi_nodes * arc.span + choose(arc.section == kSectionCluster, real(1.0), real(0.5));
  if (kTotalReflection) {
    real spread = real(0.5) * asinh_real(real(1.0) / sqrt(arc.resolution));
    base += choose(arc.resolution > real(0.0), spread, real(0.0));
  }
  real nodes = base + (slope.digits + rule.phi_digits) * cost;
  nodes = max(nodes, base + cusp_nodes(shape, slope.singular, arc));
  if (kTotalReflection) nodes = max(nodes, base + resolution_nodes(slope.digits, arc.resolution));
  nodes = max(nodes, base + line_nodes(shape, slope, zone));
  return choose(arc.section == kSectionCircle, max(nodes, real(2.0)), nodes);
}
