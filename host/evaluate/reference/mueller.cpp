#include "evaluate/reference/mueller.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "evaluate/reference/attenuation.hpp"
#include "evaluate/reference/fresnel.hpp"
#include "evaluate/reference/hemisphere.hpp"
#include "evaluate/reference/slopes.hpp"

namespace dolp {

namespace {

using Vector = std::array<double, 3>;
using Jones = std::array<std::array<std::complex<double>, 2>, 2>;

constexpr double kMaskingTolerance = 1e-13;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector scaled(double factor, const Vector& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
Vector unit(const Vector& a) { return scaled(1.0 / std::sqrt(dot(a, a)), a); }

struct Frame {
  Vector s;
  Vector p;
};
// The frame of a beam of direction k with respect to a normal.
Frame frame(const Vector& k, const Vector& normal) {
  const Vector s = unit(cross(k, normal));
  return {s, cross(k, s)};
}

// Columns: the reflected (s, p) amplitudes of an incident s and an incident p wave of unit amplitude.
Jones jones_matrix(const Vector& k_i, const Vector& k_r, const Vector& facet, const reference::FresnelCoefficients& r) {
  const Vector z{0.0, 0.0, 1.0};
  const Frame in = frame(k_i, z);
  const Frame out = frame(k_r, z);
  const Frame facet_in = frame(k_i, facet);
  const Frame facet_out = frame(k_r, facet);
  Jones jones;
  const std::array<Vector, 2> incident{in.s, in.p};
  const std::array<Vector, 2> reflected{out.s, out.p};
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 2; ++column) {
      jones[row][column] = dot(reflected[row], facet_out.s) * r.r_s * dot(facet_in.s, incident[column]) +
                           dot(reflected[row], facet_out.p) * r.r_p * dot(facet_in.p, incident[column]);
    }
  }
  return jones;
}

// Element (a, b) is half the trace of sigma_a J sigma_b J^+, the sigma being the matrices that turn the coherency
// matrix <E E^+> into the Stokes parameters I, Q, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
MuellerMatrix mueller_from_jones(const Jones& jones) {
  constexpr std::complex<double> i{0.0, 1.0};
  const std::array<Jones, 4> basis{Jones{{{1.0, 0.0}, {0.0, 1.0}}}, Jones{{{1.0, 0.0}, {0.0, -1.0}}},
                                   Jones{{{0.0, 1.0}, {1.0, 0.0}}}, Jones{{{0.0, -i}, {i, 0.0}}}};
  MuellerMatrix mueller{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      std::complex<double> trace = 0.0;
      for (std::size_t e = 0; e < 16; ++e) {
        const std::size_t w = e / 8, x = e / 4 % 2, y = e / 2 % 2, z = e % 2;
        trace += basis[a][w][x] * jones[x][y] * basis[b][y][z] * std::conj(jones[w][z]);
      }
      mueller[a][b] = 0.5 * trace.real();
    }
  }
  return mueller;
}

}  // namespace

MuellerMatrix reference_pbrdf(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                              double theta_r_deg, double delta_phi_deg) {
  const double delta_phi_rad = delta_phi_deg * std::numbers::pi / 180.0;
  const reference::Zenith incident = reference::zenith_from_deg(theta_i_deg);
  const reference::Zenith reflected = reference::zenith_from_deg(theta_r_deg);
  const Vector omega_i{incident.sin, 0.0, incident.cos};
  const Vector omega_r{reflected.sin * std::cos(delta_phi_rad), reflected.sin * std::sin(delta_phi_rad), reflected.cos};
  const Vector facet = unit(sum(omega_i, omega_r));
  const double cos_beta = dot(omega_i, facet);
  const double tan2_alpha = (facet[0] * facet[0] + facet[1] * facet[1]) / (facet[2] * facet[2]);

  const reference::Slopes slopes(surface.distribution, surface.sigma, surface.q);
  const reference::Attenuation attenuation(slopes, surface.masking, incident, reflected, kMaskingTolerance);
  const double factor = slopes.facet_density(tan2_alpha) * attenuation(tan2_alpha, cos_beta * cos_beta) /
                        (4.0 * incident.cos * reflected.cos);
  const reference::FresnelCoefficients r = reference::fresnel(constants, cos_beta);
  MuellerMatrix mueller = mueller_from_jones(jones_matrix(scaled(-1.0, omega_i), omega_r, facet, r));
  for (auto& row : mueller) {
    for (double& element : row) element *= factor;
  }
  return mueller;
}

}  // namespace dolp
