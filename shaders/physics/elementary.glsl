// Elementary functions from arithmetic, sqrt, frexp and ldexp. GLSL's own functions are too coarse (sinh near 0 may be
// off by several percent) and do not exist in double.
// Accuracy: a few units in the last place in the ranges stated here (tests/compute/evaluate/kernel_source_test.cpp).

CONST real kPi = real(3.14159265358979323846);
CONST real kLn2High = real(0.693145751953125);             // few bits, so products with exponents are exact in float
CONST real kLn2Low = real(1.42860682030941723212e-6);      // ln 2 - kLn2High
CONST real kInverseLn2 = real(1.44269504088896340736);
CONST real kSqrtHalf = real(0.70710678118654752440);

// Not a branch, unlike `c ? f(a) : g(b)`: each branch in a loop doubles the time that some drivers need to analyse it.
real choose(bool condition, real yes, real no) { return condition ? yes : no; }
real2 choose(bool condition, real2 yes, real2 no) { return condition ? yes : no; }

real2 multiply(real2 a, real2 b) { return real2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// Sum of r^j / (j+2)!, so that e^r = 1 + r + r^2 * sum, for |r| <= ln(2)/2.
real exp_series(real r) {
#ifdef DOLP_DOUBLE
  real p = real(1.0) / real(6227020800.0);
  p = p * r + real(1.0) / real(479001600.0);
  p = p * r + real(1.0) / real(39916800.0);
  p = p * r + real(1.0) / real(3628800.0);
  p = p * r + real(1.0) / real(362880.0);
  p = p * r + real(1.0) / real(40320.0);
  p = p * r + real(1.0) / real(5040.0);
#else
  real p = real(1.0) / real(5040.0);
#endif
  p = p * r + real(1.0) / real(720.0);
  p = p * r + real(1.0) / real(120.0);
  p = p * r + real(1.0) / real(24.0);
  p = p * r + real(1.0) / real(6.0);
  return p * r + real(0.5);
}

// e^x - 1 without cancellation near 0. Domain: x <= 80; below -80 the result is -1.
real expm1_real(real x) {
  real bounded = max(x, real(-80.0));
  real k = floor(bounded * kInverseLn2 + real(0.5));
  real r = (bounded - k * kLn2High) - k * kLn2Low;
  real fraction = r + r * r * exp_series(r);
  real power = ldexp(real(1.0), int(k));
  return power * fraction + (power - real(1.0));
}

// Below this exponent exp_real returns 0: e^x and its products must stay above the smallest normal number.
#ifdef DOLP_DOUBLE
CONST real kLowestExponent = real(-690.0);
#else
CONST real kLowestExponent = real(-80.0);
#endif

// e^x for x <= 80; 0 below kLowestExponent.
real exp_real(real x) {
  real bounded = max(x, kLowestExponent);
  real k = floor(bounded * kInverseLn2 + real(0.5));
  real r = (bounded - k * kLn2High) - k * kLn2Low;
  real power = ldexp(real(1.0) + (r + r * r * exp_series(r)), int(k));
  return x < kLowestExponent ? real(0.0) : power;
}

// (atanh(z)/z - 1) / z^2, for z^2 <= 0.03.
real atanh_series(real z2) {
#ifdef DOLP_DOUBLE
  real p = real(1.0) / real(23.0);
  p = p * z2 + real(1.0) / real(21.0);
  p = p * z2 + real(1.0) / real(19.0);
  p = p * z2 + real(1.0) / real(17.0);
  p = p * z2 + real(1.0) / real(15.0);
  p = p * z2 + real(1.0) / real(13.0);
  p = p * z2 + real(1.0) / real(11.0);
#else
  real p = real(1.0) / real(11.0);
#endif
  p = p * z2 + real(1.0) / real(9.0);
  p = p * z2 + real(1.0) / real(7.0);
  p = p * z2 + real(1.0) / real(5.0);
  return p * z2 + real(1.0) / real(3.0);
}

// ln(1 + u) for u >= 0, with full relative accuracy near 0.
real log1p_real(real u) {
  precise real v = real(1.0) + u;
  precise real above_one = v - real(1.0);
  precise real lost_of_u = u - above_one;
  precise real lost_of_one = real(1.0) - (v - u);
  int exponent;
  real mantissa = frexp(v, exponent);
  bool is_low = mantissa < kSqrtHalf;
  real k = real(exponent) - (is_low ? real(1.0) : real(0.0));
  mantissa = choose(is_low, mantissa + mantissa, mantissa);
  real z = (mantissa - real(1.0)) / (mantissa + real(1.0));
  real z2 = z * z;
  real series = real(2.0) * (z + z * z2 * atanh_series(z2));
  return k * kLn2High + (series + (k * kLn2Low + choose(u < real(1.0), lost_of_u, lost_of_one) / v));
}

// The logarithm for 0 < x <= 1; it is coarse below 1e-30.
real log_unit(real x) { return -log1p_real((real(1.0) - x) / max(x, real(1e-30))); }

// ln(1 + u^2) for u >= 0. Above 1e9, where u^2 may overflow, it is 2 ln(u).
real log1p_square(real u) {
  bool is_large = u > real(1e9);
  real logarithm = log1p_real(choose(is_large, u - real(1.0), u * u));
  return choose(is_large, real(2.0) * logarithm, logarithm);
}

// asinh(y) for y >= 0. Above 1e9, where y^2 may overflow, it is ln(2 y).
real asinh_real(real y) {
  real y2 = y * y;
  return log1p_real(choose(y > real(1e9), real(2.0) * y - real(1.0), y + y2 / (real(1.0) + sqrt(real(1.0) + y2))));
}

// (sinh(x), cosh(x)) for 0 <= x <= 80.
real2 sinh_cosh(real x) {
  real e = expm1_real(x);
  real inverse = real(1.0) / (real(1.0) + e);
  return real2(real(0.5) * (e + e * inverse), real(0.5) * (real(1.0) + e + inverse));
}

// (cos(x), sin(x)) for 0 <= x <= pi/4.
real2 cos_sin(real x) {
  real z = -x * x;
#ifdef DOLP_DOUBLE
  real c = real(1.0) / real(20922789888000.0);
  real s = real(1.0) / real(355687428096000.0);
  c = c * z + real(1.0) / real(87178291200.0);
  s = s * z + real(1.0) / real(1307674368000.0);
  c = c * z + real(1.0) / real(479001600.0);
  s = s * z + real(1.0) / real(6227020800.0);
  c = c * z + real(1.0) / real(3628800.0);
  s = s * z + real(1.0) / real(39916800.0);
#else
  real c = real(1.0) / real(3628800.0);
  real s = real(1.0) / real(39916800.0);
#endif
  c = c * z + real(1.0) / real(40320.0);
  s = s * z + real(1.0) / real(362880.0);
  c = c * z + real(1.0) / real(720.0);
  s = s * z + real(1.0) / real(5040.0);
  c = c * z + real(1.0) / real(24.0);
  s = s * z + real(1.0) / real(120.0);
  return real2(real(1.0) + z * (real(0.5) + z * c), x + x * z * (real(1.0) / real(6.0) + z * s));
}

// atan(y) for 0 <= y <= 1: halves the angle twice, then sums the Taylor series.
real atan_unit(real y) {
  real y1 = y / (real(1.0) + sqrt(real(1.0) + y * y));
  real y2 = y1 / (real(1.0) + sqrt(real(1.0) + y1 * y1));
  real z = -y2 * y2;
#ifdef DOLP_DOUBLE
  real p = real(1.0) / real(25.0);
  p = p * z + real(1.0) / real(23.0);
  p = p * z + real(1.0) / real(21.0);
  p = p * z + real(1.0) / real(19.0);
  p = p * z + real(1.0) / real(17.0);
  p = p * z + real(1.0) / real(15.0);
  p = p * z + real(1.0) / real(13.0);
  p = p * z + real(1.0) / real(11.0);
#else
  real p = real(1.0) / real(11.0);
#endif
  p = p * z + real(1.0) / real(9.0);
  p = p * z + real(1.0) / real(7.0);
  p = p * z + real(1.0) / real(5.0);
  p = p * z + real(1.0) / real(3.0);
  return real(4.0) * y2 * (real(1.0) + z * p);
}
