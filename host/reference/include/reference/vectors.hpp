// Vectors in space, and the reflection of a plane wave at a facet. `Real` is double or a more precise type.
#pragma once

#include <Eigen/Geometry>

namespace dolp::reference {

template <class Number>
using Vector = Eigen::Matrix<Number, 3, 1>;

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
  b.cos_beta = -k.dot(normal);
  b.k_out = k + Real(2 * b.cos_beta) * normal;
  const Vector<Real> across = k.cross(normal);
  b.s = across.squaredNorm() > kNormal ? across.normalized() : s_at_normal;
  b.p_in = k.cross(b.s);
  b.p_out = b.k_out.cross(b.s);
  return b;
}

template <class Complex>
struct Amplitudes {
  Complex s;
  Complex p;
};

/// Component of the electric vector `e` along a unit vector.
template <class Real, class Complex>
Complex along(const Vector<Real>& unit, const Vector<Complex>& e) {
  return unit[0] * e[0] + unit[1] * e[1] + unit[2] * e[2];
}

template <class Real, class Complex>
Amplitudes<Complex> components(const Bounce<Real>& b, const Vector<Complex>& e) {
  return {along(b.s, e), along(b.p_in, e)};
}

/// The electric vector after reflection. `incident`: s and p component before reflection; `r`: reflection amplitudes.
template <class Real, class Complex>
Vector<Complex> reflected(const Bounce<Real>& b, const Amplitudes<Complex>& incident, const Amplitudes<Complex>& r) {
  const Complex s = r.s * incident.s;
  const Complex p = r.p * incident.p;
  return {b.s[0] * s + b.p_out[0] * p, b.s[1] * s + b.p_out[1] * p, b.s[2] * s + b.p_out[2] * p};
}

}  // namespace dolp::reference
