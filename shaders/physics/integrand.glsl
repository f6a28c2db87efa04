// The integrand of the moments in slope space, and its integral over the azimuth at one slope (MODEL.md section 3).
//
// A facet has slope t and azimuth phi from the plane of incidence; x = cos(phi), r2 = cos^2(alpha) = 1 / (1 + t^2),
// e = c + s t x. Then
//   rho c = integral P(t) t dt * 2 integral_0^phi_m e G M dphi,     cos(beta) = r e,     cos(theta_r) = 2 r2 e - c,
//   sin^2(beta)             = r2 [(c t x - s)^2 + t^2 (1 - x^2)],
//   sin^2(beta) cos(2 eta)  = r2 [(c t x - s)^2 - t^2 (1 - x^2)],
//   M00 = R_s - D sin^2(beta) / 2,   M01 = D sin^2(beta) cos(2 eta) / 2,   D = (R_s - R_p) / sin^2(beta).

// Sums over facets. deficit is what keeps the beam from being reflected: masked, absorbed, or sent below the horizon.
struct FacetSums {
  real r_i;
  real r_q;
  real albedo;
  real deficit;
};

FacetSums no_facets() { return FacetSums(real(0.0), real(0.0), real(0.0), real(0.0)); }

FacetSums add_weighted(FacetSums sum, FacetSums term, real weight) {
  return FacetSums(sum.r_i + weight * term.r_i, sum.r_q + weight * term.r_q, sum.albedo + weight * term.albedo,
                   sum.deficit + weight * term.deficit);
}

// Sums over the azimuth at one slope.
struct AzimuthSums {
  FacetSums sum;
  real doubt;          // of r_i and r_q, see orders.glsl
  real deficit_doubt;
  real deficit_scale;  // the deficit with the absolute values of its terms
  real evaluations;
};

// A facet's projection e as the part that masking leaves, e G, and the part that it hides, e (1 - G): each is computed
// on its own, because either may be the difference of two nearly equal numbers.
struct Projection {
  real seen;
  real hidden;
};

// Integrand at azimuth (x, sin phi) per unit of azimuth.
FacetSums facet(ThetaNode theta, IndexNode index, real t, real r2, real x, real sin_phi, real e, Projection part) {
  real along = theta.c * t * x - theta.s;
  real across = t * sin_phi;
  Fresnel f = fresnel(index, sqrt(r2) * e);
  real half_split = real(0.5) * f.split_over_sin2 * r2;
  real split = half_split * (along * along + across * across);
  FacetSums sum;
  sum.r_i = part.seen * (f.r_s - split);
  sum.r_q = part.seen * half_split * (along * along - across * across);
  sum.albedo = part.seen;
  sum.deficit = part.hidden + part.seen * (f.absorbed_s + split);
  return sum;
}

// An arc of azimuths phi = centre + psi, psi = 4 atan(extent * abscissa), on which the integrand is smooth. Its extent is
// negative when the centre is its end.
struct Arc {
  real centre_cos;
  real centre_sin;
  real extent;
  real quarter;  // tan of a quarter of its length; not positive for an empty arc
  int section;   // of the rule nodes
  real pole_nodes;  // what the pole of R_p beyond its end asks for
};

// Half-angle form of an azimuth: (cos(phi/2), sin(phi/2)), from 1 + cos(phi) and 1 - cos(phi), clamped to [0, pi].
real2 half_angle(real one_plus_x, real one_minus_x) {
  return real2(sqrt(clamp(real(0.5) * one_plus_x, real(0.0), real(1.0))),
               sqrt(clamp(real(0.5) * one_minus_x, real(0.0), real(1.0))));
}

real cosine(real2 half_phi) { return (half_phi.x - half_phi.y) * (half_phi.x + half_phi.y); }

