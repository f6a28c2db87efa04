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
/// A wind gives one slope width, or different widths along and across.
enum class WindModel { kIsotropic, kDirectional };
enum class Mode { kHemispherical, kBistatic };
enum class Precision { kAuto, kFloat, kDouble };
/// The response of a camera is its signal per radiant power or its signal per photon.
enum class ResponsePer { kPower, kPhoton };

/// The names of the enumerators in scene files and reports, in the order of declaration.
constexpr auto choice_names(Distribution) { return std::array{"cauchy", "gaussian"}; }
constexpr auto choice_names(Masking) { return std::array{"none", "v-cavity", "integral", "smith"}; }
constexpr auto choice_names(Scattering) { return std::array{"single", "multiple"}; }
constexpr auto choice_names(EmissionModel) { return std::array{"moments", "fresnel", "direct"}; }
constexpr auto choice_names(DiffusePolarisation) { return std::array{"none", "transmission"}; }
constexpr auto choice_names(WindModel) { return std::array{"isotropic", "directional"}; }
constexpr auto choice_names(Mode) { return std::array{"hemispherical", "bistatic"}; }
constexpr auto choice_names(Precision) { return std::array{"auto", "float", "double"}; }
constexpr auto choice_names(ResponsePer) { return std::array{"power", "photon"}; }

template <class Choice>
constexpr const char* to_name(Choice choice) requires requires {
  choice_names(choice);
}
{ return choice_names(choice)[static_cast<std::size_t>(choice)]; }

template <class Choice>
constexpr std::optional<Choice> named(std::string_view word) {
  const auto words = choice_names(Choice{});
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) return std::nullopt;
  return static_cast<Choice>(found - words.begin());
}

}  // namespace dolp
