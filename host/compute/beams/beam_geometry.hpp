#pragma once

#include "model/angles.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// The facet that reflects one beam into the other, and the frames of the beams.
struct BeamGeometry {
  CosSin i, r;            ///< zeniths of the incident and the reflected beam
  double slope = 0.0;     ///< tan(alpha) of the facet
  double cos_beta = 1.0;  ///< angle of incidence on the facet
  double sin2_beta = 0.0;
  // eta_i and eta_r are the angles from the s vector of each beam to the s vector of the facet. A positive angle turns
  // s toward p. The angles have the sign of sin(delta_phi), and are 0 in the retro direction.
  CosSin twice_eta_i, twice_eta_r;
};

/// The part of a BeamGeometry that beams with equal zeniths share.
struct BeamZeniths {
  BeamZeniths(double theta_i_deg, double theta_r_deg);
  CosSin i, r;
  CosSin mean, difference;  ///< half the sum and half the difference of the zeniths
};

/// The mirror direction has delta_phi = 180 degrees. If theta_i is 0, the plane of incidence has azimuth 0. If theta_r
/// is 0, the plane of reflection has azimuth delta_phi. Domain: zeniths from 0 to 90 degrees, but not both 90.
BeamGeometry beam_geometry(const BeamZeniths& zeniths, double delta_phi_deg);

/// Azimuth of the normal of the facet from the horizontal direction of the reflected beam (the viewer), in radians.
double facet_azimuth(const BeamAngles& angles);

/// Cosine and sine of the zenith of the direction nearer to the horizon.
CosSin lower_direction(const BeamGeometry& beam);

/// G of the masking v-cavity.
double v_cavity_attenuation(const BeamGeometry& beam);

}  // namespace dolp