// The arc between two azimuths given by their half angles; empty when they coincide or are out of order.
Arc make_arc(real2 from, real2 to) {
  real sin_half = to.y * from.x - to.x * from.y;
  real cos_half = to.x * from.x + to.y * from.y;
  bool starts_at_0 = from.y <= real(0.0);
  bool ends_at_pi = to.x <= real(0.0);
  Arc arc;
  arc.quarter = sin_half / (real(1.0) + cos_half);
  arc.centre_cos = from.x * to.x - from.y * to.y;
  arc.centre_sin = from.y * to.x + from.x * to.y;
  arc.extent = arc.quarter / (real(1.0) + sqrt(real(1.0) + arc.quarter * arc.quarter));
  arc.section = kSectionCentre;
  arc.pole_nodes = real(0.0);
  if (starts_at_0 || ends_at_pi) {
    arc.centre_cos = starts_at_0 ? real(1.0) : real(-1.0);
    arc.centre_sin = real(0.0);
    arc.extent = arc.quarter;
    arc.section = kSectionHalf;
  }
  if (starts_at_0 && ends_at_pi) {
    arc.extent = real(1.0);
    arc.section = kSectionCircle;
  }
  return arc;
}

// The arc between two azimuths with a square root, or another singularity, at one of them: at its end, otherwise at its
// beginning.
Arc make_root_arc(real2 from, real2 to, bool at_end) {
  Arc arc = make_arc(from, to);
  real2 root = at_end ? to : from;
  arc.centre_cos = (root.x - root.y) * (root.x + root.y);
  arc.centre_sin = real(2.0) * root.x * root.y;
  arc.extent = at_end ? -arc.quarter : arc.quarter;
  arc.section = kSectionCluster;
  return arc;
}

// The azimuth in [from, to] nearest to `phi`, all as half angles.
real2 clamp_half_angle(real2 phi, real2 from, real2 to) {
  real2 above = (from.x * phi.y - from.y * phi.x > real(0.0)) ? phi : from;
  return (above.x * to.y - above.y * to.x > real(0.0)) ? above : to;
}

// The projection of a facet whose reflected ray leaves at cos_r. `zone` numbers the arcs from phi = 0; `by_slope` is
// what the slope alone decides: the shadow of theta (`integral`, valid in zone 0, where theta_r < theta) or L(theta).
Projection project(ThetaNode theta, ShapeNode shape, uint table, real t, real e, real cos_r, int zone, real by_slope) {
  if (kMasking == DOLP_MASKING_NONE) return Projection(e, real(0.0));
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    real seen = min(e, real(2.0) * min(theta.c, cos_r));
    return Projection(seen, e - seen);
  }
  real sin_r = sqrt((real(1.0) - cos_r) * (real(1.0) + cos_r));
  if (kMasking == DOLP_MASKING_SMITH) {
    real lambdas = by_slope + smith_lambda(shape, table, cos_r, sin_r);
    real g = real(1.0) / (real(1.0) + lambdas);
    return Projection(e * g, e * (lambdas * g));
  }
  real shadow = by_slope;
  if (zone > 0) shadow = shadowed_integral(shape, table, cos_r, sin_r, t);
  return Projection(e * (real(1.0) - shadow), e * shadow);
}

// What the sums over the azimuths of one slope share.
struct Slice {
  real t;
  real digits;      // wanted
  real order_limit; // of its arcs
  real by_slope;    // see project
  real cusp_nodes;  // nodes of a half arc that smith's cusp at theta_r = 0 asks for
};

// An arc from x = cos(phi) = `x_start` to `x_end` comes near the pole of R_p at cos(beta) = -pole_cos: the nearer, the more
// grazing the direction and the better the metal. A Gauss rule on [x_end, x_start] would converge as
// exp(-acosh(1 + gap / half length)) for each node.
real pole_nodes(RuleNode rule, ThetaNode theta, IndexNode index, Slice slice, real x_start, real x_end) {
  real st = max(theta.s * slice.t, real(1e-30));
  real gap = theta.c / st + x_end + index.pole_cos * sqrt(real(1.0) + slice.t * slice.t) / st;
  real relative = clamp(real(2.0) * gap / max(x_start - x_end, real(1e-30)), real(1e-9), real(1e9));
  return slice.digits * rule.phi_pole_growth * kHalfLn10 /
         max(log1p_real(relative + sqrt(relative * (relative + real(2.0)))), real(1e-3));
}

