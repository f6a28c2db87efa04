// Random entries: a zenith angle, a roughness and a refractive index that the model accepts. The same seed gives the
// same entries on every machine.
#pragma once

#include "draws.hpp"
#include "model/moments.hpp"

namespace dolp {

enum class Domain {
  kOrdinary,  ///< theta up to 85 degrees, sigma 0.01 to 2, q 0.1 to 10 above its lower limit, dielectrics and metals
  kCorners,   ///< theta near 0 or 90 degrees, total reflection, n near 1, q near its lower limit; sigma up to 10
};

MomentsPoint random_entry(Draws& draw, Domain domain, Distribution distribution, Masking masking);

/// The lower limit of q: 1.5 for the Cauchy distribution with smith masking, otherwise 1.
double least_q(Distribution distribution, Masking masking);

}  // namespace dolp
