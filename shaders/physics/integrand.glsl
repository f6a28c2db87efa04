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
  real deficit_scale;  // the same with every term's absolute value
  real evaluations;
};

FacetSums no_facets() { return FacetSums(real(0.0), real(0.0), real(0.0), real(0.0), real(0.0), real(0.0)); }

FacetSums add_weighted(FacetSums sum, FacetSums term, real weight) {
  sum.r_i += weight * term.r_i;
  sum.r_q += weight * term.r_q;
  sum.albedo += weight * term.albedo;
  sum.deficit += weight * term.deficit;
  sum.deficit_scale += weight * term.deficit_scale;
  sum.evaluations += term.evaluations;
  return sum;
}

// Integrand at azimuth (x, sin phi) per unit of azimuth, `shadow` being 1 - G.
FacetSums facet(ThetaNode theta, IndexNode index, real t, real r2, real x, real sin_phi, real e, real shadow) {
  real along = theta.c * t * x - theta.s;
  real across = t * sin_phi;
  Fresnel f = fresnel(index, sqrt(r2) * e);
  real half_split = real(0.5) * f.split_over_sin2 * r2;
  real split = half_split * (along * along + across * across);
  real seen = e * (real(1.0) - shadow);
  FacetSums sum;
  sum.r_i = seen * (f.r_s - split);
  sum.r_q = seen * half_split * (along * along - across * across);
  sum.albedo = seen;
  sum.deficit = e * shadow + seen * (f.absorbed_s + split);
  sum.deficit_scale = sum.deficit;
  sum.evaluations = real(1.0);
  return sum;
}

// An arc of azimuths phi = centre + psi, psi = 4 atan(extent * abscissa), on which the integrand is smooth.
struct Arc {
  real centre_cos;
  real centre_sin;
  real extent;
  int first_node;
  int order;
};

// Half-angle form of an azimuth: (cos(phi/2), sin(phi/2)), from 1 + cos(phi) and 1 - cos(phi), clamped to [0, pi].
real2 half_angle(real one_plus_x, real one_minus_x) {
  return real2(sqrt(clamp(real(0.5) * one_plus_x, real(0.0), real(1.0))),
               sqrt(clamp(real(0.5) * one_minus_x, real(0.0), real(1.0))));
}

// The arc between two azimuths given by their half angles; empty when they coincide or are out of order.
Arc make_arc(real2 from, real2 to, int order) {
  real sin_half = to.y * from.x - to.x * from.y;
  real cos_half = to.x * from.x + to.y * from.y;
  bool starts_at_0 = from.y <= real(0.0);
  bool ends_at_pi = to.x <= real(0.0);
  real quarter = sin_half / (real(1.0) + cos_half);
  Arc arc;
  arc.centre_cos = from.x * to.x - from.y * to.y;
  arc.centre_sin = from.y * to.x + from.x * to.y;
  arc.extent = quarter / (real(1.0) + sqrt(real(1.0) + quarter * quarter));
  arc.first_node = centre_offset(order);
  if (starts_at_0 || ends_at_pi) {
    arc.centre_cos = starts_at_0 ? real(1.0) : real(-1.0);
    arc.centre_sin = real(0.0);
    arc.extent = quarter;
    arc.first_node = half_offset(order);
  }
  if (starts_at_0 && ends_at_pi) {
    arc.extent = real(1.0);
    arc.first_node = circle_offset(order);
  }
  arc.order = (sin_half > real(0.0)) ? order : 0;
  return arc;
}

