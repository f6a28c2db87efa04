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

/// Values of pi times a sky's radiance at the nodes. A uniform sky with their mean() gives the same irradiance.
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

/// Functions whose weighted sums are the skies of all variants, minus their means. Null if all skies are uniform.
std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, const std::vector<SceneVariant>& variants);

/// For each sample of `rule`, weights of the functions whose sum is the sky minus its mean. Empty without a basis.
std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis);

}  // namespace dolp
