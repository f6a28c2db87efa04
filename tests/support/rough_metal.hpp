// A scene with a rough metal. Multiple bounces change the DOLP of a rough metal more than the DOLP of other surfaces.
#pragma once

#include <string>

namespace dolp {

inline const std::string kRoughMetal = R"(
[surface]
n = 10
k = 60
distribution = "gaussian"
sigma = 0.3
masking = "v-cavity"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
)";

}  // namespace dolp
