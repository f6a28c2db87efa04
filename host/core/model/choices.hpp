// The choices of a scene, and their names in scene files, reports and case files.
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
/// True if the facets that a direction sees have the projected area of the surface, whatever their slopes: direct
/// emission needs it, no more light is reflected than arrives, and rho and f have limits at 90 degrees. With the other
/// maskings they diverge there.
constexpr bool keeps_projected_area(Masking masking) {
  return masking == Masking::kVCavity || masking == Masking::kSmith;
}
/// Number of bounces that the light is followed for: one, or all bounces in a V-groove.
enum class Scattering : std::uint32_t { kSingle = 0, kMultiple = 1 };
enum class EmissionModel { kMoments, kFresnel, kDirect };
enum class DiffusePolarisation { kNone, kTransmission };
enum class Mode { kHemispherical, kBistatic };
enum class Precision { kAuto, kFloat, kDouble };

/// The words of an enumeration, in its order.
template <class Choice>
struct Names;
template <>
struct Names<Distribution> {
  static constexpr std::array kAll{"cauchy", "gaussian"};
};
template <>
struct Names<Masking> {
  static constexpr std::array kAll{"none", "v-cavity", "integral", "smith"};
};
template <>
struct Names<Scattering> {
  static constexpr std::array kAll{"single", "multiple"};
};
template <>
struct Names<EmissionModel> {
  static constexpr std::array kAll{"moments", "fresnel", "direct"};
};
template <>
struct Names<DiffusePolarisation> {
  static constexpr std::array kAll{"none", "transmission"};
};
template <>
struct Names<Mode> {
  static constexpr std::array kAll{"hemispherical", "bistatic"};
};
template <>
struct Names<Precision> {
  static constexpr std::array kAll{"auto", "float", "double"};
};

template <class Choice>
constexpr const char* name_of(Choice choice) requires requires {
  Names<Choice>::kAll;
}
{ return Names<Choice>::kAll[static_cast<std::size_t>(choice)]; }

/// The choice of that name, nullopt for another word.
template <class Choice>
constexpr std::optional<Choice> named(std::string_view word) {
  const auto found = std::ranges::find(Names<Choice>::kAll, word);
  if (found == Names<Choice>::kAll.end()) return std::nullopt;
  return static_cast<Choice>(found - Names<Choice>::kAll.begin());
}

}  // namespace dolp
