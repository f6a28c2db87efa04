// Follows a ray through all its bounces in a V-groove (README.md beside this file, section 3).
// The two facets of the groove have the slope t = tan(alpha) and meet at the apex. The horizontal direction across the
// groove has the azimuth phi. Let gamma = pi/2 - alpha, c = cos(theta), s = sin(theta) and x = cos(phi). The unit
// vector of the ray has the component b = s sin(phi) along the groove. Its projection onto the plane across the groove
// has the length a = sqrt(c^2 + (s x)^2) and the zenith psi.
// Mirror the groove at each facet that the ray meets. Then the ray becomes a straight line, and the facets become a fan
// at the angles gamma, 3 gamma, 5 gamma, ... from the vertical. The ray meets facet k at the angle
// chi_k = psi + (2k - 1) gamma. With X_k = a sin(chi_k) and Y_k = a cos(chi_k):
//   cos(beta_k) = X_k is the cosine of the angle of incidence,
//   eta_k turns the plane of incidence: (cos(eta_k), sin(eta_k)) is proportional to (Y_k, b X_k).
// The fields are mirrored, too. So bounce k turns the Stokes vector by eta_k, multiplies it by Fresnel's matrix, and
// turns it back. The rays whose first bounce is on the same facet form a beam of the width min(c + s t x, 2c). On an
// axis across the beam, the beam begins at X_0 = max(a sin(psi - gamma), 0), and facet k ends at the position X_k. So
// the share (min(X_k, X_1) - X_0) / (X_1 - X_0) of the beam goes on to bounce k.

// The state of a ray in the fan. If a ray has many bounces, one step computes a group of 2, 4, 8 ... bounces. Groups
// are smaller near the first and the last bounce, which may be grazing (error: host/compute/plan/error_bounds.cpp).
struct Fan {
  real2 turn;    // (cos, sin) of gamma times `taken`
  real gamma;    // pi/2 - alpha; fan() sets gamma, left and slant only for steep grooves
  real left;     // number of bounces ahead; it begins as (pi/2 - psi) / gamma
  real done;     // number of bounces behind
  real slant;    // psi / gamma, but at most 1
  real taken;    // number of bounces in the next group, 2^doublings
  int doublings;
  bool is_steep;
  bool is_black;  // true if the ray has so many bounces that no light is left
};

// The state before the first bounce. The ray has the vertical component c and the component u across the groove.
Fan fan(real t, real c, real u) {
  Fan f;
  f.turn = facet_turn(t);
  f.gamma = real(0.0);
  f.left = real(0.0);
  f.done = real(0.0);
  f.slant = real(1.0);
  f.taken = real(1.0);
  f.doublings = 0;
  f.is_steep = false;
  f.is_black = false;
  // Only steep grooves have many bounces. A loop is faster than an `if`: devices skip loops, but run both branches.
  for (bool may_be = t > real(DOLP_MOST_BOUNCES) / kPi; may_be; may_be = false) {
    real to_horizon = arc_tangent(c / max(abs(u), real(1e-30)));
    f.gamma = arc_tangent(real(1.0) / t);
    f.left = (u < real(0.0) ? kPi - to_horizon : to_horizon) / f.gamma;
    real zenith = arc_tangent(abs(u) / max(c, real(1e-30)));
    f.slant = min((u < real(0.0) ? -zenith : zenith) / f.gamma, real(1.0));
    f.is_steep = f.left > real(DOLP_MOST_BOUNCES);
    f.is_black = f.left > real(DOLP_LAST_BOUNCES);
  }
  return f;
}

// Share of the beam that goes on to the next bounce in a steep groove, computed as if X_k were linear in k.
real last_share(Fan f) {
  real sum = max(real(1.0) + f.slant, real(1e-30));
  return (real(2.0) * f.left + f.slant - real(1.0)) / sum;
}

