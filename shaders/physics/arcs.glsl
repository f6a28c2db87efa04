// Splits the azimuths [0, pi] at one slope into arcs on which the integrand is smooth. An azimuth phi is stored as its
// half angle (cos(phi/2), sin(phi/2)): this pair is accurate near 0 and pi, and needs no arc cosine.

real2 half_angle(real one_plus_x, real one_minus_x) {
  return real2(sqrt(clamp(real(0.5) * one_plus_x, real(0.0), real(1.0))),
               sqrt(clamp(real(0.5) * one_minus_x, real(0.0), real(1.0))));
}

real cosine(real2 half_phi) { return (half_phi.x - half_phi.y) * (half_phi.x + half_phi.y); }

real arc_tangent(real y) {
  bool is_small = y <= real(1.0);
  real angle = atan_unit(choose(is_small, y, real(1.0) / y));
  return choose(is_small, angle, real(0.5) * kPi - angle);
}

real phase(real2 half_phi) { return real(4.0) * arc_tangent(half_phi.y / (real(1.0) + half_phi.x)); }  // phi in radians

bool is_before(real2 from, real2 to) { return to.y * from.x > to.x * from.y; }

real2 clamp_half_angle(real2 phi, real2 from, real2 to) {
  real2 above = is_before(from, phi) ? phi : from;
  return is_before(above, to) ? above : to;
}

// An arc of azimuths with a smooth integrand. A rule node lies at phi = centre + 4 atan(extent * abscissa). The centre
// is the middle or an end of the arc. `extent` is negative if the integrand has a square root at the end of the arc.
struct Arc {
  real2 from;
  real2 to;
  real centre_cos;
  real centre_sin;
  real extent;
  real quarter;     // tan of a quarter of the arc's length
  real origin;      // phi of the centre if the centre is an end of the arc; else phi of the beginning of the arc
  real span;        // length in phi
  int section;      // section of the rule nodes, kSection*
  bool is_critical; // true if total reflection begins at or near the centre
  real resolution;  // share of the arc on which absorption smooths a square root, see critical_arc(); 0 without a root
};

Arc make_arc(real2 from, real2 to) {
  real sin_half = to.y * from.x - to.x * from.y;
  real cos_half = to.x * from.x + to.y * from.y;
  bool starts_at_0 = from.y <= real(0.0);
  bool ends_at_pi = to.x <= real(0.0);
  Arc arc;
  arc.from = from;
  arc.to = to;
  arc.quarter = sin_half / (real(1.0) + cos_half);
  arc.centre_cos = from.x * to.x - from.y * to.y;
  arc.centre_sin = from.y * to.x + from.x * to.y;
  arc.extent = arc.quarter / (real(1.0) + sqrt(real(1.0) + arc.quarter * arc.quarter));
  arc.is_critical = false;
  arc.resolution = real(0.0);
  arc.span = real(4.0) * arc_tangent(arc.quarter);
  // The integrand is symmetric about 0 and pi. So an arc that begins at 0 or ends at pi uses half of a symmetric rule.
  bool is_half = starts_at_0 || ends_at_pi;
  bool is_circle = starts_at_0 && ends_at_pi;
  arc.origin = choose(is_half, choose(starts_at_0, real(0.0), kPi), phase(from));
  arc.centre_cos = choose(is_half, choose(starts_at_0, real(1.0), real(-1.0)), arc.centre_cos);
  arc.centre_sin = choose(is_half, real(0.0), arc.centre_sin);
  arc.extent = choose(is_circle, real(1.0), choose(is_half, arc.quarter, arc.extent));
  arc.section = is_half ? kSectionHalf : kSectionCentre;
  arc.section = is_circle ? kSectionCircle : arc.section;
  return arc;
}

// If `has_root`, clusters nodes where the integrand is singular: at the end of the arc if `at_end`, else at the start.
Arc with_root(Arc arc, bool at_end, bool has_root) {
  real2 root = choose(at_end, arc.to, arc.from);
  arc.centre_cos = choose(has_root, cosine(root), arc.centre_cos);
  arc.centre_sin = choose(has_root, real(2.0) * root.x * root.y, arc.centre_sin);
  arc.origin = choose(has_root, phase(root), arc.origin);
  arc.extent = choose(has_root, choose(at_end, -arc.quarter, arc.quarter), arc.extent);
  arc.section = has_root ? kSectionCluster : arc.section;
  return arc;
}

