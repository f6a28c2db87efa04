// The Mueller pBRDF of single pairs of beams.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// An incident and a reflected beam; delta_phi = 180 degrees is the specular side, range [-360, 360].
struct BeamAngles {
  double theta_i_deg = 0.0;
  double theta_r_deg = 0.0;
  double delta_phi_deg = 0.0;
};

/// True if there is a facet between the beams, that is unless both are at 90 degrees.
inline bool has_facet(const BeamAngles& a) { return a.theta_i_deg < 90.0 || a.theta_r_deg < 90.0; }

/// True if the facet between the beams lies in the surface's plane, so that a mirror reflects one beam into the other.
inline bool is_specular(const BeamAngles& a) {
  const bool is_forward = std::abs(a.delta_phi_deg) == 180.0;
  return a.theta_i_deg == a.theta_r_deg && (is_forward || a.theta_i_deg == 0.0);
}

/// One entry: positions in the three lists of its request.
struct ScatteringEntry {
  std::uint32_t angles = 0;
  std::uint32_t shape = 0;
  std::uint32_t index = 0;
};

/// Lists of pairs of beams, slope shapes and facet optics, and the combinations that are wanted.
/// Domain: zeniths in [0, 90] degrees, not 90 both; sigma > 0; cauchy q > 1, with smith masking q > 3/2.
struct ScatteringRequest {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple: the sum over all bounces, with v-cavity
  Precision precision = Precision::kAuto;       ///< kAuto: float
  std::vector<BeamAngles> angles;
  std::vector<SlopeShape> shapes;
  std::vector<FacetOptics> optics;
  std::vector<ScatteringEntry> entries;
};

/// f_s cos(theta_i) cos(theta_r) for k_s = 1, which is finite at grazing incidence, row by row.
/// Units: sr-1. Conventions: frames, Q, U and V of shaders/physics/README.md, section 1.
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
  double error = 0.0;  ///< bound of the absolute error of each one
};

/// Bounds of the errors over m00, rounding included (tests MuellerAccuracy.*).
constexpr double kScatteringErrorFloat = 1e-5;
constexpr double kScatteringErrorDouble = 1e-11;

}  // namespace dolp
