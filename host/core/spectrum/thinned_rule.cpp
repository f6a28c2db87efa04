#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include "model/films.hpp"
#include "model/smooth_surface.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

constexpr Eigen::Index kFewestThinned = 32;  // with fewer samples, a thinner rule saves little
// Number of angles at which curves are compared, and how many more for each fringe between grazing and normal
// incidence. With half, this and twice as many, the rule of paint_on_metal keeps 60, 62 and 56 of 414 samples.
constexpr Eigen::Index kThinAngles = 64;
constexpr Eigen::Index kThinAnglesOfFringe = 12;
constexpr double kMostThinFringes = 64.0;
constexpr Eigen::Index kSamplesOfTest = 2;
// The largest error of a sum at a tested angle is at most this share of the tolerance. The tested angles are as dense
// as those that choose the samples, so that the error elsewhere is at most kThinSafety times as large.
constexpr double kThinShareOfTolerance = 0.03;
constexpr double kLeastThinError = 1e-10;
constexpr double kThinSafety = 2.0;
constexpr double kLeastPart = 1e-4;  // the absorbed and the reflected share of radiation count as at least this

constexpr std::array<double SpectralFactors::*, 4> kTestedFactors = {
    &SpectralFactors::emitted, &SpectralFactors::surroundings, &SpectralFactors::irradiance, &SpectralFactors::width};

/// Rows: 1 - R_s and 1 - R_p at each angle, and a row of ones, so that sums keep the integral of F. Columns: samples.
/// Between two angles for `shift` = 0.5 lies one for `shift` = 1.
Eigen::MatrixXd curves(std::span<const SpectralSample> samples, Eigen::Index angles, double shift) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Ones(2 * angles + 1, std::ssize(samples));
  for (Eigen::Index i = 0; i < angles; ++i) {
    // Chebyshev points of v = sqrt(cosine) are dense at grazing and at normal incidence.
    const double share = (static_cast<double>(i) + shift) / static_cast<double>(angles);
    const double v = 0.5 * (1.0 - std::cos(std::numbers::pi * share));
    for (Eigen::Index j = 0; j < all.cols(); ++j) {
      const SmoothAbsorptance at = smooth_absorptance(samples[static_cast<std::size_t>(j)].index, v * v);
      all(2 * i, j) = at.s;
      all(2 * i + 1, j) = at.p;
    }
  }
  return all;
}

Eigen::MatrixXd tested_factors(std::span<const SpectralSample> samples) {
  Eigen::MatrixXd factors(std::ssize(samples), std::ssize(kTestedFactors));
  for (Eigen::Index j = 0; j < factors.rows(); ++j) {
    for (Eigen::Index f = 0; f < factors.cols(); ++f)
      factors(j, f) = samples[static_cast<std::size_t>(j)].*kTestedFactors[static_cast<std::size_t>(f)];
  }
  return factors;
}

/// Samples whose curves span the curves of all samples. `triangle`: the products of the orthonormal curves, made from
/// the chosen ones, with the curves of all samples.
struct Chosen {
  std::vector<Eigen::Index> samples;
  Eigen::MatrixXd triangle;

  /// Solves: the curves of the chosen samples, with the weights, give the curves that have `products`.
  Eigen::MatrixXd weights(const Eigen::MatrixXd& products) const {
    const Eigen::Index count = std::ssize(samples);
    Eigen::MatrixXd result = products;
    for (Eigen::Index k = count - 1; k >= 0; --k) {
      const auto column = triangle.col(samples[static_cast<std::size_t>(k)]);
      result.row(k) /= column[k];
      result.topRows(k) -= column.head(k) * result.row(k);
    }
    return result;
  }
};

/// The largest error of sums of `weights` at the tested angles, relative to the absorbed or the reflected radiation,
/// whichever is smaller. Shape of `exact`: rows of `tested` x factors.
double sums_error(const Eigen::MatrixXd& tested, const Chosen& chosen, const Eigen::MatrixXd& weights,
                  const Eigen::MatrixXd& exact) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(exact.rows(), exact.cols());
  for (Eigen::Index k = 0; k < weights.rows(); ++k)
    sums += tested.col(chosen.samples[static_cast<std::size_t>(k)]) * weights.row(k);
  const Eigen::Index last = exact.rows() - 1;  // the row of ones
  double worst = 0.0;
  for (Eigen::Index f = 0; f < exact.cols(); ++f) {
    const double whole = exact(last, f);
    if (whole == 0.0) continue;
    for (Eigen::Index i = 0; i < last; i += 2) {
      const double absorbed = 0.5 * (exact(i, f) + exact(i + 1, f));
      const double part = std::max(std::min(absorbed, whole - absorbed), kLeastPart * whole);
      worst = std::max(worst, (sums - exact).col(f).segment<2>(i).cwiseAbs().maxCoeff() / part);
    }
    worst = std::max(worst, std::abs(sums(last, f) - whole) / whole);
  }
  return worst;
}

