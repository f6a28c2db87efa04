// The points whose reference moments are stored: hard cases of the model, and random points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/slopes.hpp"

namespace dolp::reference {

struct Case {
  std::string name;
  double theta_deg = 60.0;
  SlopeShape shape{0.3, 2.0};
  OpticalConstants index{1.508, 0.0};
};

struct Group {
  Distribution distribution;
  Masking masking;
};

inline constexpr std::array<Group, 8> kGroups{{{Distribution::kCauchy, Masking::kNone},
                                               {Distribution::kCauchy, Masking::kIntegral},
                                               {Distribution::kGaussian, Masking::kNone},
                                               {Distribution::kGaussian, Masking::kIntegral},
                                               {Distribution::kCauchy, Masking::kVCavity},
                                               {Distribution::kCauchy, Masking::kSmith},
                                               {Distribution::kGaussian, Masking::kVCavity},
                                               {Distribution::kGaussian, Masking::kSmith}}};

/// The hard cases of a group: the ends of every range, indices that reflect nothing or everything, and special zeniths.
/// The integral over slopes is split at some slopes; at a special zenith two of these slopes coincide. Cauchy with
/// smith masking has no cases with q up to 1.5, because the mean slope is infinite. V-cavity and smith masking have no
/// cases at 90 degrees, because the moments are 0.
std::vector<Case> hard_cases(const Group& group);

/// Random points: `count_a` of domain A (sigma 0.01 to 1.2, q 1.06 to 13, theta up to 89.5 degrees) and `count_b` of
/// domain B (sigma 0.001 to 5, q 1.01 to 45, theta up to 89.9 degrees). About a quarter has theta above 85 degrees.
std::vector<Case> random_cases(const Group& group, std::uint64_t seed, std::size_t count_a, std::size_t count_b);

}  // namespace dolp::reference
