#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The effects of a scene that the radiometry includes. A flag has no meaning if the scene lacks the effect.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool profile = true;        ///< difference of a sky profile from its mean
  bool path_radiance = true;  ///< radiance of the path; its transmittance cancels in DOLP and always stays
  bool diffuse = true;
  bool further_bounces = true;  ///< bounces in V-grooves after the first one
  bool moments = true;          ///< specular part of rho in the direction theta, in bistatic mode of the view
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Radiation, integrated with a weight function. Units: W m-2 over a band, W m-2 um-1 at a single wavelength.
struct SpectralFactors {
  double emitted = 0.0;          ///< pi B(T); 0 without [emission]
  double surroundings = 0.0;     ///< pi B(T_surr), or pi times the mean of a sky profile; 0 without [surroundings]
  double excess = 0.0;           ///< surroundings - emitted; exactly 0 if both have the same temperature
  double irradiance = 0.0;       ///< E0 at normal incidence; 0 without [source]
  double width = 0.0;            ///< integral of the weight function in um; 1 at a single wavelength
  std::vector<double> sky = {};  ///< pi times profile, minus `surroundings`, at the nodes of SkySampler; else empty

  void add(const SpectralFactors& more, double factor);
};

/// A refractive index at which moments are needed, and the integrals of the radiation that multiply these moments.
/// rho(lambda) depends on the wavelength only through the index. On each segment between rows of the material, rho is
/// replaced by the polynomial through its values at the Gauss nodes of the segment. So the band integral of F rho,
/// where F is one of SpectralFactors, is a sum over the nodes: rho at the node times the integral of F times the node's
/// Lagrange polynomial. An integral may be negative. The integrals of all nodes add up to the band integral of F.
struct SpectralSample : SpectralFactors {
  FacetOptics index;
  double wavelength_um = 0.0;  ///< first wavelength at which the index occurs
};

/// Number of samples in a panel, ascending in wavelength. A panel is a part of a segment in which total reflection
/// begins, so that rho at each zenith has a square root in the wavelength.
inline constexpr std::size_t kPanelNodes = 8;

struct SpectralRule {
  std::vector<SpectralSample> samples;
  double path_exitance = 0.0;   ///< pi times the path radiance; 0 without [path]
  double relative_error = 0.0;  ///< bound of the relative error of band integrals without panels; 0 at one wavelength
  std::size_t panels = 0;       ///< number of panels; each has kPanelNodes samples, at the end of `samples`
  std::vector<FacetOptics> indices() const;
};

/// Samples for the spectrum of a scene. A single wavelength or a constant index needs one sample. Otherwise each
/// segment of the material gets as many Gauss nodes as the reflectances of the smooth surface require.
/// Accuracy: 1e-9 relative for band integrals (tests SpectralRule_*Band*), except in panels.
SpectralRule spectral_rule(const SceneModel& scene);

/// Estimates the error of a sum over the samples of all panels. `term(j, m)`: term of sample j, with moments of sample
/// m. In each panel, the term at every second node is predicted from the moments at the other nodes. The estimate is
/// the sum of the errors of these predictions. For a square root that begins anywhere in a panel, the estimate is at
/// least 2.3 times the error, and 6 times in the median (tests Bands_*).
template <typename Term>
double panel_error(const SpectralRule& rule, const Term& term) {
  double error = 0.0;
  for (std::size_t panel = rule.samples.size() - rule.panels * kPanelNodes; panel < rule.samples.size();
       panel += kPanelNodes) {
    for (std::size_t j = 1; j < kPanelNodes; j += 2) {
      double left = term(panel + j, panel + j);
      for (std::size_t m = 0; m < kPanelNodes; m += 2) {
        double weight = 1.0;
        for (std::size_t l = 0; l < kPanelNodes; l += 2) {
          const auto at = [&](std::size_t i) { return rule.samples[panel + i].wavelength_um; };
          if (l != m) weight *= (at(j) - at(l)) / (at(m) - at(l));
        }
        left -= weight * term(panel + j, panel + m);
      }
      error += std::abs(left);
    }
  }
  return error;
}

/// `rule` with 0 for the irradiance and exitances of dropped effects.
SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept);

}  // namespace dolp
