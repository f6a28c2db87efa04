// The points with stored reference values: the model's hard cases, and random points with a fixed seed.
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

/// One point of one distribution and masking.
struct Case {
  std::string name;
  double theta_deg = 60.0;
  SlopeShape shape{0.3, 2.0};
  OpticalConstants index{1.508, 0.0};
};

/// The settings that all cases of a list share.
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

/// The hard cases of a group: ends of every range, coinciding split lines, indices that reflect nothing or everything.
///
/// Moments with v-cavity and smith masking vanish at 90 degrees. So these groups have a case just below
/// ("grazing-limit") instead of the case at 90 degrees.
std::vector<Case> hard_cases(const Group& group);

/// Random points: `count_a` of domain A ("random-a": sigma 0.01-1.2, q 1.06-13, theta to 89.5 degrees) and `count_b` of
/// domain B ("random-b": sigma 0.001-5, q 1.01-45, theta to 89.9 degrees); one in five is near grazing.
std::vector<Case> random_cases(const Group& group, std::uint64_t seed, std::size_t count_a, std::size_t count_b);

}  // namespace dolp::reference
