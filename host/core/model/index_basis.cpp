#include "model/index_basis.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

// All are chosen. Where numbers stand, they are the indices that are computed of 12 n (1.3 to 3) times 12 k (0.05 to 2)
// with half, with it and with double, at 1e-4; bounds stay below the tolerance.

// Curves are compared at cosines that crowd toward grazing incidence, where those of metals bend, and toward normal
// incidence, because no sample beyond that end constrains the combined curve.
constexpr Eigen::Index kSamples = 256;   // 11 each
constexpr double kFinestCosine = 0.005;  // 11, 11, 12
constexpr double kBetweenSamples = 2.0;  // 11 each: the largest distance over the largest at the samples
// Branch points of sqrt(N^2 - sin^2) nearer to the cosines from 0 to 1 bend curves between the samples.
constexpr double kNearestBranchPoint = 0.1;

constexpr double kReach = 1.0;     // largest error of a combined curve, of the tolerance: 11 each
constexpr double kSelected = 1.0;  // 12, 11, 11: root mean square at which the basis is large enough, of the tolerance
// Of the tolerance: keeps weights small, so that errors of the basis do not grow.
constexpr double kRidge = 0.2;                 // 11, 11, 12.5
constexpr std::size_t kMostCandidates = 512;   // of the run's indices, among which the basis is chosen
constexpr double kLeastGain = 2.0;             // indices for each that is computed
constexpr std::size_t kMostKnown = 1U << 16U;  // of the run's indices, whose weights are kept

using Curves = std::array<Eigen::VectorXd, 2>;

double cosine_of_sample(Eigen::Index sample) {
  const double x = static_cast<double>(sample + 1) / static_cast<double>(kSamples);
  return kFinestCosine * std::sinh(std::sin(0.5 * std::numbers::pi * x) * std::asinh(1.0 / kFinestCosine));
}

/// Mean and difference of the absorptances of s and p; their distances equal those of the reflectances.
Curves curves_of(const OpticalConstants& index) {
  Curves curves = {Eigen::VectorXd(kSamples), Eigen::VectorXd(kSamples)};
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, cosine_of_sample(i));
    curves[0][i] = 0.5 * (absorbed.s + absorbed.p);
    curves[1][i] = 0.5 * (absorbed.p - absorbed.s);
  }
  return curves;
}

bool is_smooth(const OpticalConstants& index) {
  const std::complex<double> n(index.n, index.k);
  const std::complex<double> branch_point = std::sqrt(1.0 - n * n);
  const double nearest = std::clamp(std::abs(branch_point.real()), 0.0, 1.0);
  return std::hypot(std::abs(branch_point.real()) - nearest, branch_point.imag()) >= kNearestBranchPoint;
}

/// Reference level of the relative errors of a curve.
double level_of(const OpticalConstants& index) {
  const SmoothAbsorptance absorbed = smooth_absorptance(index, 1.0);
  return std::min(absorbed.s, 1.0 - absorbed.s);
}

/// Indices with smooth curves from the whole list, each once.
std::vector<OpticalConstants> candidates_of(const std::vector<OpticalConstants>& indices) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::vector<OpticalConstants> candidates;
  const std::size_t count = std::min(indices.size(), kMostCandidates);
  for (std::size_t i = 0; i < count; ++i) {
    const double place = std::fmod(static_cast<double>(i) * kGoldenRatio, 1.0) * static_cast<double>(indices.size());
    const OpticalConstants& index = indices[indices.size() == count ? i : static_cast<std::size_t>(place)];
    if (is_smooth(index) && std::ranges::find(candidates, index) == candidates.end()) candidates.push_back(index);
  }
  return candidates;
}

/// Greedy selection: each next index is the one farthest from the span of those before, until all are near or there are
/// `most`.
std::vector<OpticalConstants> chosen_of(const std::vector<OpticalConstants>& candidates, double tolerance,
                                        std::size_t most) {
  std::vector<OpticalConstants> chosen = {candidates[candidates.size() / 2]};
  const Curves first = curves_of(chosen.front());
  Eigen::MatrixXd left(2 * kSamples, static_cast<Eigen::Index>(candidates.size()));
  for (Eigen::Index i = 0; i < left.cols(); ++i) {
    const OpticalConstants& index = candidates[static_cast<std::size_t>(i)];
    const Curves own = curves_of(index);
    left.col(i) << own[0] - first[0], own[1] - first[1];
    left.col(i) /= level_of(index);
  }
  const double near = kSelected * tolerance * std::sqrt(static_cast<double>(kSamples));
  Eigen::Index farthest = 0;
  while (chosen.size() <= most) {
    const double distance = std::sqrt(left.colwise().squaredNorm().maxCoeff(&farthest));
    if (distance <= near && chosen.size() > 1) break;
    chosen.push_back(candidates[static_cast<std::size_t>(farthest)]);
    const Eigen::VectorXd direction = left.col(farthest).normalized();
    left -= direction * (direction.transpose() * left).eval();
  }
  return chosen;
}

}  // namespace

