// Random entries of the model's domain, equal on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "model/moments.hpp"

namespace dolp {

enum class Domain {
  kOrdinary,  ///< theta < 85 degrees, sigma 0.01 to 2, q 0.1 to 10 above its lower end, dielectrics and metals
  kCorners,   ///< near the horizon, the normal, total reflection, n = 1 and the end of q; sigma up to 10
};

/// Random draws, equal on every machine.
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

/// The lower end of q for a distribution and masking.
double least_q(Distribution distribution, Masking masking);

}  // namespace dolp