// A node of an arc's rule: cos(phi), sin(phi), and the weight, which includes dphi.
struct Azimuth {
  real x;
  real sin_phi;
  real weight;
};

// Moves a node of the rule if absorption smooths the square root at the centre of the arc (Arc::resolution > 0). The
// moved nodes resolve the smooth part. Farther out, their distances from the centre grow geometrically.
real2 place_on_arc(Arc arc, real2 node) {
  if (!kTotalReflection) return node;
  real scale = real(1.0) / sqrt(arc.resolution);  // sinh(a)
  real a = asinh_real(scale);
  real v = sqrt(node.x);
  real2 hyperbolic = sinh_cosh(a * v);
  real y = hyperbolic.x / scale;
  return choose(arc.resolution > real(0.0), real2(y * y, node.y * a * y * hyperbolic.y / (scale * v)), node);
}

Azimuth azimuth(Arc arc, real2 node) {
  real tau = arc.extent * node.x;
  real inverse = real(1.0) / (real(1.0) + tau * tau);
  real cos_half = real(2.0) * inverse - real(1.0);
  real cos_psi = real(2.0) * cos_half * cos_half - real(1.0);
  real sin_psi = real(4.0) * tau * inverse * cos_half;
  Azimuth at;
  at.x = arc.centre_cos * cos_psi - arc.centre_sin * sin_psi;
  at.sin_phi = arc.centre_sin * cos_psi + arc.centre_cos * sin_psi;
  at.weight = real(4.0) * abs(arc.extent) * inverse * node.y;
  return at;
}

// Half angles that split [0, pi] into arcs, in ascending order. azimuth_sums() splits the arcs also at `critical`.
struct SplitLines {
  real2 end[DOLP_MAX_ARCS];  // end of each arc; the first begins at phi = 0
  int arcs;
  int leaving;     // number of arcs, counted from phi = 0, on which the reflected ray leaves the surface
  real2 horizon;   // theta_r = 90 degrees; beyond it the reflected ray does not leave
  real2 critical;  // here total reflection begins; the integrand has a square root on both sides
};

// Half angle of the azimuth phi with cos(phi) = level / st.
real2 line_at(real level, real st) { return half_angle((st + level) / st, (st - level) / st); }

SplitLines single_lines(ThetaNode theta, real t, bool has_split_line, SplitLines lines) {
  real c = theta.c;
  real st = max(theta.s * t, real(1e-30));
  real sec2 = real(1.0) + t * t;
  real2 same_zenith = line_at(c * t * t, st);  // theta_r = theta
  real2 facing = line_at(-c, st);  // beyond this line facets face away from the viewer
  if (kHasDirect) {
    lines.end[1] = facing;
    lines.arcs = 2;
  }
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    // G1 of `integral` masking is an integral with the upper limit b (README.md beside this file, section 2). On the
    // line b = pi/2, G1 is not smooth. There theta_r = pi/4 + alpha/2, so cos^2(theta_r) = (1 - sin(alpha)) / 2.
    real sec = sqrt(sec2);
    real cos_limit = sqrt(real(0.5) / (sec * (sec + t)));
    bool is_beyond = cos_limit < c;
    bool limited = has_split_line && is_beyond;
    lines.end[0] = same_zenith;
    lines.end[1] = choose(limited, line_at(real(0.5) * (cos_limit + c) * sec2 - c, st), same_zenith);
    lines.end[2] = lines.horizon;
    lines.arcs = 3;
    lines.leaving = 3;
  }
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    // For t < 1, G = 1 between two lines. The first is `shaded`, where 2 cos(alpha) cos(theta) = cos(beta). The second
    // is end[1], where 2 cos(alpha) cos(theta_r) = cos(beta). At `shaded`, G1 of the direct emission has a kink.
    real2 shaded = line_at(c, st);
    real level = c * (real(3.0) * t * t - real(1.0)) / (real(3.0) - t * t);
    lines.end[0] = t < real(1.0) ? shaded : same_zenith;
    lines.end[1] = choose(t < real(1.0), line_at(level, st), same_zenith);
    lines.end[2] = lines.horizon;
    lines.arcs = 3;
    lines.leaving = 3;
    if (kHasDirect) {
      bool is_steep = t >= real(1.0);
      bool is_below_60 = t * t < real(3.0);
      bool shaded_leaves = is_steep && is_below_60;
      lines.end[2] = shaded_leaves ? shaded : lines.horizon;
      lines.end[3] = (shaded_leaves || !is_steep) ? lines.horizon : shaded;
      lines.end[4] = facing;
      lines.arcs = 5;
      lines.leaving = shaded_leaves ? 4 : 3;
    }
  }
  return lines;
}

