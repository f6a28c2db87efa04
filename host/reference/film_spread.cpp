#include "reference/film_spread.hpp"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <map>
#include <memory>

namespace dolp::reference {
namespace {

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

using Curve = boost::math::barycentric_rational<double>;

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

}  // namespace

bool has_spread(const FacetOptics& optics) {
  return std::ranges::any_of(optics.films, [](const Film& film) { return film.spread > 0.0; });
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

}  // namespace dolp::reference
