#include "radiometry/diffuse.hpp"

#include <cmath>

#include "model/smooth_surface.hpp"

namespace dolp {

DiffuseReflection::DiffuseReflection(const Surface& surface, const FacetOptics& optics,
                                     TransmissionIntegral transmission)
    : albedo_(surface.diffuse),
      exponent_(surface.diffuse_exponent),
      is_polarised_(albedo_ > 0.0 && surface.diffuse_polarisation == DiffusePolarisation::kTransmission),
      transmission_(transmission) {
  if (!is_polarised_) return;
  optics_ = optics;
  const SmoothAbsorptance normal = smooth_absorptance(optics_, 1.0);
  normal_ = 0.5 * (normal.s + normal.p);
  integral_ = transmission_(optics_, exponent_ + 1.0, {[](double) { return 1.0; }, {}});
}

DiffuseLight DiffuseReflection::transmitted(double cosine) const {
  if (!is_polarised_) return {1.0, 0.0};
  if (cosine <= 0.0) return {};
  const SmoothAbsorptance absorbed = smooth_absorptance(optics_, cosine);
  return {0.5 * (absorbed.s + absorbed.p) / normal_, 0.5 * (absorbed.s - absorbed.p) / normal_};
}

DiffuseLight DiffuseReflection::rho(double cosine) const {
  if (albedo_ == 0.0) return {};
  if (!is_polarised_) return {2.0 * albedo_ * std::pow(cosine, exponent_) / (exponent_ + 2.0), 0.0};
  if (cosine == 0.0) return {};
  const DiffuseLight leaving = transmitted(cosine);
  const double unit = 2.0 * albedo_ * std::pow(cosine, exponent_) / normal_;
  const double scale = unit * integral_.value;
  return {scale * leaving.i, scale * leaving.q, unit * integral_.error * leaving.i};
}

DiffuseLight DiffuseReflection::beam(double cos_theta_i, double cos_theta_r) const {
  if (albedo_ == 0.0 || (is_polarised_ && cos_theta_r == 0.0)) return {};
  const double scale = albedo_ * std::pow(cos_theta_i, exponent_ + 1.0) * std::pow(cos_theta_r, exponent_);
  if (!is_polarised_) return {scale, 0.0};
  const double entering = scale * transmitted(cos_theta_i).i;
  const DiffuseLight leaving = transmitted(cos_theta_r);
  return {entering * leaving.i, entering * leaving.q};
}

Estimate DiffuseReflection::sky_mean(const SkyNodes& nodes, const Eigen::VectorXd& sky) const {
  if (!is_polarised_) return {nodes.mean_weights(exponent_).dot(sky), 0.0};
  const auto at = [&](double zenith_deg) { return nodes.at(zenith_deg, sky)[0]; };
  const Estimate sum = transmission_(optics_, exponent_ + 1.0, {at, nodes.ends_deg()});
  const double mean = sum.value / integral_.value;
  return {mean, (sum.error + std::abs(mean) * integral_.error) / integral_.value};
}

bool diffuse_diverges(const Surface& surface) {
  const bool is_polarised = surface.diffuse_polarisation == DiffusePolarisation::kTransmission;
  return surface.diffuse > 0.0 && surface.diffuse_exponent < 0.0 && !is_polarised;
}

}  // namespace dolp