real arc_nodes(RuleNode rule, ThetaNode theta, IndexNode index, Slice slice, Arc arc, int zone) {
  bool is_cluster = arc.section == kSectionCluster;
  real strip = rule.strip[zone] / (is_cluster ? max(theta.phi_narrowing, real(1.0)) : theta.phi_narrowing);
  real length = arc_length(arc.quarter);
  real nodes;
  if (arc.section == kSectionCircle) {
    // The next singularity is the pole of R_p, and without it the line e = 0.
    real sec = sqrt(real(1.0) + slice.t * slice.t);
    real x = (theta.c + rule.circle_pole * index.pole_cos * sec) / max(theta.s * slice.t, real(1e-30));
    x = clamp(x, real(1.0001), real(1e9));  // whose square is no overflow
    real per_digit = rule.phi_circle_growth * kHalfLn10 / asinh_real(sqrt(x * x - real(1.0)));
    // With fewer than two nodes cos(2 phi) would not average out.
    nodes = max(rule.phi_circle_nodes + slice.digits * per_digit, real(2.0));
  } else if (arc.section == kSectionHalf) {
    nodes = rule.phi_half_nodes + half_arc_nodes(rule, slice.digits, strip, length);
  } else {
    real stretch = is_cluster ? rule.phi_cluster_growth : real(1.0);
    real growth = is_cluster ? rule.phi_cluster_digits : rule.phi_growth;
    nodes = rule.phi_centre_nodes +
            slice.digits * growth * nodes_per_digit(real(2.0) * strip / (stretch * length));
  }
  real pole_growth = is_cluster ? rule.cluster_pole_growth : real(1.0);
  if (arc.section != kSectionCircle) nodes = max(nodes, rule.phi_half_nodes + pole_growth * arc.pole_nodes);
  return nodes;
}

AzimuthSums arc_sums(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, uint table, Slice slice, Arc arc,
                     int zone) {
  real t = slice.t;
  real r2 = real(1.0) / (real(1.0) + t * t);
  real nodes = arc_nodes(rule, theta, index, slice, arc, zone);
  real with_cusp = (arc.section == kSectionCluster) ? nodes : max(nodes, rule.phi_half_nodes + slice.cusp_nodes);
  int order = (arc.quarter > real(0.0)) ? order_between(with_cusp, slice.order_limit) : 0;
  real digits = slice.digits;
  if (order > 0 && arc.section != kSectionCluster) {
    digits -= lost_digits(digits, rule.phi_growth, rule.phi_curvature, nodes, slice.order_limit);
  }
  int first_node = rule_offset(rule, arc.section, order);
  FacetSums sum = no_facets();
  FacetSums null = no_facets();
  for (int i = 0; i < order; ++i) {
    real4 node = rule_node(first_node + i);
    real tau = arc.extent * node.x;
    real inverse = real(1.0) / (real(1.0) + tau * tau);
    real cos_half = real(2.0) * inverse - real(1.0);
    real cos_psi = real(2.0) * cos_half * cos_half - real(1.0);
    real sin_psi = real(4.0) * tau * inverse * cos_half;
    real x = arc.centre_cos * cos_psi - arc.centre_sin * sin_psi;
    real sin_phi = arc.centre_sin * cos_psi + arc.centre_cos * sin_psi;
    real e = theta.c + theta.s * t * x;
    real cos_r = clamp(real(2.0) * r2 * e - theta.c, real(0.0), real(1.0));
    Projection part = project(theta, shape, table, t, e, cos_r, zone, slice.by_slope);
    FacetSums term = facet(theta, index, t, r2, x, sin_phi, e, part);
    real measure = real(4.0) * abs(arc.extent) * inverse;
    sum = add_weighted(sum, term, measure * node.y);
    null = add_weighted(null, term, measure * node.z);
  }
  return AzimuthSums(sum, doubt(sum.r_i, max(abs(null.r_i), abs(null.r_q)), digits),
                     doubt(sum.deficit, null.deficit, digits), sum.deficit, real(order));
}

