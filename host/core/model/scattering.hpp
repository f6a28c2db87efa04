#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// An incident and a reflected beam. delta_phi is in [-360, 360]; 180 degrees is the specular side.
struct BeamAngles {
  double theta_i_deg = 0.0;
  double theta_r_deg = 0.0;
  double delta_phi_deg = 0.0;
};

/// True if there is a facet that reflects one beam into the other. There is none if both beams are at 90 degrees.
inline bool has_facet(const BeamAngles& a) { return a.theta_i_deg < 90.0 || a.theta_r_deg < 90.0; }

inline bool is_specular(const BeamAngles& a) {
  const bool is_forward = std::abs(a.delta_phi_deg) == 180.0;
  return a.theta_i_deg == a.theta_r_deg && (is_forward || a.theta_i_deg == 0.0);
}

/// Positions in the lists of a ScatteringRequest: one pair of beams, one slope distribution and one index.
struct ScatteringEntry {
  std::uint32_t angles = 0;
  std::uint32_t shape = 0;
  std::uint32_t index = 0;
};

/// Relative error of a ScatteringMatrix with single scattering, rounding included (tests ScatteringOf.*).
constexpr double kScatteringError = 1e-11;

/// Domain: zeniths in [0, 90] degrees, but not both 90; sigma > 0; cauchy needs q > 1, and q > 3/2 with smith masking.
struct ScatteringRequest {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple: the sum over all bounces, only with v-cavity
  double accuracy = kScatteringError;           ///< relative error allowed to the sum over all bounces
  std::vector<BeamAngles> angles;
  std::vector<SlopeShape> shapes;
  std::vector<FacetOptics> optics;
  std::vector<ScatteringEntry> entries;
};

/// The Mueller matrix f_s cos(theta_i) cos(theta_r), row by row, with the specular pBRDF f_s for k_s = 1. It is finite
/// at grazing angles. Units: sr-1. shaders/physics/README.md, section 1, defines the polarisation frames, Q, U and V.
struct ScatteringMatrix {
  std::array<double, 16> m{};
  double error = 0.0;  ///< bound of the absolute error of each element
};

/// Unpolarised light scattered from one direction into another: the first column of a ScatteringMatrix.
struct Scattered {
  double i = 0.0;
  double q = 0.0;
  double u = 0.0;
  double v = 0.0;
  double error = 0.0;  ///< bound of the absolute error of i, q, u and v
};

/// The light that leaves a V-groove after two or more bounces, divided by the light that meets a second facet.
struct FurtherLight {
  double i = 0.0;  ///< the part of the light that leaves, if the light comes in unpolarised
  double q = 0.0;  ///< as rho_Q is to rho_I: half the difference of this part for s and for p polarisation
};

/// The accuracy of a request for a run with a tolerance: the error of a beam is at most a tenth of the tolerance.
inline double scattering_accuracy(Scattering scattering, double tolerance) {
  constexpr double kLeastAccuracy = 1e-5;  // however large the tolerance
  if (scattering == Scattering::kSingle) return kScatteringError;
  return std::clamp(0.1 * tolerance, kScatteringError, kLeastAccuracy);
}

}  // namespace dolp
