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
constexpr Eigen::Index kCoefficients = 65;  // Chebyshev coefficients that are computed for a reflectance curve
constexpr Eigen::Index kLastOfCurve = 4;
constexpr double kReach = 0.25;           // allowed error of a sum of polynomials, as a share of the tolerance
constexpr double kTimeOfResponse = 0.08;  // extra time per response, relative to a kernel pass without responses
constexpr double kLeastGain = 1.25;       // responses are used if they make a run at least this many times faster
// Allowed numbers of responses. They are few because a driver compiles separate kernels for each of them.
constexpr std::array<std::size_t, 3> kCounts = {8, 16, kMostResponses};
constexpr std::size_t kMostCandidates = 256;  // the reference index is chosen among at most so many indices
constexpr std::size_t kMostTried = 32;        // at most so many indices determine c0 and the number of responses

using CurveCoefficients = Eigen::Matrix<double, kCoefficients, 2>;  ///< columns: ResponseWeights::absorbed and split

CurveCoefficients curve_coefficients(const FacetOptics& index, double c0) {
  static const std::vector<double> points = lobatto_points(kCoefficients);
  static const Eigen::MatrixXd transform = chebyshev_coefficients(kCoefficients);
  CurveCoefficients values;
  for (Eigen::Index i = 0; i < kCoefficients; ++i) {
    const double u = 0.5 * (1.0 + points[static_cast<std::size_t>(i)]);
    const SmoothAbsorptance curve = smooth_absorptance(index, std::min(c0 * std::sinh(u * std::asinh(1.0 / c0)), 1.0));
    values.row(i) << 0.5 * (curve.s + curve.p), 0.5 * curve.split;
  }
  return transform * values;
}

/// Bounds of the errors of both reflectance curves if only the first `count` coefficients are kept.
Eigen::RowVector2d tail_errors(const CurveCoefficients& all, Eigen::Index count) {
  return all.bottomRows(kCoefficients - count).cwiseAbs().colwise().sum() +
         kCoefficients * all.bottomRows<kLastOfCurve>().cwiseAbs().colwise().maxCoeff();
}

/// Number of polynomials that the reflectances of an index need; kMostResponses + 1 if kMostResponses are too few.
std::size_t needed(const FacetOptics& index, double c0, double tolerance) {
  const CurveCoefficients all = curve_coefficients(index, c0);
  const double most = kReach * tolerance * reflectance_level(index);
  std::size_t count = 2;
  while (count <= kMostResponses && !(tail_errors(all, static_cast<Eigen::Index>(count)).maxCoeff() <= most)) ++count;
  return count;
}

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

std::shared_ptr<const ResponseBasis> ResponseBasis::of(const std::vector<FacetOptics>& indices, double tolerance,
                                                       std::size_t passes) {
  const std::vector<FacetOptics> tried = candidate_indices(indices, kMostTried);
  const double indices_per_candidate = static_cast<double>(indices.size()) / static_cast<double>(tried.size());
  std::shared_ptr<ResponseBasis> basis(new ResponseBasis);
  basis->tolerance_ = tolerance;
  double least = static_cast<double>(indices.size()) / kLeastGain;
  for (const double c0 : kScales) {
    std::vector<std::size_t> counts;
    for (const FacetOptics& index : tried) counts.push_back(needed(index, c0, tolerance));
    for (const std::size_t count : kCounts) {
      const auto left = static_cast<double>(std::ranges::count_if(counts, [&](auto own) { return own > count; }));
      const double time = static_cast<double>(passes) * (1.0 + kTimeOfResponse * static_cast<double>(count)) +
                          left * indices_per_candidate;
      if (time >= least) continue;
      least = time;
      basis->count_ = count;
      basis->c0_ = c0;
    }
  }
  if (basis->count_ == 0) return nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  basis->bend_ = basis->c0_;
  for (const FacetOptics& index : candidate_indices(indices, kMostCandidates)) {
    if (needed(index, basis->c0_, tolerance) > basis->count_) continue;
    basis->bend_ = std::min(basis->bend_, distance_of_bend(index));
    // The reference must not have total reflection, which would enlarge the error bounds of all responses.
    if (critical_cosine(index) > 0.0 || reflectance_level(index) >= lowest) continue;
    lowest = reflectance_level(index);
    basis->reference_ = index;
  }
  if (std::isinf(lowest)) return nullptr;
  basis->reference_weights_ = *basis->find_weights(basis->reference_);
  return basis;
}

std::optional<ResponseWeights> ResponseBasis::find_weights(const FacetOptics& index) const {
  const CurveCoefficients all = curve_coefficients(index, c0_);
  const auto count = static_cast<Eigen::Index>(count_);
  const Eigen::RowVector2d errors = tail_errors(all, count);
  if (!(errors.maxCoeff() <= kReach * tolerance_ * reflectance_level(index))) return std::nullopt;
  return ResponseWeights{all.col(0).head(count), all.col(1).head(count), errors[0], errors[1]};
}

}  // namespace dolp
