#pragma once

namespace dolp {

/// The light that leaves a V-groove after two or more bounces, divided by the light that meets a second facet.
struct FurtherLight {
  double i = 0.0;  ///< the part of the light that leaves, if the light comes in unpolarised
  double q = 0.0;  ///< as rho_Q is to rho_I: half the difference of this part for s and for p polarisation
};

}  // namespace dolp
