// The integrand of the moments in slope space, and its integral over the azimuth at one slope
// (shaders/physics/README.md, section 3).
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

// Entries that differ in the exponent q alone, in ascending order, with their masking tables: they share nodes, facets
// and reflection. Scale, cut and cusp of their shapes are the same, those that the hardest of them needs.
struct Group {
  ShapeNode shape[DOLP_GROUP];
  uint table[DOLP_GROUP];
};

// Masking without q has one sum over the azimuths for all members of a group.
int masked_members() {
  return (kMasking == DOLP_MASKING_INTEGRAL || kMasking == DOLP_MASKING_SMITH) ? DOLP_GROUP : 1;
}

// Sums over the azimuth at one slope, for each member of a group.
struct AzimuthSums {
  FacetSums sum[DOLP_GROUP];
  real doubt[DOLP_GROUP];          // of r_i and r_q, see orders.glsl
  real deficit_doubt[DOLP_GROUP];
  real deficit_scale[DOLP_GROUP];  // the deficit with the absolute values of its terms
  real evaluations;
};

// A facet's projection e as the part that masking leaves, e G, and the part that it hides, e (1 - G): each is computed
// on its own, because either may be the difference of two nearly equal numbers.
struct Projection {
  real seen;
  real hidden;
};

// What a facet at azimuth (x, sin phi) does with the light that masking leaves it.
struct Reflection {
  real m00;
  real m01;
  real absorbed;  // 1 - m00
};

Reflection reflection(ThetaNode theta, IndexNode index, real t, real r2, real x, real sin_phi, real e) {
  real along = theta.c * t * x - theta.s;
  real across = t * sin_phi;
  Fresnel f = fresnel(index, sqrt(r2) * e);
  real half_split = real(0.5) * f.split_over_sin2 * r2;
  real split = half_split * (along * along + across * across);
  return Reflection(f.r_s - split, half_split * (along * along - across * across), f.absorbed_s + split);
}

// Integrand per unit of azimuth.
FacetSums facet(Reflection reflected, Projection part) {
  return FacetSums(part.seen * reflected.m00, part.seen * reflected.m01, part.seen,
                   part.hidden + part.seen * reflected.absorbed);
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

// What masking says of one direction, for each member: the shadow 1 - G1 of the facets of slope t (`integral`) or Smith's
// L.
struct Masked {
  real value[DOLP_GROUP];
};

Masked unmasked() {
  Masked masked;
  for (int g = 0; g < DOLP_GROUP; ++g) masked.value[g] = real(0.0);
  return masked;
}

// The part that no slope changes: Smith's L, at 90 degrees a number so large that G is 0, and l of `integral`.
Masked looked_up(Group group, real cos_theta, real sin_theta) {
  Masked heights = unmasked();
  if (kMasking == DOLP_MASKING_SMITH) {
    real mu = cos_theta / max(sin_theta, real(1e-30));
    TableCell cell = table_cell(group.shape[0], mu);
    real inverse = real(1.0) / max(mu, real(1e-30));
    for (int g = 0; g < DOLP_GROUP; ++g) heights.value[g] = masking_height(cell, group.table[g]) * inverse;
  }
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    TableCell cell = table_cell(group.shape[0], shadow_cot(cos_theta, sin_theta));
    for (int g = 0; g < DOLP_GROUP; ++g) heights.value[g] = masking_height(cell, group.table[g]);
  }
  return heights;
}

// The shadows of a direction on facets of slope t, from what was looked up for it. Look-ups are done for every invocation:
// those that need none wait for their neighbours anyway.
Masked shadows(Group group, Masked heights, real cos_theta, real sin_theta, real t) {
  ShadowPlace place = shadow_place(group.shape[0], cos_theta, sin_theta, t);
  TableCell cell = table_cell(group.shape[0], place.far);
  LimitTerms terms = limit_terms(group.shape[0], place, cell);
  Masked masked;
  for (int g = 0; g < DOLP_GROUP; ++g) {
    real limited = limited_shadow(group.shape[g], terms, cell, group.table[g]);
    masked.value[g] = place.kappa * heights.value[g] + (place.is_limited ? limited : real(0.0));
  }
  return masked;
}

