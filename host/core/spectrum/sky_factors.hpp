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

/// Exitances pi L of a sky at the nodes; L is its radiance. A uniform sky with their mean gives the same irradiance.
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

/// Functions of the zenith that give the difference of each variant's sky from its mean. Null if all differences are 0.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, const std::vector<SceneVariant>& variants);

/// Weights of the functions of `basis` in the sky's difference from its mean, for each sample. Empty without a basis.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
