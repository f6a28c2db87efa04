#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "model/sky_basis.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Radiance of a sky profile at a wavelength and a zenith. Units: W m-2 sr-1 um-1.
double sky_radiance(const SkyProfile& profile, double wavelength_um, double zenith_deg);

/// at() gives pi L at the zeniths nodes(), where L is the radiance of the sky. mean() gives pi L of the uniform sky
/// that has the same irradiance.
class SkySampler {
 public:
  explicit SkySampler(const SkyProfile& profile);
  Eigen::VectorXd at(double wavelength_um);  ///< fast where the air is as transparent as in the call before
  double mean(const Eigen::VectorXd& exitances) const { return mean_weights_.dot(exitances); }
  const SkyNodes& nodes() const { return nodes_; }

 private:
  const SkyProfile& profile_;
  SkyNodes nodes_;
  Eigen::VectorXd mean_weights_;
  double vertical_emissivity_ = -1.0;   ///< emissivity that emitted_shares_ belong to; kLayers only
  std::vector<double> emitted_shares_;  ///< SkyProfile::emitted_share at each node
};

/// Functions of the zenith. For each sample of the rules, a weighted sum of the functions approximates
/// SpectralSample::sky. Null if the sky is uniform.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, std::span<const SpectralRule* const> rules);

/// Weights for each sample of `rule`: `basis`, summed with them, approximates the sky. Empty without basis or sky.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
