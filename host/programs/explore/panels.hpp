// Values of the views beside the map: slope distributions, a material over wavelength, the pBRDF in the plane of
// incidence.
#pragma once

#include <array>
#include <cstddef>
#include <dolp/dolp.hpp>
#include <string>
#include <vector>

namespace dolp::explore {

/// A view beside the curve; it is computed while it is shown.
enum class Panel : std::uint8_t { kMap, kSlopes, kMaterial, kScattering };

struct PanelDescription {
  Panel panel;
  const char* name;  ///< UTF-8
};
inline constexpr std::array<PanelDescription, 4> kPanels = {{{Panel::kMap, "map"},
                                                             {Panel::kSlopes, "slopes"},
                                                             {Panel::kMaterial, "n and k"},
                                                             {Panel::kScattering, "pBRDF"}}};

/// The other distribution with the same density of flat facets, sigma_G = sigma / sqrt(q - 1), as changes of a scene.
std::vector<Setting> other_distribution(const Scene& scene);

/// The slope distribution D at an angle alpha of facets from the mean plane.
/// Equation: (8) cauchy, (1) gaussian. Units: 1/sr. Accuracy: ExplorePanels.SlopeDensity_IsNormalised.
double slope_density(const Scene& scene, double alpha_deg);

/// n and k over wavelengths.
struct MaterialCurve {
  std::vector<double> wavelength_um, n, k;
};

/// From the first to the last wavelength at which a built-in material is known; else over the scene's own spectrum and
/// as much beside it.
MaterialCurve material_curve(const Scene& scene, std::size_t count);

/// The ends of the scene's spectrum, equal for a single wavelength.
std::pair<double, double> spectrum_um(const Scene& scene);

/// The Mueller pBRDF in the plane of incidence.
struct ScatteringCut {
  std::vector<double> theta_r_deg;  ///< from -90 to 90; positive: beyond the normal, where a mirror reflects to
  std::vector<MuellerMatrix> matrices;
  double wavelength_um = 0.0;  ///< the middle of a band
};

/// `count` directions of reflection for one of incidence. Errors: InputError where the scene has no pBRDF there; those
/// of Evaluator.
ScatteringCut scattering_cut(Evaluator& evaluator, const Scene& scene, double theta_i_deg, std::size_t count);

}  // namespace dolp::explore
