// Random entries: a zenith angle, a roughness and a refractive index that the model accepts. The same seed gives the
// same entries on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "model/moments.hpp"

namespace dolp {

enum class Domain {
  kOrdinary,  ///< theta up to 85 degrees, sigma 0.01 to 2, q 0.1 to 10 above its lower limit, dielectrics and metals
  kCorners,   ///< theta near 0 or 90 degrees, total reflection, n near 1, q near its lower limit; sigma up to 10
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(engine_); }
  double log_uniform(double low, double high);
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

 private:
  std::mt19937_64 engine_;
};

MomentsPoint random_entry(Draw& draw, Domain domain, Distribution distribution, Masking masking);

/// The lower limit of q: 1.5 for the Cauchy distribution with smith masking, otherwise 1.
double least_q(Distribution distribution, Masking masking);

}  // namespace dolp
