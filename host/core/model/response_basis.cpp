#include "model/response_basis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "model/chebyshev.hpp"
#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

// Choices of the scale c0 of the cosine. Metals need a small c0 to resolve their steep R_p near grazing incidence.
constexpr std::array<double, 5> kScales = {1.0, 0.3, 0.1, 0.03, 0.01};
constexpr Eigen::Index kLastOfCurve = 4;
// Number of angles at which a reflectance curve with fringes or measured rows is sampled. A bare medium needs fewer.
constexpr std::size_t kSamplesOfFilms = 65;
constexpr double kReach = 0.25;           // allowed error of a sum of polynomials, as a share of the tolerance
constexpr double kTimeOfResponse = 0.08;  // extra time per response, relative to a kernel pass without responses
constexpr double kLeastGain = 1.25;       // responses are used if they make a run at least this many times faster
// Allowed numbers of responses. They are few because a driver compiles separate kernels for each of them.
constexpr std::array<std::size_t, 3> kCounts = {8, 16, kMostResponses};
constexpr std::size_t kMostCandidates = 256;  // the reference index is chosen among at most so many indices
constexpr std::size_t kMostTried = 32;        // at most so many indices determine c0 and the number of responses

std::vector<FacetOptics> candidate_indices(const std::vector<FacetOptics>& indices, std::size_t most) {
  std::vector<FacetOptics> candidates;
  const std::size_t count = std::min(indices.size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    const FacetOptics& index = indices[(2 * i + 1) * indices.size() / (2 * count)];
    if (std::ranges::find(candidates, index) == candidates.end()) candidates.push_back(index);
  }
  return candidates;
}

double distance_of_bend(const OpticalConstants& index) {
  const std::complex<double> n(index.n, index.k);
  const std::complex<double> pole = 1.0 / std::sqrt(n * n + 1.0);
  const std::complex<double> branch = std::sqrt(1.0 - n * n);
  const double nearest = std::clamp(std::abs(branch.real()), 0.0, 1.0);
  return std::min(std::abs(pole), std::hypot(std::abs(branch.real()) - nearest, branch.imag()));
}

double distance_of_bend(const FacetOptics& optics) {
  double least = distance_of_bend(optics.index);
  for (const Film& film : optics.films) least = std::min(least, distance_of_bend(film.index));
  return least;
}

}  // namespace

ResponseBasis::ResponseBasis(double c0, std::size_t count, std::size_t samples, double tolerance)
    : count_(count), c0_(c0), bend_(c0), tolerance_(tolerance) {
  for (const double x : lobatto_points(static_cast<Eigen::Index>(samples)))
    cosines_.push_back(std::min(c0 * std::sinh(0.5 * (1.0 + x) * std::asinh(1.0 / c0)), 1.0));
  coefficients_ = chebyshev_coefficients(static_cast<Eigen::Index>(samples));
}

std::shared_ptr<const ResponseBasis> ResponseBasis::of(const std::vector<FacetOptics>& indices, double tolerance,
                                                       std::size_t passes) {
  const std::vector<FacetOptics> tried = candidate_indices(indices, kMostTried);
  const double indices_per_candidate = static_cast<double>(indices.size()) / static_cast<double>(tried.size());
  const bool are_bare = std::ranges::all_of(indices, &FacetOptics::is_bare);
  std::shared_ptr<ResponseBasis> basis;
  // Among equal times, the smallest error is best: then the weights of the last responses are the smallest, too.
  std::pair<double, double> least = {static_cast<double>(indices.size()) / kLeastGain, 0.0};
  for (const double c0 : kScales) {
    for (const std::size_t count : kCounts) {
      double time = static_cast<double>(passes) * (1.0 + kTimeOfResponse * static_cast<double>(count));
      double error = 0.0;
      if (time > least.first) break;
      const ResponseBasis next(c0, count, are_bare ? 2 * count + 1 : kSamplesOfFilms, tolerance);
      for (const FacetOptics& index : tried) {
        const std::optional<ResponseWeights> weights = next.find_weights(index);
        if (!weights) time += indices_per_candidate;
        if (weights)
          error = std::max(error, std::max(weights->absorbed_error, weights->split_error) / reflectance_level(index));
      }
      if (std::pair(time, error) >= least) continue;
      least = {time, error};
      basis = std::make_shared<ResponseBasis>(next);
    }
  }
  if (!basis) return nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  for (const FacetOptics& index : candidate_indices(indices, kMostCandidates)) {
    const std::optional<ResponseWeights> weights = basis->find_weights(index);
    if (!weights) continue;
    basis->bend_ = std::min(basis->bend_, distance_of_bend(index));
    // The reference must not have total reflection, which would enlarge the error bounds of all responses.
    if (critical_cosine(index) > 0.0 || reflectance_level(index) >= lowest) continue;
    lowest = reflectance_level(index);
    basis->reference_ = index;
    basis->reference_weights_ = *weights;
  }
  return std::isinf(lowest) ? nullptr : basis;
}

std::optional<ResponseWeights> ResponseBasis::find_weights(const FacetOptics& index) const {
  const auto nodes = static_cast<Eigen::Index>(cosines_.size()), count = static_cast<Eigen::Index>(count_);
  Eigen::MatrixX2d values(nodes, 2);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const SmoothAbsorptance curve = smooth_absorptance(index, cosines_[static_cast<std::size_t>(i)]);
    values.row(i) << 0.5 * (curve.s + curve.p), 0.5 * curve.split;
  }
  Eigen::MatrixX2d all(nodes, 2);
  for (Eigen::Index curve = 0; curve < 2; ++curve) all.col(curve).noalias() = coefficients_ * values.col(curve);
  const Eigen::RowVector2d errors =
      all.bottomRows(nodes - count).cwiseAbs().colwise().sum() +
      static_cast<double>(nodes) * all.bottomRows<kLastOfCurve>().cwiseAbs().colwise().maxCoeff();
  if (!(errors.maxCoeff() <= kReach * tolerance_ * reflectance_level(index))) return std::nullopt;
  return ResponseWeights{all.col(0).head(count), all.col(1).head(count), errors[0], errors[1]};
}

}  // namespace dolp
