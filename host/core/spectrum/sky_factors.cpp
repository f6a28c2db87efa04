#include "spectrum/sky_factors.hpp"

#include <numbers>

#include "spectrum/planck.hpp"

namespace dolp {
namespace {

// Allowed error of the sky basis, as a share of the tolerance. Each function of the basis slows a kernel by 1/6.
constexpr double kBasisShare = 0.02;

}  // namespace

double sky_radiance(const SkyProfile& profile, double wavelength_um, double zenith_deg) {
  const SkyProfile::Emission emission = profile.at(wavelength_um, zenith_deg);
  double radiance = emission.radiance;
  if (emission.share > 0.0) radiance += emission.share * planck_radiance(wavelength_um, emission.first_K);
  if (emission.second_K > 0.0) radiance += (1.0 - emission.share) * planck_radiance(wavelength_um, emission.second_K);
  return radiance;
}

SkySampler::SkySampler(const SkyProfile& profile)
    : profile_(profile), nodes_(profile.ends_deg()), mean_weights_(nodes_.mean_weights(0.0)) {}

Eigen::VectorXd SkySampler::at(double wavelength_um) {
  const std::vector<double>& zenith_deg = nodes_.zenith_deg();
  Eigen::VectorXd exitances(static_cast<Eigen::Index>(zenith_deg.size()));
  if (profile_.kind != SkyProfile::Kind::kLayers) {
    for (std::size_t i = 0; i < zenith_deg.size(); ++i)
      exitances[static_cast<Eigen::Index>(i)] = std::numbers::pi * sky_radiance(profile_, wavelength_um, zenith_deg[i]);
    return exitances;
  }
  const double vertical = profile_.vertical_emissivity(wavelength_um);
  if (vertical != vertical_emissivity_) {
    vertical_emissivity_ = vertical;
    emitted_shares_.clear();
    for (const double at_deg : zenith_deg) emitted_shares_.push_back(SkyProfile::emitted_share(vertical, at_deg));
  }
  const double air = planck_radiance(wavelength_um, profile_.air_K);
  const double beyond = planck_radiance(wavelength_um, profile_.beyond_K);
  for (std::size_t i = 0; i < zenith_deg.size(); ++i) {
    const double share = emitted_shares_[i];
    exitances[static_cast<Eigen::Index>(i)] = std::numbers::pi * (share * air + (1.0 - share) * beyond);
  }
  return exitances;
}

std::shared_ptr<const SkyBasis> sky_basis(const SceneModel& scene, std::span<const SpectralRule* const> rules) {
  if (!scene.surroundings || !scene.surroundings->profile) return nullptr;
  std::vector<Eigen::VectorXd> functions;
  for (const SpectralRule* rule : rules) {
    for (const SpectralSample& sample : rule->samples) functions.push_back(sample.sky);
  }
  SkyNodes nodes(scene.surroundings->profile->ends_deg());
  auto basis = std::make_shared<const SkyBasis>(std::move(nodes), functions, kBasisShare * scene.accuracy.tolerance);
  return basis->size() > 0 ? basis : nullptr;
}

std::vector<SkyWeights> sky_weights(const SpectralRule& rule, const SkyBasis* basis) {
  std::vector<SkyWeights> weights;
  if (!basis || rule.samples.empty() || rule.samples.front().sky.size() == 0) return weights;
  for (const SpectralSample& sample : rule.samples) {
    weights.push_back(basis->find_weights(sample.sky));
    weights.back().error += basis->nodes().error(sample.sky);
  }
  return weights;
}

}  // namespace dolp