AzimuthSums add_arc(AzimuthSums sums, AzimuthSums arc) {
  return AzimuthSums(add_weighted(sums.sum, arc.sum, real(1.0)), sums.doubt + arc.doubt,
                     sums.deficit_doubt + arc.deficit_doubt, sums.deficit_scale + arc.deficit_scale, sums.evaluations + arc.evaluations);
}

// The azimuths, as half angles, that split [0, pi] into arcs on which the integrand is smooth: three in ascending order
// and the critical one, anywhere among them.
struct SplitLines {
  real2 first;
  real2 second;
  real2 horizon;   // theta_r = 90 degrees: beyond it the reflected ray does not leave
  real2 critical;  // cos(beta) = critical_cos: a square root on either side
};

// cos(phi) = level / (s t), as a half angle.
real2 line_at(real level, real st) { return half_angle((st + level) / st, (st - level) / st); }

SplitLines split_lines(ThetaNode theta, IndexNode index, real t) {
  real c = theta.c;
  real s = theta.s;
  real st = max(s * t, real(1e-30));
  real sec2 = real(1.0) + t * t;
  SplitLines lines;
  lines.horizon = half_angle((t - c / (real(1.0) + s)) * (c * t + real(1.0) + s) / (real(2.0) * st),
                             (real(1.0) + s - c * t) * (t + c / (real(1.0) + s)) / (real(2.0) * st));
  lines.first = lines.horizon;
  lines.second = lines.horizon;
  lines.critical = line_at(index.critical_cos * sqrt(sec2) - c, st);
  real2 same_zenith = line_at(c * t * t, st);  // theta_r = theta
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    // The limit b of eq. (11) reaches pi/2 at theta_r = pi/4 + alpha/2; 1 - sin(alpha) = cos^2(alpha) / (1 + sin(alpha)).
    real sec = sqrt(sec2);
    real cos_limit = sqrt(real(0.5) / (sec * (sec + t)));
    lines.first = same_zenith;
    bool limited = theta.has_line > real(0.5) && cos_limit < c;
    lines.second = limited ? line_at(real(0.5) * (cos_limit + c) * sec2 - c, st) : same_zenith;
  }
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    // G = 1 between 2 cos(alpha) cos(theta) = cos(beta) and the same with theta_r; the two lines meet at t = 1.
    bool open = t < real(1.0);
    lines.first = open ? line_at(c, st) : same_zenith;
    lines.second = open ? line_at(c * (real(3.0) * t * t - real(1.0)) / (real(3.0) - t * t), st) : same_zenith;
  }
  return lines;
}

// Smith's L goes as |theta_r|^(2q - 2) near the facet (tan(theta/2), phi = 0), where theta_r = 0: not smooth unless q is an
// integer, and the less so the smaller q. For the arc from phi = 0, theta_r = 0 lies at
// cosh(i phi) = 1 + (1 + c) (t - tan(theta/2))^2 / (2 s t).
real cusp_nodes(RuleNode rule, ThetaNode theta, ShapeNode shape, real t, real digits, real length) {
  if (kMasking != DOLP_MASKING_SMITH || shape.cusp_digits < real(-100.0)) return real(0.0);
  real away = t - theta.s / (real(1.0) + theta.c);
  real rise = (real(1.0) + theta.c) * away * away / (real(2.0) * max(theta.s * t, real(1e-30)));
  real distance = log1p_real(rise + sqrt(rise * (rise + real(2.0))));
  return half_arc_nodes(rule, max(digits + shape.cusp_digits, real(0.0)), max(distance, real(1e-3)), length);
}