/// Chooses samples until the error of the sums is at most `enough`. Returns the error; `chosen` is empty if more than
/// half of the samples would be needed.
double choose(std::span<const SpectralSample> samples, Eigen::Index angles, double enough, Chosen& chosen) {
  Eigen::MatrixXd left = curves(samples, angles, 0.5);
  const Eigen::MatrixXd tested = curves(samples, angles, 1.0);
  const Eigen::MatrixXd factors = tested_factors(samples);
  const Eigen::MatrixXd exact = tested * factors;
  const Eigen::Index most = std::min(left.rows(), left.cols() / 2);
  chosen.triangle.resize(most, left.cols());
  for (Eigen::Index k = 0; k < most; ++k) {
    Eigen::Index next = 0;
    left.colwise().squaredNorm().maxCoeff(&next);
    const Eigen::VectorXd direction = left.col(next).normalized();
    chosen.samples.push_back(next);
    chosen.triangle.row(k) = direction.transpose() * left;
    left -= direction * chosen.triangle.row(k);
    if ((k + 1) % kSamplesOfTest != 0) continue;
    const Eigen::MatrixXd weights = chosen.weights(chosen.triangle.topRows(k + 1) * factors);
    const double error = sums_error(tested, chosen, weights, exact);
    if (error <= enough) return error;
  }
  chosen.samples.clear();
  return 0.0;
}

std::vector<SpectralSample> merged(std::span<const SpectralSample> samples, const Chosen& chosen) {
  const Eigen::MatrixXd weights = chosen.weights(chosen.triangle.topRows(std::ssize(chosen.samples)));
  std::vector<SpectralSample> few;
  for (Eigen::Index k = 0; k < weights.rows(); ++k) {
    const SpectralSample& at = samples[static_cast<std::size_t>(chosen.samples[static_cast<std::size_t>(k)])];
    SpectralSample& sample = few.emplace_back();
    sample.index = at.index;
    sample.wavelength_um = at.wavelength_um;
    for (Eigen::Index j = 0; j < weights.cols(); ++j) sample.add(samples[static_cast<std::size_t>(j)], weights(k, j));
  }
  std::ranges::sort(few, {}, &SpectralSample::wavelength_um);
  return few;
}

}  // namespace

SpectralRule thinned_rule(const SceneModel& scene, SpectralRule rule) {
  const Surface& surface = scene.surface;
  // Light that meets the curves twice is no linear functional of them.
  const bool is_transmitted = surface.diffuse > 0.0 && surface.diffuse_polarisation != DiffusePolarisation::kNone;
  const bool is_linear = surface.scattering == Scattering::kSingle && !is_transmitted;
  const std::size_t in_panels = rule.panels * kPanelNodes;
  const std::span<const SpectralSample> samples(rule.samples.data(), rule.samples.size() - in_panels);
  if (surface.coating.empty() || !is_linear || std::ssize(samples) < kFewestThinned) return rule;
  double fringes = 0.0;
  for (const SpectralSample& sample : samples) fringes = std::max(fringes, fringe_count(sample.index));
  if (fringes > kMostThinFringes) return rule;
  const Eigen::Index angles = kThinAngles + kThinAnglesOfFringe * static_cast<Eigen::Index>(std::ceil(fringes));
  Chosen chosen;
  const double error =
      choose(samples, angles, std::max(kThinShareOfTolerance * scene.accuracy.tolerance, kLeastThinError), chosen);
  if (chosen.samples.empty()) return rule;
  std::vector<SpectralSample> few = merged(samples, chosen);
  std::move(rule.samples.end() - static_cast<std::ptrdiff_t>(in_panels), rule.samples.end(), std::back_inserter(few));
  rule.samples = std::move(few);
  rule.relative_error += kThinSafety * error;
  return rule;
}

}  // namespace dolp