// A split line of a groove. Project the ray onto the plane perpendicular to the groove: its zenith there is psi, with
// tan(psi) = tan(theta) cos(phi). The line is the azimuth phi that gives this psi. Let gamma = pi/2 - alpha. The number
// of bounces changes at psi = pi/2 - j gamma and at psi = pi - (2j + 1) gamma, with integers j > 0. The formula for the
// width of the beam changes at psi = gamma. At psi = -gamma facets turn away from the ray.
real2 groove_line(ThetaNode theta, real cos_psi, real sin_psi) {
  return line_at(theta.c * sin_psi / max(cos_psi, real(1e-30)), max(theta.s, real(1e-30)));
}

// If a slope needs no more digits than this, its azimuths are split only where facets turn away from the ray.
CONST real kDigitsOfLines = real(3.0);

SplitLines groove_lines(RuleNode rule, ThetaNode theta, real t, real digits, SplitLines lines) {
  real2 turn = facet_turn(t);    // e^(i gamma)
  real2 at = turn;               // e^(i j gamma)
  real2 next = multiply(at, turn);
  lines.arcs = 0;
  bool are_split = digits > kDigitsOfLines;
  int splits = (t < real(DOLP_STEEPEST_SPLIT)) ? int(rule.split_bounces) : 0;
  for (int j = 1; are_split && j <= splits && next.x >= real(0.0); ++j) {
    lines.end[lines.arcs] = groove_line(theta, at.y, at.x);
    ++lines.arcs;
    at = next;
    next = multiply(at, turn);
  }
  if (are_split) {
    lines.end[lines.arcs] = groove_line(theta, turn.x, turn.y);
    ++lines.arcs;
  }
  if (are_split && next.x < real(0.0)) {
    real2 both = multiply(at, next);
    lines.end[lines.arcs] = groove_line(theta, at.y, at.x);
    lines.end[lines.arcs + 1] = groove_line(theta, -both.x, both.y);
    lines.end[lines.arcs + 2] = groove_line(theta, next.y, next.x);
    lines.arcs += 3;
  }
  lines.end[lines.arcs] = groove_line(theta, turn.x, -turn.y);
  ++lines.arcs;
  lines.leaving = lines.arcs;
  return lines;
}

SplitLines split_lines(RuleNode rule, ThetaNode theta, IndexNode index, real t, bool has_split_line, real digits) {
  real c = theta.c;
  real s = theta.s;
  real st = max(s * t, real(1e-30));
  SplitLines lines;
  lines.horizon = half_angle((t - c / (real(1.0) + s)) * (c * t + real(1.0) + s) / (real(2.0) * st),
                             (real(1.0) + s - c * t) * (t + c / (real(1.0) + s)) / (real(2.0) * st));
  for (int i = 0; i < DOLP_MAX_ARCS; ++i) lines.end[i] = lines.horizon;
  lines.arcs = 1;
  lines.leaving = 1;
  lines.critical = line_at(index.critical_cos * sqrt(real(1.0) + t * t) - c, st);
  if (kIsMultiple) {
    lines = groove_lines(rule, theta, t, digits, lines);
  } else {
    lines = single_lines(theta, t, has_split_line, lines);
  }
  return lines;
}