Masked masked_direction(Group group, real cos_theta, real sin_theta, real t, bool is_needed) {
  Masked masked = unmasked();
  if (kMasking == DOLP_MASKING_SMITH) masked = looked_up(group, cos_theta, sin_theta);
  if (kMasking == DOLP_MASKING_INTEGRAL && is_needed) {
    masked = shadows(group, looked_up(group, cos_theta, sin_theta), cos_theta, sin_theta, t);
  }
  return masked;
}

// The projection of a facet whose reflected ray leaves at cos_r, by what masking says of theta and of that ray. `zone`
// numbers the arcs from phi = 0; in the first, theta_r < theta, so that `integral` asks theta.
Projection project(ThetaNode theta, real e, real cos_r, int zone, real of_theta, real of_ray) {
  if (kMasking == DOLP_MASKING_NONE) return Projection(e, real(0.0));
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    real seen = min(e, real(2.0) * min(theta.c, cos_r));
    return Projection(seen, e - seen);
  }
  if (kMasking == DOLP_MASKING_SMITH) {
    real lambdas = of_theta + of_ray;
    real g = real(1.0) / (real(1.0) + lambdas);
    return Projection(e * g, e * (lambdas * g));
  }
  real shadow = (zone > 0) ? of_ray : of_theta;
  return Projection(e * (real(1.0) - shadow), e * shadow);
}

