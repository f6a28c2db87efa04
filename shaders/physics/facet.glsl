// One facet: the integrand of the moments (README.md beside this file, sections 1 to 3).
// A facet has the slope t and the azimuth phi, measured from the plane of incidence. Let c = cos(theta), s =
// sin(theta), x = cos(phi) and r = cos(alpha) = 1 / sqrt(1 + t^2). The projected area of the facet toward theta is e =
// c + s t x, per area of its base. The reflected ray leaves the surface for phi from 0 to phi_m. Then
//   r_i = rho_I c = integral P(t) t dt * 2 integral_0^phi_m e G M00 dphi,   r_q = rho_Q c with M01 instead of M00,
//   cos(beta) = r e,   cos(theta_r) = 2 r^2 e - c,
//   sin^2(beta)             = r^2 [(c t x - s)^2 + t^2 (1 - x^2)],
//   sin^2(beta) cos(2 eta)  = r^2 [(c t x - s)^2 - t^2 (1 - x^2)],
//   sin^2(beta) sin(2 eta)  = 2 r^2 (c t x - s) t sin(phi),
//   D = (R_s - R_p) / sin^2(beta),   M00 = R_s - D sin^2(beta) / 2,   M01 = D sin^2(beta) cos(2 eta) / 2,
//   M02 = D sin^2(beta) sin(2 eta) / 2.
// Sums over facets are vectors (r_i, r_q, albedo, deficit). The albedo is r_i with M00 = 1. The deficit is the part of
// the beam that does not leave the surface: the light is masked, absorbed, or reflected below the horizon.

struct Facet {
  real e;         // projected area toward theta divided by the area of the facet's base
  real cos_beta;
  real rotation;  // sin^2(beta) cos(2 eta)
  real cos_r;     // cosine of the reflected ray's zenith
  real m00;
  real m01;
  real m02;       // like m01, for the Stokes parameter U
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
  result.m02 = half_split * real(2.0) * along * across;
  result.absorbed = f.absorbed_s + split;
  return result;
}

// A facet's projection e in two parts: visible e G and hidden e (1 - G). Both are stored, because 1 - G loses digits.
struct Projection {
  real visible;
  real hidden;
};

real4 reflected(Facet f, Projection part) {
  return real4(part.visible * f.m00, part.visible * f.m01, part.visible, part.hidden + part.visible * f.absorbed);
}

// The part of the projection e that the viewer at theta sees: e G1 with v-cavity masking, else e.
real seen_directly(ThetaNode theta, Facet f) {
  return (kMasking == DOLP_MASKING_V_CAVITY) ? min(f.e, real(2.0) * theta.c) : f.e;
}

// Direct emission (I, Q) per radian of azimuth: with v-cavity masking e G1 (1 - M00) and -e G1 M01, where G1 is the
// masking toward the viewer at theta. With smith masking the result lacks the factor G1; moments.glsl multiplies by it.
real2 emitted(ThetaNode theta, Facet f) {
  real visible = seen_directly(theta, f);
  return real2(visible * f.absorbed, -visible * f.m01);
}