std::shared_ptr<const IndexBasis> IndexBasis::of(const std::vector<OpticalConstants>& indices, double tolerance) {
  const std::vector<OpticalConstants> candidates = candidates_of(indices);
  const auto most = static_cast<std::size_t>(static_cast<double>(indices.size()) / kLeastGain);
  if (candidates.size() < 2 || most < 2) return nullptr;
  std::shared_ptr<IndexBasis> basis(new IndexBasis);
  basis->indices_ = chosen_of(candidates, tolerance, most);
  if (basis->indices_.size() > most) return nullptr;
  basis->prepare_weights(tolerance);
  const auto is_reached = [&](const OpticalConstants& index) { return basis->computed_weights(index).has_value(); };
  const auto reached = static_cast<double>(std::ranges::count_if(candidates, is_reached));
  const double count = static_cast<double>(std::min(indices.size(), kMostCandidates));
  // Estimate of the share of the indices that are computed: those of the basis, and those beyond its reach.
  const double computed_share =
      static_cast<double>(basis->indices_.size()) / static_cast<double>(indices.size()) + 1.0 - reached / count;
  if (computed_share * kLeastGain > 1.0) return nullptr;
  for (std::size_t i = 0; i < std::min(indices.size(), kMostKnown); ++i)
    basis->known_.try_emplace({indices[i].n, indices[i].k}, basis->computed_weights(indices[i]));
  return basis;
}

std::optional<IndexWeights> IndexBasis::weights_of(const OpticalConstants& index) const {
  const auto known = known_.find({index.n, index.k});
  return known == known_.end() ? computed_weights(index) : known->second;
}

/// Least squares with a ridge, which is the same for all indices.
void IndexBasis::prepare_weights(double tolerance) {
  tolerance_ = tolerance;
  const auto others = static_cast<Eigen::Index>(indices_.size()) - 1;
  first_ = curves_of(indices_.front());
  for (const Curve curve : {kMean, kDifference}) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kSamples + others, others);
    for (Eigen::Index i = 0; i < others; ++i) {
      const OpticalConstants& index = indices_[static_cast<std::size_t>(i) + 1];
      rows.col(i).head(kSamples) = curves_of(index)[curve] - first_[curve];
      rows(kSamples + i, i) = kRidge * tolerance * std::sqrt(static_cast<double>(kSamples)) * level_of(index);
    }
    curves_[curve] = rows.topRows(kSamples);
    others_[curve] = LeastSquares(rows);
  }
}

std::optional<IndexWeights> IndexBasis::computed_weights(const OpticalConstants& index) const {
  IndexWeights weights;
  const auto own = std::ranges::find(indices_, index);
  if (own != indices_.end()) {
    const auto count = static_cast<Eigen::Index>(indices_.size());
    weights.mean = weights.difference = Eigen::VectorXd::Unit(count, own - indices_.begin());
    return weights;
  }
  if (!is_smooth(index)) return std::nullopt;
  const Curves curves = curves_of(index);
  const double most = kReach * tolerance_ * level_of(index);
  for (const Curve curve : {kMean, kDifference}) {
    const Eigen::VectorXd distance = curves[curve] - first_[curve];
    const Eigen::VectorXd others = others_[curve].solve(distance);
    const double error = kBetweenSamples * (distance - curves_[curve] * others).lpNorm<Eigen::Infinity>();
    if (!(error <= most)) return std::nullopt;
    Eigen::VectorXd& all = curve == kMean ? weights.mean : weights.difference;
    all.resize(others.size() + 1);
    all << 1.0 - others.sum(), others;
    (curve == kMean ? weights.mean_error : weights.difference_error) = error;
  }
  return weights;
}

}  // namespace dolp
