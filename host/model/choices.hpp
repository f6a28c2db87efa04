// What a model of a surface is chosen by, and how precisely it is computed.
#pragma once

#include <cstdint>

namespace dolp {

enum class Distribution : std::uint32_t { kCauchy = 0, kGaussian = 1 };
enum class Masking : std::uint32_t { kNone = 0, kVCavity = 1, kIntegral = 2, kSmith = 3 };
enum class Precision { kAuto, kFloat, kDouble };

/// The words of scene files: "cauchy", "gaussian"; "none", "v-cavity", "integral", "smith".
const char* name_of(Distribution distribution);
const char* name_of(Masking masking);

}  // namespace dolp
