// Random entries of the model's domain, the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "model/moments.hpp"

namespace dolp {

enum class Domain {
  kOrdinary,  ///< theta < 85 degrees, sigma 0.01 to 2, q 0.1 to 10 above its lower end, dielectrics and metals
  kCorners,   ///< next to the horizon and the normal, total reflection, indices next to 1, q next to its end, sigma to
              ///< 10
};

/// Draws that are the same on every machine.
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

/// The lower end of q.
double least_q(Distribution distribution, Masking masking);

}  // namespace dolp
