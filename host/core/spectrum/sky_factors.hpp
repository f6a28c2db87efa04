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

/// Samples pi times the radiance of a sky at nodes(). mean(): exitance of the uniform sky with the same irradiance.
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

/// Functions whose weighted sums approximate each variant's sky minus its mean. Null if all skies are uniform.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, const std::vector<SceneVariant>& variants);

/// For each sample of `rule`, weights with which the functions add up to the sky minus its mean. Empty without a basis.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
