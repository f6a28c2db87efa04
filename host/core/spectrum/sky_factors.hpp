#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "model/sky_basis.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// The radiance of a scene's profile at a wavelength. Units: W m-2 sr-1 um-1.
double sky_radiance(const SkyProfile& profile, double wavelength_um, double zenith_deg);

/// at() gives pi L at the zeniths nodes(), where L is the radiance of the sky. mean() gives pi L of the uniform sky
/// that has the same irradiance.
class SkySampler {
 public:
  explicit SkySampler(const SkyProfile& profile);
  Eigen::VectorXd at(double wavelength_um) const;
  double mean(const Eigen::VectorXd& exitances) const { return mean_weights_.dot(exitances); }
  const SkyNodes& nodes() const { return nodes_; }

 private:
  const SkyProfile& profile_;
  SkyNodes nodes_;
  Eigen::VectorXd mean_weights_;
};

/// Functions of the zenith. Their weighted sums approximate the sky of each variant, minus the mean of this sky. Null
/// if all skies are uniform.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, const std::vector<SceneVariant>& variants);

/// For each sample of `rule`, the weights of the basis functions. Their weighted sum approximates the sky, minus the
/// mean of the sky. Empty without a basis.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
