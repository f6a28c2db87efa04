#include "radiometry/diffuse.hpp"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>

#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

constexpr double kRelativeError = 1e-12;
constexpr double kLeastCosine = 1e-15;  // lower end of the integral; smaller cosines contribute less than the error

}  // namespace

DiffuseReflection::DiffuseReflection(const Surface& surface, const FacetOptics& optics)
    : albedo_(surface.diffuse),
      exponent_(surface.diffuse_exponent),
      is_polarised_(albedo_ > 0.0 && surface.diffuse_polarisation == DiffusePolarisation::kTransmission) {
  if (!is_polarised_) return;
  optics_ = optics;
  const SmoothAbsorptance normal = smooth_absorptance(optics_, 1.0);
  normal_ = 0.5 * (normal.s + normal.p);
  const auto integrand = [&](double mu) { return std::pow(mu, exponent_ + 1.0) * transmitted(mu).i; };
  boost::math::quadrature::tanh_sinh<double> rule;
  const double kink = critical_cosine(optics_);
  integral_ = rule.integrate(integrand, std::max(kink, kLeastCosine), 1.0, kRelativeError);
  if (kink > kLeastCosine) integral_ += rule.integrate(integrand, kLeastCosine, kink, kRelativeError);
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
  const double scale = 2.0 * albedo_ * std::pow(cosine, exponent_) * integral_;
  return {scale * leaving.i, scale * leaving.q};
}

DiffuseLight DiffuseReflection::beam(double cos_theta_i, double cos_theta_r) const {
  if (albedo_ == 0.0 || (is_polarised_ && cos_theta_r == 0.0)) return {};
  const double scale = albedo_ * std::pow(cos_theta_i, exponent_ + 1.0) * std::pow(cos_theta_r, exponent_);
  if (!is_polarised_) return {scale, 0.0};
  const double entering = scale * transmitted(cos_theta_i).i;
  const DiffuseLight leaving = transmitted(cos_theta_r);
  return {entering * leaving.i, entering * leaving.q};
}

Eigen::VectorXd DiffuseReflection::mean_weights(const SkyNodes& nodes) const {
  return nodes.mean_weights(exponent_, [this](double cosine) { return transmitted(cosine).i; });
}

bool diffuse_diverges(const Surface& surface) {
  const bool is_polarised = surface.diffuse_polarisation == DiffusePolarisation::kTransmission;
  return surface.diffuse > 0.0 && surface.diffuse_exponent < 0.0 && !is_polarised;
}

}  // namespace dolp
