#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace dolp {

enum class Distribution : std::uint32_t { kCauchy = 0, kGaussian = 1 };
enum class Masking : std::uint32_t { kNone = 0, kVCavity = 1, kIntegral = 2, kSmith = 3 };
/// True if, in every direction, the visible facets together have the projected area of the mean surface.
constexpr bool keeps_projected_area(Masking masking) {
  return masking == Masking::kVCavity || masking == Masking::kSmith;
}
/// Single scattering ends at the first facet. Multiple scattering follows all bounces in a V-groove.
enum class Scattering : std::uint32_t { kSingle = 0, kMultiple = 1 };
enum class EmissionModel { kMoments, kFresnel, kDirect };
enum class DiffusePolarisation { kNone, kTransmission };
enum class Mode { kHemispherical, kBistatic };
enum class Precision { kAuto, kFloat, kDouble };

/// The names of the enumerators in scene files and reports, in the order of declaration.
constexpr auto words_of(Distribution) { return std::array{"cauchy", "gaussian"}; }
constexpr auto words_of(Masking) { return std::array{"none", "v-cavity", "integral", "smith"}; }
constexpr auto words_of(Scattering) { return std::array{"single", "multiple"}; }
constexpr auto words_of(EmissionModel) { return std::array{"moments", "fresnel", "direct"}; }
constexpr auto words_of(DiffusePolarisation) { return std::array{"none", "transmission"}; }
constexpr auto words_of(Mode) { return std::array{"hemispherical", "bistatic"}; }
constexpr auto words_of(Precision) { return std::array{"auto", "float", "double"}; }

template <class Choice>
constexpr const char* name_of(Choice choice) requires requires {
  words_of(choice);
}
{ return words_of(choice)[static_cast<std::size_t>(choice)]; }

template <class Choice>
constexpr std::optional<Choice> named(std::string_view word) {
  const auto words = words_of(Choice{});
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) return std::nullopt;
  return static_cast<Choice>(found - words.begin());
}

}  // namespace dolp