// What the sums over the azimuths of one slope share.
struct Slice {
  real t;
  real digits;      // wanted
  Masked of_theta;
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
  real own_strip = (zone == 0) ? rule.strip[0] : ((zone == 1) ? rule.strip[1] : rule.strip[2]);
  real strip = own_strip / (is_cluster ? max(theta.phi_narrowing, real(1.0)) : theta.phi_narrowing);
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

// Adds the azimuths of an arc to `sums`.
void add_arc(RuleNode rule, ThetaNode theta, Group group, IndexNode index, Slice slice, Arc arc, int zone,
             INOUT(AzimuthSums) sums) {
  real t = slice.t;
  real r2 = real(1.0) / (real(1.0) + t * t);
  real nodes = arc_nodes(rule, theta, index, slice, arc, zone);
  real with_cusp = (arc.section == kSectionCluster) ? nodes : max(nodes, rule.phi_half_nodes + slice.cusp_nodes);
  int order = (arc.quarter > real(0.0)) ? order_between(with_cusp, theta.phi_order) : 0;
  real digits = slice.digits;
  if (order > 0 && arc.section != kSectionCluster) {
    digits -= lost_digits(digits, rule.phi_growth, rule.phi_curvature, nodes, theta.phi_order);
  }
  int first_node = rule_offset(rule, arc.section, order);
  FacetSums sum[DOLP_GROUP];
  real null_i[DOLP_GROUP];
  real null_q[DOLP_GROUP];
  real null_deficit[DOLP_GROUP];
  for (int g = 0; g < DOLP_GROUP; ++g) {
    sum[g] = no_facets();
    null_i[g] = real(0.0);
    null_q[g] = real(0.0);
    null_deficit[g] = real(0.0);
  }
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
    real measure = real(4.0) * abs(arc.extent) * inverse;
    real weight = measure * node.y;
    real null_weight = measure * node.z;
    Reflection reflected = reflection(theta, index, t, r2, x, sin_phi, e);
    real sin_r = sqrt((real(1.0) - cos_r) * (real(1.0) + cos_r));
    Masked of_ray = masked_direction(group, cos_r, sin_r, t, zone > 0);
    for (int g = 0; g < masked_members(); ++g) {
      FacetSums term = facet(reflected, project(theta, e, cos_r, zone, slice.of_theta.value[g], of_ray.value[g]));
      sum[g] = add_weighted(sum[g], term, weight);
      null_i[g] += null_weight * term.r_i;
      null_q[g] += null_weight * term.r_q;
      null_deficit[g] += null_weight * term.deficit;
    }
  }
  for (int g = 0; g < masked_members(); ++g) {
    sums.sum[g] = add_weighted(sums.sum[g], sum[g], real(1.0));
    sums.doubt[g] += doubt(sum[g].r_i, max(abs(null_i[g]), abs(null_q[g])), digits);
    sums.deficit_doubt[g] += doubt(sum[g].deficit, null_deficit[g], digits);
    sums.deficit_scale[g] += sum[g].deficit;
  }
  sums.evaluations += real(order);
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

// A branch is computed and thrown away by devices that run invocations in lockstep; a loop of one turn at most is skipped
// where none of them needs it, which pays for groups. It counts as an iteration, see host/plan/kernel_data.cpp.
#if DOLP_GROUP > 1
#define DOLP_WHERE(condition) for (bool is_due = (condition); is_due; is_due = false)
#else
#define DOLP_WHERE(condition) if (condition)
#endif

// Integral over the azimuth from 0 to pi at slope t, `at_theta` being looked_up of theta, the facets below the horizon counted in the deficit. Each zone is
// an arc, or two where total reflection begins in between; their clusters then replace those of zone_arc.
AzimuthSums azimuth_sums(RuleNode rule, ThetaNode theta, Group group, IndexNode index, Masked at_theta, real t,
                         real digits) {
  SplitLines lines = split_lines(theta, index, t);
  Slice slice;
  slice.t = t;
  slice.digits = digits;
  slice.of_theta = at_theta;
  if (kMasking == DOLP_MASKING_INTEGRAL) slice.of_theta = shadows(group, at_theta, theta.c, theta.s, t);
  slice.cusp_nodes = real(0.0);
  AzimuthSums sums;
  sums.evaluations = real(0.0);
  for (int g = 0; g < DOLP_GROUP; ++g) {
    sums.sum[g] = no_facets();
    sums.doubt[g] = real(0.0);
    sums.deficit_doubt[g] = real(0.0);
    sums.deficit_scale[g] = real(0.0);
  }
  if (kMasking == DOLP_MASKING_SMITH) {
    real length = arc_length(lines.horizon.y / (real(1.0) + lines.horizon.x));
    slice.cusp_nodes = cusp_nodes(rule, theta, group.shape[0], t, digits, length);
  }
  bool reflects_totally = index.critical_cos > real(0.0);
  int halves = reflects_totally ? 2 : 1;
  int zones = (kMasking == DOLP_MASKING_INTEGRAL || kMasking == DOLP_MASKING_V_CAVITY) ? 3 : 1;
  for (int part = 0; part < zones * halves; ++part) {
    int zone = reflects_totally ? part >> 1 : part;
    bool is_second = reflects_totally && (part & 1) == 1;
    real2 from = (zone == 0) ? real2(real(1.0), real(0.0)) : ((zone == 1) ? lines.first : lines.second);
    real2 to = (zone == 0) ? lines.first : ((zone == 1) ? lines.second : lines.horizon);
    if (reflects_totally) {
      real2 middle = clamp_half_angle(lines.critical, from, to);
      from = is_second ? middle : from;
      to = is_second ? to : middle;
    }
    DOLP_WHERE(to.y * from.x > to.x * from.y) {  // not empty
      Arc arc;
      if (reflects_totally) {
        arc = make_root_arc(from, to, !is_second);
      } else {
        arc = zone_arc(rule, theta, group.shape[0], slice, from, to, zone);
        arc.pole_nodes = pole_nodes(rule, theta, index, slice, cosine(from), cosine(to));
      }
      add_arc(rule, theta, group, index, slice, arc, zone, sums);
    }
  }
  real below = theta.c * real(4.0) * atan_unit(lines.horizon.x / (real(1.0) + lines.horizon.y));
  real behind = real(2.0) * theta.s * t * lines.horizon.x * lines.horizon.y;
  for (int g = 0; g < masked_members(); ++g) {
    sums.sum[g].deficit += below - behind;
    sums.deficit_scale[g] += below + behind;
  }
  return sums;
}
