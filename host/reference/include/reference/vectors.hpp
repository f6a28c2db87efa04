// Vectors in space, and the reflection of a plane wave at a facet. `Real` is double or a more precise type.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace dolp::reference {

template <class Real>
using Vector = std::array<Real, 3>;

template <class Real>
Real dot(const Vector<Real>& a, const Vector<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Real>
Vector<Real> cross(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Real>
Vector<Real> sum(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class Real>
Vector<Real> scaled(const Real& factor, const Vector<Real>& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

template <class Real>
Vector<Real> unit(const Vector<Real>& a) {
  using std::sqrt;
  return scaled(Real(1) / sqrt(dot(a, a)), a);
}

/// s is normal to the incident direction k and the reflected direction k_out; p_in = k x s, p_out = k_out x s.
template <class Real>
struct Bounce {
  Real cos_beta;
  Vector<Real> s, p_in, p_out;
  Vector<Real> k_out;
};

/// At normal incidence s is `s_at_normal`, a unit vector in the facet. Any such vector works, because r_p = -r_s.
template <class Real>
Bounce<Real> bounce(const Vector<Real>& k, const Vector<Real>& normal, const Vector<Real>& s_at_normal) {
  constexpr double kNormal = 1e-30;  // below this sin^2 beta the direction of s is only rounding error
  Bounce<Real> b;
  b.cos_beta = -dot(k, normal);
  b.k_out = sum(k, scaled(Real(2 * b.cos_beta), normal));
  const Vector<Real> across = cross(k, normal);
  b.s = dot(across, across) > kNormal ? unit(across) : s_at_normal;
  b.p_in = cross(k, b.s);
  b.p_out = cross(b.k_out, b.s);
  return b;
}

template <class Complex>
struct Amplitudes {
  Complex s;
  Complex p;
};

template <class Real, class Complex>
Amplitudes<Complex> components(const Bounce<Real>& b, const std::array<Complex, 3>& e) {
  return {b.s[0] * e[0] + b.s[1] * e[1] + b.s[2] * e[2], b.p_in[0] * e[0] + b.p_in[1] * e[1] + b.p_in[2] * e[2]};
}

/// The electric vector after reflection. `incident`: s and p component before reflection; `r`: reflection amplitudes.
template <class Real, class Complex>
std::array<Complex, 3> reflected(const Bounce<Real>& b, const Amplitudes<Complex>& incident,
                                 const Amplitudes<Complex>& r) {
  const Complex s = r.s * incident.s;
  const Complex p = r.p * incident.p;
  std::array<Complex, 3> e;
  for (std::size_t i = 0; i < 3; ++i) e[i] = b.s[i] * s + b.p_out[i] * p;
  return e;
}

}  // namespace dolp::reference
