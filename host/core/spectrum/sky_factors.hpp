// The sky of a scene over the zenith, for each spectral sample.
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

/// Exitances pi L of a scene's profile at its nodes, and their mean, the exitance of a uniform sky with equal
/// irradiance.
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

/// A basis of what the sky adds to its mean, over all samples of a scene's variants. Null if it adds nothing.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, const std::vector<SceneVariant>& variants);

/// Weights of the moments with the functions of a basis, for what the sky adds to its mean in each sample of a rule.
/// Empty if no sample has a sky.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
