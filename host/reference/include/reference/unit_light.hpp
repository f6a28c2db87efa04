// The two polarisations of a view as electric vectors.
#pragma once

#include <array>
#include <complex>

#include "reference/attenuation.hpp"
#include "reference/fresnel.hpp"
#include "reference/slope_plane.hpp"
#include "reference/vectors.hpp"

namespace dolp::reference {

using Electric = std::array<std::complex<double>, 3>;

/// Toward the view, in the axes of a groove: u at phi from the plane of incidence, v along the groove, z up.
inline Vector<double> toward_view(const SlopePoint& point, const Zenith& view) {
  return {view.sin * point.sin_chi, -view.sin * point.cos_chi, view.cos};
}

/// A wave of unit amplitude for each of the view's polarisations, s = k x z (at theta = 0 its limit) and p = k x s.
struct UnitLight {
  Electric from_s;
  Electric from_p;
};

inline UnitLight unit_light(const SlopePoint& point, const Vector<double>& k) {
  const Vector<double> s{point.cos_chi, point.sin_chi, 0.0};
  const Vector<double> p = cross(k, s);
  return {{s[0], s[1], s[2]}, {p[0], p[1], p[2]}};
}

/// Reflects a wave of a beam; returns the absorbed part of it.
inline double reflect(const Bounce<double>& b, const FresnelCoefficients& r, Electric& e) {
  const Amplitudes<std::complex<double>> incident = components(b, e);
  e = reflected(b, incident, {r.r_s, r.r_p});
  return std::norm(incident.s) * r.absorbed_s + std::norm(incident.p) * r.absorbed_p;
}

}  // namespace dolp::reference