Fan next_bounces(Fan f) {
  real distance = min(f.done, f.left) * (real(1.0) / real(DOLP_GROUPS_PER_DISTANCE));
  if (real(2.0) * f.taken <= distance) {
    f.taken *= real(2.0);
    ++f.doublings;
  } else if (f.doublings > 0 && f.taken > distance) {
    f.taken *= real(0.5);
    --f.doublings;
  }
  f.turn = cos_sin(f.gamma * f.taken);
  return f;
}

// Mueller matrix of a facet in its frame, for Stokes vectors (I, Q, U, V):
// [m00 m01 0 0; m01 m00 0 0; 0 0 cross.x cross.y; 0 0 -cross.y cross.x].
struct Bounce {
  real m00;
  real m01;
  real absorbed;  // 1 - m00
  real2 cross;    // r_s* r_p, with the sign of r_p for which r_p = r_s at normal incidence
};

// The matrix of a group of 2^doublings bounces, a power of the matrix of one bounce. For one bounce, Bounce::cross is
// |r_s|^2 r_p / r_s, and r_p / r_s = (cos(beta) w - sin^2(beta)) / (cos(beta) w + sin^2(beta)). w is Fresnel::w.
Bounce bounce(IndexNode index, real cos_beta, real sin2_beta, int doublings) {
  Fresnel f = fresnel(index, cos_beta);
  real2 cw = real2(cos_beta * f.w.x, cos_beta * f.w.y);
  real scale = f.r_s / max((cw.x + sin2_beta) * (cw.x + sin2_beta) + cw.y * cw.y, kSmallestSquare);
  real half_split = real(0.5) * f.split_over_sin2 * sin2_beta;
  Bounce combined;
  combined.m00 = f.r_s - half_split;
  combined.m01 = half_split;
  combined.absorbed = f.absorbed_s + half_split;
  combined.cross = real2(scale * (cw.x * cw.x + cw.y * cw.y - sin2_beta * sin2_beta), scale * real(2.0) * sin2_beta * cw.y);
  for (bool is_doubled = doublings > 0; is_doubled; is_doubled = false) {
    for (int i = 0; i < DOLP_MOST_DOUBLINGS; ++i) {
      if (i < doublings) {
        Bounce doubled;
        doubled.m00 = combined.m00 * combined.m00 + combined.m01 * combined.m01;
        doubled.m01 = real(2.0) * combined.m00 * combined.m01;
        doubled.absorbed = combined.absorbed * (real(1.0) + combined.m00) - combined.m01 * combined.m01;
        doubled.cross = real2((combined.cross.x - combined.cross.y) * (combined.cross.x + combined.cross.y),
                          real(2.0) * combined.cross.x * combined.cross.y);
        combined = doubled;
      }
    }
  }
  return combined;
}

// Turns the Stokes vector `stokes` by eta, reflects it, and turns it back. `twice` is (cos, sin) of 2 eta.
real4 bounced(Bounce by, real2 twice, real4 stokes) {
  real q = twice.x * stokes.y + twice.y * stokes.z;
  real u = twice.x * stokes.z - twice.y * stokes.y;
  real q_after = by.m01 * stokes.x + by.m00 * q;
  real u_after = by.cross.x * u + by.cross.y * stokes.w;
  return real4(by.m00 * stokes.x + by.m01 * q, twice.x * q_after - twice.y * u_after,
               twice.y * q_after + twice.x * u_after, by.cross.x * stokes.w - by.cross.y * u);
}

// (cos, sin) of 2 eta, where (cos(eta), sin(eta)) is proportional to (x, y).
real2 doubled_angle(real x, real y) {
  real inverse = real(1.0) / max(x * x + y * y, kSmallestSquare);
  return real2((x - y) * (x + y) * inverse, real(2.0) * x * y * inverse);
}

// Light that leaves a groove. A part of the beam may leave one bounce earlier than the rest.
struct GrooveLight {
  real4 moments;    // (r_i, r_q, albedo, deficit), as in facet.glsl
  real2 before;     // r_i and r_q of the part that leaves earlier
  real before_u;    // r_u of this part, computed for azimuthal orders only
  real cos_before;  // cos(theta_r) of the part that leaves earlier
  real2 last;       // r_i and r_q of the rest, which leaves after the last bounce
  real last_u;
  real cos_last;
};

