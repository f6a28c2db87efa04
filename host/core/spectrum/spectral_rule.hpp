#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The effects of a scene that the radiometry includes. A flag has no meaning if the scene lacks the effect.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool profile = true;        ///< the deviation of a sky profile from its mean
  bool path_radiance = true;  ///< radiance of the path; the transmittance is always kept, and cancels in DOLP
  bool diffuse = true;
  bool further_bounces = true;  ///< bounces in V-grooves after the first one
  bool moments = true;  ///< specular part of rho (integrals over facets): at theta, in bistatic mode at the view zenith
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Integrals of radiation times a weight function over a band, in W m-2. The response of a camera is a factor of it. At
/// one wavelength: values in W m-2 um-1.
struct SpectralFactors {
  double emitted = 0.0;       ///< pi B(T); 0 without [emission]
  double surroundings = 0.0;  ///< pi B(T_surr), or pi times the mean of a sky profile; 0 without [surroundings]
  double excess = 0.0;        ///< surroundings - emitted; exactly 0 if both have the same temperature
  double irradiance = 0.0;    ///< E0 at normal incidence; 0 without [source]
  double width = 0.0;         ///< integral of the weight function in um; 1 at a single wavelength
  Eigen::VectorXd sky = {};   ///< pi L - `surroundings` at the zeniths of SkySampler; L: radiance of the sky

  void add(const SpectralFactors& more, double factor);
};

/// A refractive index at a Gauss node, and a factor for each radiation F. The integral of F times the reflectance rho
/// is the sum over the nodes of rho times the factor. Between two rows of the material's table, rho counts as a
/// polynomial. So the factor is the integral of F times the Lagrange polynomial of the node. It may be negative.
struct SpectralSample : SpectralFactors {
  FacetOptics index;
  double wavelength_um = 0.0;  ///< first wavelength at which the index occurs
};

/// Number of samples in a panel. A segment is cut into panels if rho is not smooth, as where total reflection begins.
inline constexpr std::size_t kPanelNodes = 8;

/// Diffuse reflection with a k_d that depends on the wavelength. Samples have the mean k_d, weighted with the emitted
/// radiation, or with the width if nothing is emitted. Diffuse light is linear in k_d and does not depend on the index.
/// So the integrals of k_d - mean times a radiation make the sums over samples exact.
struct DiffuseSpectrum {
  double mean = 0.0;
  double surroundings = 0.0;  ///< with the radiation SpectralFactors::surroundings
  double irradiance = 0.0;    ///< with the radiation SpectralFactors::irradiance
};

struct SpectralRule {
  std::vector<SpectralSample> samples;
  double path_exitance = 0.0;                   ///< pi times the path radiance; 0 without [path]
  std::optional<DiffuseSpectrum> diffuse = {};  ///< nullopt if k_d is the same at all wavelengths
  double relative_error = 0.0;  ///< bound of the relative error of a sum over the samples outside panels
  std::size_t panels = 0;       ///< number of panels; each has kPanelNodes samples, at the end of `samples`
  std::vector<FacetOptics> indices() const;
};

/// Samples for the spectrum of a scene. A single wavelength or a constant index needs one sample. Otherwise the band is
/// cut into segments at the rows of the material's table. A segment gets enough Gauss nodes for a smooth surface. The
/// rows of a response need no segments, because they are limits of the integrals of radiation times polynomials.
/// Accuracy: SpectralRule::relative_error. It is about 1e-9 without films and panels (tests SpectralRule_*Band*).
SpectralRule spectral_rule(const SceneModel& scene);

/// Estimates the error of a sum over the samples of all panels (tests Bands_*). `term(j, m)`: the term of sample j,
/// computed with the moments of sample m. In each panel, the moments of samples 0, 2, 4 and 6 are interpolated to
/// samples 1, 3, 5 and 7. The estimate is the sum of the absolute changes of the terms of samples 1, 3, 5 and 7.
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

/// Returns a rule with fewer samples outside panels, whose sums are equal except for an error that it adds to
/// SpectralRule::relative_error. Returns `rule` if fewer samples are not accurate enough for the scene's tolerance, or
/// if the surface has no films, because the responses of a bare medium are few (model/response_basis.hpp).
/// Derivation: the reflectance curves of many wavelengths are nearly linearly dependent. Gram-Schmidt orthogonalization
/// chooses samples k such that the curve of each sample j is a sum of c_jk R_k. Then the integral of F times R, which
/// is the sum of F_j R_j, is the sum of F'_k R_k with F'_k, the sum of F_j c_jk over j. So it is at each angle. The
/// specular part of rho is a linear functional of the curve, so F' also gives the integral of F times rho.
/// Domain: all entries have the medium and the films of `scene`, because c depends on them.
/// Accuracy: tests ThinnedRule_*.
SpectralRule thinned_rule(const SceneModel& scene, SpectralRule rule);

/// Returns `rule` without the radiation of the effects whose flags in `kept` are false.
SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept);

/// The spectral rules of a run, one for each variant of its entries. All steps of the run share them.
class SpectralRules {
 public:
  /// The rules are thin (thinned_rule) unless entries replace the medium of the scene.
  SpectralRules(const SceneModel& scene, const SceneEntries& entries);

  /// The rule of a variant. If the rules of all variants would need too much memory, at() computes the rule anew.
  std::shared_ptr<const SpectralRule> at(const SceneVariant& variant) const;

  /// Largest number of samples among the rules of `entries`.
  std::size_t most_samples(const SceneEntries& entries) const;

 private:
  std::shared_ptr<const SpectralRule> computed(const SceneVariant& variant) const;

  SceneModel scene_;
  bool is_thin_;
  std::map<SceneVariant, std::shared_ptr<const SpectralRule>> kept_;
};

}  // namespace dolp
