#include "evaluate/reference/mueller.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_complex.hpp>
#include <cstddef>

#include "evaluate/reference/attenuation.hpp"
#include "evaluate/reference/hemisphere.hpp"
#include "evaluate/reference/slopes.hpp"

namespace dolp {

namespace {

// 34 digits, so that the textbook's forms may cancel: near grazing, in the retro direction, at the critical angle.
using Real = boost::multiprecision::cpp_bin_float_quad;
using Complex = boost::multiprecision::cpp_complex_quad;
using Vector = std::array<Real, 3>;
using Jones = std::array<std::array<Complex, 2>, 2>;

constexpr double kMaskingTolerance = 1e-13;
constexpr double kRetro = 1e-50;  // sin^2(2 beta) below which there is no plane of incidence

Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector scaled(const Real& factor, const Vector& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
Vector unit(const Vector& a) { return scaled(1 / sqrt(dot(a, a)), a); }

/// An incident or reflected beam with its frame: direction k of propagation, s = k x z / |k x z|, p = k x s.
struct BeamFrame {
  Vector k;
  Vector s;
  Vector p;
};

Real radians(double angle_deg) { return Real(angle_deg) * boost::math::constants::pi<Real>() / 180; }

/// The unit vector toward a zenith and an azimuth.
Vector toward(double zenith_deg, double azimuth_deg) {
  const Real zenith = radians(zenith_deg);
  const Real azimuth = radians(azimuth_deg);
  return {sin(zenith) * cos(azimuth), sin(zenith) * sin(azimuth), cos(zenith)};
}

/// `s` of the azimuth, which at zenith 0 is the limit of k x z.
BeamFrame incident_beam(double zenith_deg) {
  const Vector k = scaled(-1, toward(zenith_deg, 0.0));
  const Vector s{0, 1, 0};
  return {k, s, cross(k, s)};
}

BeamFrame reflected_beam(double zenith_deg, double azimuth_deg) {
  const Vector k = toward(zenith_deg, azimuth_deg);
  const Real azimuth = radians(azimuth_deg);
  const Vector s{sin(azimuth), -cos(azimuth), 0};
  return {k, s, cross(k, s)};
}

struct Amplitudes {
  Complex s;
  Complex p;
};

Amplitudes fresnel_amplitudes(const OpticalConstants& constants, const Real& cos_beta, const Real& sin2_beta) {
  const Complex n(Real(constants.n), Real(constants.k));
  const Complex n2 = n * n;
  const Complex w = sqrt(Complex(n2 - sin2_beta));
  return {(cos_beta - w) / (cos_beta + w), (n2 * cos_beta - w) / (n2 * cos_beta + w)};
}

// Columns: the reflected (s, p) amplitudes of an incident s and an incident p wave of unit amplitude. Of the facet s is
// normal to both beams; in the retro direction any s is, because there r_p = -r_s.
Jones jones_matrix(const BeamFrame& in, const BeamFrame& out, const Amplitudes& r) {
  const Vector normal = cross(in.k, out.k);
  const Vector facet_s = dot(normal, normal) > kRetro ? unit(normal) : in.s;
  const Vector facet_in_p = cross(in.k, facet_s);
  const Vector facet_out_p = cross(out.k, facet_s);
  const std::array<Vector, 2> incident{in.s, in.p};
  const std::array<Vector, 2> reflected{out.s, out.p};
  Jones jones;
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 2; ++column) {
      jones[row][column] = dot(reflected[row], facet_s) * r.s * dot(facet_s, incident[column]) +
                           dot(reflected[row], facet_out_p) * r.p * dot(facet_in_p, incident[column]);
    }
  }
  return jones;
}

// Element (a, b) is half the trace of sigma_a J sigma_b J^+, the sigma being the matrices that turn the coherency
// matrix <E E^+> into the Stokes parameters I, Q, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
MuellerMatrix mueller_from_jones(const Jones& jones) {
  const Complex zero(0), one(1), i(0, 1);
  const std::array<Jones, 4> basis{Jones{{{one, zero}, {zero, one}}}, Jones{{{one, zero}, {zero, -one}}},
                                   Jones{{{zero, one}, {one, zero}}}, Jones{{{zero, -i}, {i, zero}}}};
  MuellerMatrix mueller{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      Complex trace = zero;
      for (std::size_t e = 0; e < 16; ++e) {
        const std::size_t w = e / 8, x = e / 4 % 2, y = e / 2 % 2, z = e % 2;
        trace += basis[a][w][x] * jones[x][y] * basis[b][y][z] * conj(jones[w][z]);
      }
      mueller[a][b] = 0.5 * static_cast<double>(trace.real());
    }
  }
  return mueller;
}

}  // namespace

MuellerMatrix reference_scattering(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                                   double theta_r_deg, double delta_phi_deg) {
  const BeamFrame in = incident_beam(theta_i_deg);
  const BeamFrame out = reflected_beam(theta_r_deg, delta_phi_deg);
  const Vector facet = sum(out.k, scaled(-1, in.k));  // 2 cos(beta) times the facet's normal
  const Real cos2_beta = dot(facet, facet) / 4;
  const auto tan2_alpha = static_cast<double>((facet[0] * facet[0] + facet[1] * facet[1]) / (facet[2] * facet[2]));
  const Amplitudes r = fresnel_amplitudes(constants, sqrt(cos2_beta), 1 - cos2_beta);

  const reference::Slopes slopes(surface.distribution, surface.sigma, surface.q);
  const reference::Attenuation attenuation(slopes, surface.masking, reference::zenith_from_deg(theta_i_deg),
                                           reference::zenith_from_deg(theta_r_deg), kMaskingTolerance);
  const double factor =
      0.25 * slopes.facet_density(tan2_alpha) * attenuation(tan2_alpha, static_cast<double>(cos2_beta));
  MuellerMatrix mueller = mueller_from_jones(jones_matrix(in, out, r));
  for (auto& row : mueller) {
    for (double& element : row) element *= factor;
  }
  return mueller;
}

MuellerMatrix reference_pbrdf(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                              double theta_r_deg, double delta_phi_deg) {
  MuellerMatrix mueller = reference_scattering(surface, constants, theta_i_deg, theta_r_deg, delta_phi_deg);
  const double cosines = reference::zenith_from_deg(theta_i_deg).cos * reference::zenith_from_deg(theta_r_deg).cos;
  for (auto& row : mueller) {
    for (double& element : row) element /= cosines;
  }
  return mueller;
}

}  // namespace dolp
