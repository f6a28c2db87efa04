// The test cases of the study of accuracy, from easy cases to the hardest ones that the model allows.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/moments.hpp"

namespace dolp::bench {

/// An entry with a name. All cases have the Cauchy distribution.
struct Case {
  std::string name;
  std::string what;
  Masking masking = Masking::kIntegral;
  double theta_deg = 60.0;
  SlopeShape shape;
  OpticalConstants index;
};

/// All cases, in the order in which figures show them.
const std::vector<Case>& cases();

/// A request of `count` entries. The first entry is the case itself. In the other entries, theta, sigma and q differ
/// from the case by up to 1e-3 (relative). So all entries take equal time, but no two entries can share a computation.
MomentsRequest neighbourhood(const Case& which, std::size_t count);

}  // namespace dolp::bench