// The arc of a zone without total reflection.
Arc zone_arc(RuleNode rule, ThetaNode theta, ShapeNode shape, Slice slice, real2 from, real2 to, int zone) {
  Arc arc = make_arc(from, to);
  bool has_line = theta.has_line > real(0.5);
  if (kMasking == DOLP_MASKING_SMITH && has_line) {
    real cusp_digits = max(slice.digits + shape.cusp_digits, real(0.0));
    if (slice.cusp_nodes > rule.phi_cluster_growth * cusp_digits) return make_root_arc(from, to, false);
  }
  // Where the limit b of `integral` meets pi/2, G goes as the distance to the power 2q - 1.
  bool is_rough_line = kMasking == DOLP_MASKING_INTEGRAL && kDistribution == DOLP_CAUCHY && zone == 2 && has_line &&
                       shape.q_minus_1 + real(1.0) < rule.cluster_below_q;
  if (is_rough_line) return make_root_arc(from, to, false);
  return arc;
}

// Integral over the azimuths of one zone, split where total reflection begins; its clusters then replace those of
// zone_arc.
AzimuthSums zone_sums(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, uint table, Slice slice,
                      real2 from, real2 to, real2 critical, int zone) {
  if (index.critical_cos <= real(0.0)) {
    Arc arc = zone_arc(rule, theta, shape, slice, from, to, zone);
    arc.pole_nodes = pole_nodes(rule, theta, index, slice, cosine(from), cosine(to));
    return arc_sums(rule, theta, shape, index, table, slice, arc, zone);
  }
  real2 middle = clamp_half_angle(critical, from, to);
  AzimuthSums below = arc_sums(rule, theta, shape, index, table, slice, make_root_arc(from, middle, true), zone);
  return add_arc(below, arc_sums(rule, theta, shape, index, table, slice, make_root_arc(middle, to, false), zone));
}

// Integral over the azimuth from 0 to pi at slope t, the facets below the horizon counted in the deficit.
AzimuthSums azimuth_sums(RuleNode rule, ThetaNode theta, ShapeNode shape, IndexNode index, uint table, real t,
                         real digits, real order_limit) {
  SplitLines lines = split_lines(theta, index, t);
  Slice slice = Slice(t, digits, order_limit, real(0.0), real(0.0));
  if (kMasking == DOLP_MASKING_INTEGRAL) slice.by_slope = shadowed_integral(shape, table, theta.c, theta.s, t);
  if (kMasking == DOLP_MASKING_SMITH) {
    slice.by_slope = smith_lambda(shape, table, theta.c, theta.s);
    slice.cusp_nodes = cusp_nodes(rule, theta, shape, t, digits, arc_length(lines.horizon.y / (real(1.0) + lines.horizon.x)));
  }
  real2 forward = real2(real(1.0), real(0.0));
  AzimuthSums sums =
      zone_sums(rule, theta, shape, index, table, slice, forward, lines.first, lines.critical, 0);
  if (kMasking == DOLP_MASKING_INTEGRAL || kMasking == DOLP_MASKING_V_CAVITY) {
    for (int zone = 1; zone < 3; ++zone) {
      real2 from = (zone == 1) ? lines.first : lines.second;
      real2 to = (zone == 1) ? lines.second : lines.horizon;
      sums = add_arc(sums, zone_sums(rule, theta, shape, index, table, slice, from, to, lines.critical, zone));
    }
  }
  real below = theta.c * real(4.0) * atan_unit(lines.horizon.x / (real(1.0) + lines.horizon.y));
  real behind = real(2.0) * theta.s * t * lines.horizon.x * lines.horizon.y;
  sums.sum.deficit += below - behind;
  sums.deficit_scale += below + behind;
  return sums;
}
