#include "reference/fresnel.hpp"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <dolp/errors.hpp>
#include <map>
#include <memory>
#include <numbers>

#include "base/interrupt.hpp"

namespace boost::math::interpolators {}

namespace dolp::reference {
namespace {

// Boost 1.74 has barycentric_rational in the first of these namespaces, Boost 1.83 in the second.
namespace curves {
using namespace boost::math;
using namespace boost::math::interpolators;
}  // namespace curves

FresnelCoefficients bare_coefficients(const OpticalConstants& constants, double cos_beta) {
  const std::complex<double> refractive_index{constants.n, constants.k};
  const std::complex<double> n2 = refractive_index * refractive_index;
  // w = sqrt(N^2 - sin^2(beta)), in a form that gives exactly cos(beta) for N = 1
  const std::complex<double> w = std::sqrt((refractive_index - 1.0) * (refractive_index + 1.0) + cos_beta * cos_beta);
  const std::complex<double> below_s = cos_beta + w;
  const std::complex<double> below_p = n2 * cos_beta + w;
  FresnelCoefficients result;
  result.r_s = (cos_beta - w) / below_s;
  result.r_p = (n2 * cos_beta - w) / below_p;
  result.absorbed_s = 4.0 * cos_beta * w.real() / std::norm(below_s);
  result.absorbed_p = 4.0 * cos_beta * (std::conj(n2) * w).real() / std::norm(below_p);
  return result;
}

FresnelCoefficients measured_coefficients(const MeasuredReflectance& measured, double cos_beta) {
  const double beta_deg = std::acos(std::min(cos_beta, 1.0)) * 180.0 / std::numbers::pi;
  std::size_t i = 1;
  while (i + 1 < measured.beta_deg.size() && measured.beta_deg[i] < beta_deg) ++i;
  const double before = measured.beta_deg[i - 1];
  const double after = measured.beta_deg[i];
  const auto between = [&](double a, double b) {
    return (a * (after - beta_deg) + b * (beta_deg - before)) / (after - before);
  };
  double r_s = between(measured.r_s[i - 1], measured.r_s[i]);
  double r_p = between(measured.r_p[i - 1], measured.r_p[i]);
  if (i == 1) {
    const double ratio = std::sin(beta_deg * std::numbers::pi / 180.0) / std::sin(after * std::numbers::pi / 180.0);
    const double half = 0.5 * (measured.r_s[1] - measured.r_p[1]) * ratio * ratio;
    const double mean = 0.5 * (r_s + r_p);
    // The difference is at most so large that both reflectances are in [0, 1]. Their mean stays as it is.
    const double excess = std::max({0.0, std::abs(half) - mean, std::abs(half) - (1.0 - mean)});
    r_s = std::max(mean + half - std::copysign(excess, half), 0.0);
    r_p = std::max(mean - half + std::copysign(excess, half), 0.0);
  }
  return {std::sqrt(r_s), std::sqrt(r_p), 1.0 - r_s, 1.0 - r_p};
}

constexpr double kSpreads = 8.0;
constexpr double kMostPanelsPerFringe = 12.0;
constexpr double kFewestPanels = 8.0;

/// Thicknesses of a film and their weights.
std::vector<std::pair<double, double>> thickness_rule(const Film& film, double cos_beta) {
  using Rule = boost::math::quadrature::gauss<double, 16>;
  const double from = std::max(0.0, film.thickness - kSpreads * film.spread);
  const double to = film.thickness + kSpreads * film.spread;
  const double fringes = 2.0 * (to - from) * std::hypot(film.index.n, film.index.k);
  const double per_fringe = std::min(6.0 + 0.2 / cos_beta, kMostPanelsPerFringe);  // resonances near grazing are narrow
  const double panels = std::max(kFewestPanels, std::ceil(per_fringe * fringes));
  const double half = 0.5 * (to - from) / panels;
  std::vector<std::pair<double, double>> rule;
  double sum = 0.0;
  const auto add = [&](double thickness, double weight) {
    const double off = (thickness - film.thickness) / film.spread;
    rule.emplace_back(thickness, weight * std::exp(-0.5 * off * off));
    sum += rule.back().second;
  };
  for (double i = 0.0; i < panels; ++i) {
    const double middle = from + (2.0 * i + 1.0) * half;
    for (std::size_t j = 0; j < Rule::abscissa().size(); ++j) {
      add(middle - half * Rule::abscissa()[j], Rule::weights()[j]);
      add(middle + half * Rule::abscissa()[j], Rule::weights()[j]);
    }
  }
  for (auto& [thickness, weight] : rule) weight /= sum;
  return rule;
}

using Curve = curves::barycentric_rational<double>;

/// 1 - R_s and 1 - R_p over sqrt(cos(beta)).
struct MeanCurves {
  std::unique_ptr<Curve> absorbed_s, absorbed_p;
};

MeanCurves mean_curves(const FacetOptics& optics) {
  constexpr double kPoints = 150.0;
  constexpr double kPointsPerFringe = 4.0;
  constexpr std::size_t kOrder = 8;
  constexpr double kLeastRoot = 1e-6;
  double fringes = 0.0;
  for (const Film& film : optics.films) fringes += 2.0 * film.thickness * film.index.n;  // more than any film has
  const double last = kPoints + kPointsPerFringe * fringes;
  std::vector<double> at, absorbed_s, absorbed_p;
  for (double i = 0.0; i <= last; ++i) {
    at.push_back(std::max(i / last, kLeastRoot));
    absorbed_s.push_back(0.0);
    absorbed_p.push_back(0.0);
    for (const auto& [stack, weight] : single_stacks(optics, at.back() * at.back())) {
      const FresnelCoefficients own = fresnel(stack, at.back() * at.back());
      absorbed_s.back() += weight * own.absorbed_s;
      absorbed_p.back() += weight * own.absorbed_p;
    }
  }
  return {std::make_unique<Curve>(at.begin(), at.end(), absorbed_s.begin(), kOrder),
          std::make_unique<Curve>(at.begin(), at.end(), absorbed_p.begin(), kOrder)};
}

/// Mean reflectances and absorptances of a stack whose films vary. The amplitudes are the roots of the reflectances.
/// Interpolated in sqrt(cos(beta)) between means that are kept for the next call.
FresnelCoefficients mean_coefficients(const FacetOptics& optics, double cos_beta) {
  constexpr std::size_t kMostKept = 64;
  thread_local std::map<FacetOptics, MeanCurves> known;
  auto found = known.find(optics);
  if (found == known.end()) {
    if (known.size() >= kMostKept) known.clear();
    found = known.emplace(optics, mean_curves(optics)).first;
  }
  const double root = std::sqrt(cos_beta);
  const double s = std::clamp((*found->second.absorbed_s)(root), 0.0, 1.0);
  const double p = std::clamp((*found->second.absorbed_p)(root), 0.0, 1.0);
  return {std::sqrt(1.0 - s), std::sqrt(1.0 - p), s, p};
}

}  // namespace

FresnelCoefficients fresnel(const FacetOptics& optics, double cos_beta) {
  if (interrupted()) throw Cancelled();  // one entry may take minutes
  if (optics.measured) return measured_coefficients(*optics.measured, cos_beta);
  if (optics.films.empty()) return bare_coefficients(optics.index, cos_beta);
  if (std::ranges::any_of(optics.films, [](const Film& film) { return film.spread > 0.0; }))
    return mean_coefficients(optics, cos_beta);
  const auto r = stack_amplitudes<std::complex<double>>(optics, cos_beta, (1.0 - cos_beta) * (1.0 + cos_beta));
  return {r.s, r.p, 1.0 - std::norm(r.s), 1.0 - std::norm(r.p)};
}

std::vector<std::pair<FacetOptics, double>> single_stacks(const FacetOptics& optics, double cos_beta) {
  std::vector<std::pair<FacetOptics, double>> stacks = {{optics, 1.0}};
  for (std::size_t j = 0; j < optics.films.size(); ++j) {
    if (optics.films[j].spread == 0.0) continue;
    std::vector<std::pair<FacetOptics, double>> product;
    for (const auto& [stack, weight] : stacks) {
      for (const auto& [thickness, share] : thickness_rule(optics.films[j], cos_beta)) {
        auto& [single, own] = product.emplace_back(stack, weight * share);
        single.films[j] = {optics.films[j].index, thickness, 0.0};
      }
    }
    stacks = std::move(product);
  }
  return stacks;
}

}  // namespace dolp::reference
