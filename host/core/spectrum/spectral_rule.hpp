#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The effects of a scene that the radiometry includes. Flags of effects that the scene lacks change nothing.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool profile = true;        ///< difference of the surroundings' profile from its mean
  bool path_radiance = true;  ///< only the radiance; the transmittance, which cancels in DOLP, always stays
  bool diffuse = true;
  bool further_bounces = true;  ///< bounces in V-grooves after the first bounce
  bool moments = true;  ///< specular part of rho, from the evaluator's moments at theta or (bistatic) at the view
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Integrals of the radiation times a weight function. Units: W m-2 over a band, W m-2 um-1 at a single wavelength.
struct SpectralFactors {
  double emitted = 0.0;          ///< pi B(T); 0 without [emission]
  double surroundings = 0.0;     ///< pi B(T_surr), or the mean of a profile; 0 without [surroundings]
  double excess = 0.0;           ///< surroundings - emitted; exactly 0 if the temperatures are equal
  double irradiance = 0.0;       ///< E0 at normal incidence; 0 without [source]
  double width = 0.0;            ///< integral of the weight function in um; 1 at a single wavelength
  std::vector<double> sky = {};  ///< profile minus its mean, at the nodes of SkySampler; empty without a profile

  void add(const SpectralFactors& more, double factor);
};

/// One refractive index at which moments are needed, and the integrals of the radiation that multiply these moments.
/// The moments rho(lambda) depend on the wavelength only through the index. On each segment between rows of the
/// material, rho is taken as the polynomial through its values at the Gauss nodes of the segment. So the band integral
/// of F rho, for a factor F, is a sum over the nodes: rho at the node times the integral of F times the node's Lagrange
/// polynomial. Such an integral may be negative. The integrals of all nodes add up to the band integral of F.
struct SpectralSample : SpectralFactors {
  FacetOptics index;
  double wavelength_um = 0.0;  ///< first wavelength at which the index occurs
};

/// Number of samples in a panel, in ascending order of wavelength. A panel is a part of a segment in which total
/// reflection begins. At each zenith rho has a square root in the wavelength there.
inline constexpr std::size_t kPanelNodes = 8;

struct SpectralRule {
  std::vector<SpectralSample> samples;
  double path_exitance = 0.0;   ///< pi times the path radiance; 0 without [path]
  double relative_error = 0.0;  ///< bound of the relative error of band sums, without panels; 0 at a single wavelength
  std::size_t panels = 0;       ///< number of panels; their samples, kPanelNodes each, are the last of `samples`
  std::vector<FacetOptics> indices() const;
};

/// A single wavelength or a constant index needs one sample. Otherwise each segment of the material gets as many Gauss
/// nodes as the reflectances of the smooth surface require.
/// Accuracy: 1e-9 relative for band sums (tests SpectralRule_*Band*), except for panels.
SpectralRule spectral_rule(const SceneModel& scene);

/// Estimates the error of a sum over the panels. `term(j, m)`: term of sample j, with the moments of sample m.
/// The term at every second node of a panel is predicted from the terms at the other nodes. The estimate is the sum of
/// the errors of these predictions. For a square root that begins anywhere in a panel, the estimate is at least 2.3
/// times the error, and 6 times in the median (tests Bands_*).
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

/// A rule with the factors of dropped effects set to 0.
SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept);

}  // namespace dolp
