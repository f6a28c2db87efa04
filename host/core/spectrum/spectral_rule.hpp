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
  bool moments = true;          ///< specular part of rho in the direction theta (bistatic mode: of the view)
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Integrals of radiation times a weight function. Units: W m-2 over a band, W m-2 um-1 at a single wavelength.
struct SpectralFactors {
  double emitted = 0.0;          ///< pi B(T); 0 without [emission]
  double surroundings = 0.0;     ///< pi B(T_surr), or pi times the mean of a sky profile; 0 without [surroundings]
  double excess = 0.0;           ///< surroundings - emitted; exactly 0 if both have the same temperature
  double irradiance = 0.0;       ///< E0 at normal incidence; 0 without [source]
  double width = 0.0;            ///< integral of the weight function in um; 1 at a single wavelength
  std::vector<double> sky = {};  ///< pi times sky profile, minus `surroundings`, at the nodes of SkySampler

  void add(const SpectralFactors& more, double factor);
};

/// A refractive index at which moments are needed, and the factors that multiply these moments. In each segment between
/// two rows of the material's table, rho is the polynomial through its values at Gauss nodes. So the band integral of a
/// radiation F times rho is the sum over the nodes of rho w, with w = integral of F L and the Lagrange polynomial L of
/// the node. w may be negative.
struct SpectralSample : SpectralFactors {
  FacetOptics index;
  double wavelength_um = 0.0;  ///< first wavelength at which the index occurs
};

/// Number of samples in a panel, a part of a segment in which total reflection begins. There rho is not smooth.
inline constexpr std::size_t kPanelNodes = 8;

struct SpectralRule {
  std::vector<SpectralSample> samples;
  double path_exitance = 0.0;   ///< pi times the path radiance; 0 without [path]
  double relative_error = 0.0;  ///< bound of the relative error of band integrals without panels; 0 at one wavelength
  std::size_t panels = 0;       ///< number of panels; each has kPanelNodes samples, at the end of `samples`
  std::vector<FacetOptics> indices() const;
};

/// Samples for the spectrum of a scene. A single wavelength or a constant index needs one sample. Otherwise each
/// segment between rows of the material's table gets enough Gauss nodes for the reflectances of the smooth surface.
/// Accuracy: 1e-9 relative for band integrals (tests SpectralRule_*Band*), except in panels.
SpectralRule spectral_rule(const SceneModel& scene);

/// Estimates the error of a sum over the samples of all panels. `term(j, m)`: term of sample j, with moments of sample
/// m. Predicts every second term of a panel from the moments at the other nodes, and adds up the errors of these
/// predictions (tests Bands_*).
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

/// Returns `rule` with 0 for the radiation that belongs to dropped effects.
SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept);

}  // namespace dolp
