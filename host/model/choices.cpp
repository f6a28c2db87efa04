#include "model/choices.hpp"

#include <array>
#include <cstddef>

namespace dolp {

const char* name_of(Distribution distribution) { return distribution == Distribution::kCauchy ? "cauchy" : "gaussian"; }

const char* name_of(Masking masking) {
  constexpr std::array<const char*, 4> kNames{"none", "v-cavity", "integral", "smith"};
  return kNames[static_cast<std::size_t>(masking)];
}

}  // namespace dolp
