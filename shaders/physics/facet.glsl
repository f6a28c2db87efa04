// Reflection and emission of one facet: the integrand of the moments in slope space (sections 1 to 3 of README.md
// beside this file).
//
// A facet has slope t and azimuth phi from the plane of incidence; x = cos(phi), r2 = cos^2(alpha) = 1 / (1 + t^2),
// e = c + s t x. Then
//   rho c = integral P(t) t dt * 2 integral_0^phi_m e G M dphi,     cos(beta) = r e,     cos(theta_r) = 2 r2 e - c,
//   sin^2(beta)             = r2 [(c t x - s)^2 + t^2 (1 - x^2)],
//   sin^2(beta) cos(2 eta)  = r2 [(c t x - s)^2 - t^2 (1 - x^2)],
//   M00 = R_s - D sin^2(beta) / 2,   M01 = D sin^2(beta) cos(2 eta) / 2,   D = (R_s - R_p) / sin^2(beta).
//
// Moments and their sums are vectors (r_i, r_q, albedo, deficit); the deficit is the part of the beam that is not
// reflected: masked, absorbed, or sent below the horizon.

struct Facet {
  real e;         // projected area toward theta divided by the area of the facet's base
  real cos_beta;
  real rotation;  // sin^2(beta) cos(2 eta)
  real cos_r;     // cosine of the reflected ray's zenith
  real m00;
  real m01;
  real absorbed;  // 1 - m00
};

Facet facet(ThetaNode theta, IndexNode index, real t, real x, real sin_phi) {
  real r2 = real(1.0) / (real(1.0) + t * t);
  real e = theta.c + theta.s * t * x;
  real along = theta.c * t * x - theta.s;
  real across = t * sin_phi;
  real cos_beta = sqrt(r2) * e;
  Fresnel f;
  if (kHasCurves) {
    f = reflectance_at(index, cos_beta);
  } else {
    f = fresnel(index, cos_beta);
  }
  real half_split = real(0.5) * f.split_over_sin2 * r2;
  real split = half_split * (along * along + across * across);
  Facet result;
  result.e = e;
  result.cos_beta = cos_beta;
  result.rotation = r2 * (along * along - across * across);
  result.cos_r = clamp(real(2.0) * r2 * e - theta.c, real(0.0), real(1.0));
  result.m00 = f.r_s - split;
  result.m01 = half_split * (along * along - across * across);
  result.absorbed = f.absorbed_s + split;
  return result;
}

// The facet's projection in two parts: e G, which masking leaves, and e (1 - G), which it hides. Each is computed
// directly, because either may be the difference of two nearly equal numbers.
struct Projection {
  real visible;
  real hidden;
};

// Integrand per unit of azimuth.
real4 reflected(Facet f, Projection part) {
  return real4(part.visible * f.m00, part.visible * f.m01, part.visible, part.hidden + part.visible * f.absorbed);
}

// A facet's projection toward the viewer, masked only for theta.
real seen_directly(ThetaNode theta, Facet f) {
  return (kMasking == DOLP_MASKING_V_CAVITY) ? min(f.e, real(2.0) * theta.c) : f.e;
}

// Emission of a facet straight to the viewer per unit of azimuth, as (I, Q): e G1 (1 - M00) and -e G1 M01, masked only
// for theta. The factor of smith masking, equal for all facets, is applied later.
real2 emitted(ThetaNode theta, Facet f) {
  real visible = seen_directly(theta, f);
  return real2(visible * f.absorbed, -visible * f.m01);
}