// Integral over one arc. `beyond` says that theta_r > theta there, where the shadow of `integral` masking is that of
// theta_r and changes along the arc; elsewhere it is `shadow`.
FacetSums arc_sums(ThetaNode theta, ShapeNode shape, IndexNode index, uint table, real t, Arc arc, bool beyond,
                   real shadow) {
  real r2 = real(1.0) / (real(1.0) + t * t);
  FacetSums sum = no_facets();
  for (int i = 0; i < arc.order; ++i) {
    real2 node = rule_node(arc.first_node + i);
    real tau = arc.extent * node.x;
    real inverse = real(1.0) / (real(1.0) + tau * tau);
    real cos_half = real(2.0) * inverse - real(1.0);
    real cos_psi = real(2.0) * cos_half * cos_half - real(1.0);
    real sin_psi = real(4.0) * tau * inverse * cos_half;
    real x = arc.centre_cos * cos_psi - arc.centre_sin * sin_psi;
    real sin_phi = arc.centre_sin * cos_psi + arc.centre_cos * sin_psi;
    real e = theta.c + theta.s * t * x;
    if (beyond) {
      real cos_r = clamp(real(2.0) * r2 * e - theta.c, real(0.0), real(1.0));
      real sin_r = sqrt((real(1.0) - cos_r) * (real(1.0) + cos_r));
      shadow = shadowed_integral(shape, table, cos_r, sin_r, t);
    }
    FacetSums term = facet(theta, index, t, r2, x, sin_phi, e, shadow);
    sum = add_weighted(sum, term, real(4.0) * arc.extent * inverse * node.y);
  }
  return sum;
}

// Azimuths of the lines where the integrand is not smooth, as half angles, in ascending order.
struct SplitLines {
  real2 same_zenith;  // theta_r = theta, where the minimum of `integral` masking switches
  real2 flat_limit;   // the limit b of eq. (11) reaches pi/2 for theta_r
  real2 horizon;      // theta_r = 90 degrees
};

SplitLines split_lines(ThetaNode theta, real t) {
  real c = theta.c;
  real s = theta.s;
  real st = max(s * t, real(1e-30));
  SplitLines lines;
  lines.horizon = half_angle((t - c / (real(1.0) + s)) * (c * t + real(1.0) + s) / (real(2.0) * st),
                             (real(1.0) + s - c * t) * (t + c / (real(1.0) + s)) / (real(2.0) * st));
  lines.same_zenith = real2(real(1.0), real(0.0));
  lines.flat_limit = lines.same_zenith;
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    real tiny_s = max(s, real(1e-30));
    lines.same_zenith = half_angle((s + c * t) / tiny_s, (s - c * t) / tiny_s);
    // theta_r = pi/4 + alpha/2; 1 - sin(alpha) = cos^2(alpha) / (1 + sin(alpha)).
    real sec = sqrt(real(1.0) + t * t);
    real cos_limit = sqrt(real(0.5) / (sec * (sec + t)));
    real level = real(0.5) * (cos_limit + c) * (real(1.0) + t * t) - c;
    lines.flat_limit = (cos_limit < c) ? half_angle((st + level) / st, (st - level) / st) : lines.same_zenith;
  }
  return lines;
}

// Integral over the azimuth from 0 to pi at slope t, the facets below the horizon counted in the deficit.
FacetSums azimuth_sums(ThetaNode theta, ShapeNode shape, IndexNode index, uint table, real t, int order) {
  SplitLines lines = split_lines(theta, t);
  FacetSums sum = no_facets();
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    real shadow = shadowed_integral(shape, table, theta.c, theta.s, t);
    Arc arc = make_arc(real2(real(1.0), real(0.0)), lines.same_zenith, order);
    sum = arc_sums(theta, shape, index, table, t, arc, false, shadow);
    for (int side = 0; side < 2; ++side) {
      arc = (side == 0) ? make_arc(lines.same_zenith, lines.flat_limit, order)
                        : make_arc(lines.flat_limit, lines.horizon, order);
      sum = add_weighted(sum, arc_sums(theta, shape, index, table, t, arc, true, real(0.0)), real(1.0));
    }
  } else {
    Arc arc = make_arc(real2(real(1.0), real(0.0)), lines.horizon, order);
    sum = arc_sums(theta, shape, index, table, t, arc, false, real(0.0));
  }
  real below = theta.c * real(4.0) * atan_unit(lines.horizon.x / (real(1.0) + lines.horizon.y));
  real behind = real(2.0) * theta.s * t * lines.horizon.x * lines.horizon.y;
  sum.deficit += below - behind;
  sum.deficit_scale += below + behind;
  return sum;
}