// Moments per radian of azimuth, for the rays that meet the facet at the azimuth phi first. A ray that leaves after k
// bounces has cos(theta_r) = -a cos(psi + 2 k gamma), with the symbols of the head of this file.
GrooveLight reflected_in_groove(RuleNode rule, ThetaNode theta, IndexNode index, real t, real x, real sin_phi) {
  real c = theta.c;
  real u = theta.s * x;
  real b = theta.s * sin_phi;
  real inverse_a2 = real(1.0) / max(c * c + u * u, kSmallestSquare);
  Fan f = fan(t, c, u);
  real first = c * f.turn.y + u * f.turn.x;  // X_1
  // The loop adds up X_(k+1) - X_k = 2 sin(gamma) a cos(psi + 2 k gamma), because X_k - X_1 would lose digits.
  real width = (u * f.turn.x > c * f.turn.y) ? real(2.0) * c * f.turn.y : first;
  real inverse_width = real(1.0) / max(width, real(1e-30));
  real rise = real(0.0);        // X_k - X_1
  real2 between = real2(c, u);  // the length a times (cos, sin) of psi + 2 k gamma
  real share = f.is_black ? real(0.0) : real(1.0);  // share of the beam that continues
  real absorbed = real(1.0) - share;
  // Stokes vectors in the axes of the groove. `natural` begins as unpolarised light.
  real4 natural = real4(share, real(0.0), real(0.0), real(0.0));
  real2 seen = doubled_angle(-x, c * sin_phi);
  real4 polarised = real4(real(0.0), share * seen.x, share * seen.y, real(0.0));  // begins as Q = 1 in theta's frame
  real4 tilted = real4(real(0.0), -share * seen.y, share * seen.x, real(0.0));    // begins as U = 1 in theta's frame
  GrooveLight light;
  light.before = real2(real(0.0), real(0.0));
  light.before_u = real(0.0);
  light.cos_before = real(0.0);
  light.cos_last = real(0.0);
  while (share > real(0.0)) {
    light.before = real2((real(1.0) - share) * natural.x, (real(1.0) - share) * polarised.x);
    if (kHasOrders) light.before_u = (real(1.0) - share) * tilted.x;
    light.cos_before = -between.x;
    if (f.is_steep) f = next_bounces(f);
    real2 at = multiply(between, f.turn);  // (Y_k, X_k)
    real along = b * at.y;
    real norm = at.x * at.x + along * along;
    real inverse_norm = real(1.0) / max(norm, kSmallestSquare);
    real2 twice = real2((at.x - along) * (at.x + along) * inverse_norm, real(2.0) * at.x * along * inverse_norm);
    Bounce by = bounce(index, max(at.y, real(1e-15)), min(norm * inverse_a2, real(1.0)), f.doublings);
    absorbed += share * (by.absorbed * natural.x - by.m01 * (twice.x * natural.y + twice.y * natural.z));
    natural += share * (bounced(by, twice, natural) - natural);
    polarised += share * (bounced(by, twice, polarised) - polarised);
    if (kHasOrders) tilted += share * (bounced(by, twice, tilted) - tilted);
    between = multiply(at, f.turn);
    light.cos_last = -between.x;
    rise += real(2.0) * f.turn.y * between.x;
    if (f.is_steep) {
      f.done += f.taken;
      f.left -= f.taken;
    }
    share = f.is_steep ? last_share(f) : real(1.0) + rise * inverse_width;
    share = (natural.x < rule.dimmest) ? real(0.0) : clamp(share, real(0.0), real(1.0));
  }
  real beam = min(c + theta.s * t * x, real(2.0) * c);
  light.moments = real4(beam * natural.x, beam * polarised.x, beam, beam * absorbed);
  light.last = real2(beam * (natural.x - light.before.x), beam * (polarised.x - light.before.y));
  light.last_u = beam * (tilted.x - light.before_u);
  light.before = real2(beam * light.before.x, beam * light.before.y);
  light.before_u *= beam;
  return light;
}
