#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The parts of a scene that the radiometry adds. Flags of absent parts have no effect.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool profile = true;        ///< what the profile of the surroundings adds to their mean
  bool path_radiance = true;  ///< the transmittance, which cancels in DOLP, always stays
  bool diffuse = true;
  bool further_bounces = true;  ///< bounces in grooves after the first
  bool moments = true;          ///< the specular part of rho, which the evaluators integrate: at theta, or at the view
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Integrals of the radiation with a weight. Units: exitances and irradiances in W m-2 um-1 at a single wavelength, in
/// W m-2 over a band.
struct SpectralFactors {
  double emitted = 0.0;          ///< pi B(T); 0 without [emission]
  double surroundings = 0.0;     ///< pi B(T_surr), the mean of a profile; 0 without [surroundings]
  double excess = 0.0;           ///< surroundings - emitted, exactly 0 where the temperatures are equal
  double irradiance = 0.0;       ///< E0 at normal incidence; 0 without [source]
  double width = 0.0;            ///< um; 1 at a single wavelength
  std::vector<double> sky = {};  ///< what a profile adds to its mean at its nodes (SkySampler); empty without one

  void add(const SpectralFactors& more, double factor);
};

/// One refractive index at which moments are wanted, and the integrals of the radiation for it.
///
/// The moments rho(lambda) depend on the wavelength only through the index. On each segment between rows of the
/// material they are the polynomial through the Gauss nodes of that segment. So a band integral of a factor F times rho
/// is the sum over the nodes of rho times the integral of F times the node's Lagrange polynomial. These integrals can
/// be negative, for a node that other nodes outweigh; their sums are the band integrals.
struct SpectralSample : SpectralFactors {
  FacetOptics index;
  double wavelength_um = 0.0;  ///< where the index was first met
};

/// Samples of a panel, ascending: a part of a segment in which total reflection begins, where at each zenith rho has a
/// root in the wavelength.
inline constexpr std::size_t kPanelNodes = 8;

/// The distinct indices of a scene, with their spectral weights.
struct SpectralRule {
  std::vector<SpectralSample> samples;
  double path_exitance = 0.0;   ///< pi times the path radiance; 0 without [path]
  double relative_error = 0.0;  ///< bound of the relative error of the band sums; 0 at a single wavelength
  std::size_t panels = 0;       ///< the last samples are this many panels of kPanelNodes each, apart from the error
  std::vector<FacetOptics> indices() const;
};

/// Spectral rule of a scene: one sample at a single wavelength or for a constant index, Gauss nodes on each segment of
/// the material otherwise, as many as the reflectances of the smooth surface require.
///
/// Accuracy: band sums to 1e-9 relative (tests SpectralRule_*Band*), except for panels.
SpectralRule spectral_rule(const SceneModel& scene);

/// Error of a sum over the panels of a rule. `term(j, m)`: the part of sample j, with the moments of sample m.
///
/// Every second value of a panel is predicted from the other values; the error is the sum of the predictions' errors.
/// For a square root that begins at any place among the nodes, this is 2.3 times the error and more, in the median 6
/// times (tests Bands_*).
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

/// The rule with the factors of dropped effects set to 0.
SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept);

}  // namespace dolp
