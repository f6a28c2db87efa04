#include "reference/reference_evaluator.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>
#include <string>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "base/processor.hpp"
#include "base/stopwatch.hpp"
#include "model/angles.hpp"
#include "model/sky_basis.hpp"
#include "reference/mueller.hpp"

namespace dolp {

namespace {

constexpr std::size_t kEntriesAtOnce = 1;  // an entry may take seconds

void require(bool is_met, const std::string& what, double value) {
  if (!is_met) throw InputError("reference: " + what + ", but it is " + std::to_string(value));
}

void check_zenith(double theta_deg) {
  require(theta_deg >= 0.0 && theta_deg <= 90.0, "theta must be in [0, 90] degrees", theta_deg);
}

void check_shape(Distribution distribution, Masking masking, const SlopeShape& shape) {
  const bool is_cauchy = distribution == Distribution::kCauchy;
  require(shape.sigma >= 0.0, "sigma must not be negative", shape.sigma);
  require(!is_cauchy || shape.q > 1.0, "q must be above 1", shape.q);
  require(!is_cauchy || masking != Masking::kSmith || shape.q > 1.5, "smith masking needs q above 1.5", shape.q);
  require(shape.sigma_cross >= 0.0, "sigma_cross must not be negative", shape.sigma_cross);
  if (!is_elliptic(shape)) return;
  require(shape.sigma > 0.0, "sigma must be above 0 with sigma_cross", shape.sigma);
  if (masking == Masking::kIntegral) {
    throw InputError("reference: a sigma_cross other than sigma needs masking none, v-cavity or smith");
  }
}

void check_index(const FacetOptics& optics) {
  const OpticalConstants& index = optics.index;
  require(index.n > 0.0, "n must be above 0", index.n);
  require(index.k >= 0.0, "k must not be negative", index.k);
}

void check_scattering(Scattering scattering, Masking masking) {
  if (scattering == Scattering::kMultiple && masking != Masking::kVCavity) {
    throw InputError("reference: multiple scattering needs v-cavity masking");
  }
}

void check(const MomentsRequest& request) {
  const bool has_sky_responses = request.response && request.response->of == Response::Of::kSky;
  if (request.response && (has_sky_responses || request.response->count != reference::kCurves))
    throw InputError("reference: responses must be 24, and without a sky");
  check_scattering(request.scattering, request.masking);
  const bool has_view_masking = request.masking == Masking::kVCavity || request.masking == Masking::kSmith;
  if (request.wants_direct && !has_view_masking) {
    throw InputError("reference: direct emission needs v-cavity or smith masking");
  }
  if (request.has_only_direct() && !request.wants_direct) {
    throw InputError("reference: smith masking with a sigma_cross other than sigma has direct emission only");
  }
  for (const double theta_deg : request.theta_deg) check_zenith(theta_deg);
  for (const SlopeShape& shape : request.shapes) check_shape(request.distribution, request.masking, shape);
  for (const FacetOptics& index : request.optics) check_index(index);
}

void check(const ScatteringRequest& request) {
  check_scattering(request.scattering, request.masking);
  for (const BeamAngles& angles : request.angles) {
    check_zenith(angles.theta_i_deg);
    check_zenith(angles.theta_r_deg);
  }
  for (const SlopeShape& shape : request.shapes) {
    check_shape(request.distribution, request.masking, shape);
    require(shape.sigma > 0.0, "sigma must be above 0", shape.sigma);
    if (request.masking == Masking::kSmith && is_elliptic(shape))
      throw InputError("reference: beams with a sigma_cross other than sigma need masking none or v-cavity");
  }
  for (const FacetOptics& index : request.optics) check_index(index);
}

Moments mirror_point(const MomentsRequest& request, const MomentsPoint& point) {
  Moments m = reference::mirror_moments(point.theta_deg, point.index);
  if (!request.sky) return m;
  for (const double g : request.sky->at(point.theta_deg)) m.columns.push_back({g * m.r_i, g * m.r_q, m.r_i_error});
  return m;
}

/// Responses: the moments with Chebyshev polynomials instead of the reflectances.
std::vector<ColumnMoments> response_columns(const MomentsRequest& request, const MomentsPoint& point,
                                            const reference::Slopes& slopes, const reference::Refinement& refinement) {
  const double c0 = request.response->c0;
  const reference::Curves curves = [c0](double cos_beta) {
    const double angle = std::acos(std::clamp(2.0 * std::asinh(cos_beta / c0) / std::asinh(1.0 / c0) - 1.0, -1.0, 1.0));
    std::array<double, reference::kCurves> polynomials{};
    for (std::size_t m = 0; m < polynomials.size(); ++m) polynomials[m] = std::cos(static_cast<double>(m) * angle);
    return polynomials;
  };
  if (request.response->of != Response::Of::kDirect)
    return reference::hemisphere_responses(slopes, request.masking, point.theta_deg, curves, c0, refinement);
  std::vector<ColumnMoments> columns;
  for (std::size_t m = 0; m < reference::kCurves; ++m) {
    const Moments direct = reference::direct_response(
        slopes, request.masking, point.theta_deg, [&](double cos_beta) { return curves(cos_beta)[m]; }, c0, refinement);
    columns.push_back({direct.direct_i, direct.direct_q, std::max(direct.direct_i_error, direct.direct_q_error)});
  }
  return columns;
}

Moments point_moments(const MomentsRequest& request, const MomentsPoint& point,
                      const reference::Refinement& refinement) {
  if (point.shape.sigma == 0.0) return mirror_point(request, point);
  const reference::Slopes slopes(request.distribution, point.shape);
  const auto integrate = [&](const SkyFunction* sky) {
    return request.scattering == Scattering::kSingle
               ? reference::hemisphere_moments(slopes, request.masking, point.theta_deg, point.index, refinement, sky)
               : reference::groove_moments(slopes, point.theta_deg, point.index, refinement, sky);
  };
  if (request.has_only_direct()) {
    Moments m = reference::direct_emission(slopes, request.masking, point.theta_deg, point.index, refinement);
    m.deficit = cos_sin_deg(point.theta_deg).cos;
    return m;
  }
  Moments m = request.sky ? Moments{} : integrate(nullptr);
  // Integrates once for each function of the sky. Each integration also computes the moments again.
  for (std::size_t k = 0; request.sky && k < request.sky->size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const SkyFunction sky{[&](double zenith_deg) { return request.sky->at(zenith_deg)[column]; },
                          request.sky->nodes().ends_deg()};
    Moments with = integrate(&sky);
    std::vector<ColumnMoments> all = std::move(m.columns);
    all.push_back(with.columns.empty() ? ColumnMoments{} : with.columns.front());
    with.evaluations += m.evaluations;
    m = std::move(with);
    m.columns = std::move(all);
  }
  if (request.wants_direct) {
    const Moments direct =
        reference::direct_emission(slopes, request.masking, point.theta_deg, point.index, refinement);
    m.direct_i = direct.direct_i;
    m.direct_q = direct.direct_q;
    m.direct_u = direct.direct_u;
    m.direct_i_error = direct.direct_i_error;
    m.direct_q_error = direct.direct_q_error;
    m.evaluations += direct.evaluations;
  }
  if (request.response) m.columns = response_columns(request, point, slopes, refinement);
  return m;
}

ScatteringMatrix scattering_matrix(const ScatteringRequest& request, const ScatteringEntry& entry) {
  const BeamAngles& angles = request.angles.at(entry.angles);
  const reference::Slopes slopes(request.distribution, request.shapes.at(entry.shape));
  const FacetOptics& index = request.optics.at(entry.index);
  const reference::BouncesSum f =
      request.scattering == Scattering::kMultiple
          ? reference::all_bounces(slopes, index, angles)
          : reference::BouncesSum{reference::single_bounce(slopes, request.masking, index, angles), 0.0};
  ScatteringMatrix matrix;
  std::ranges::copy(f.matrix.reshaped<Eigen::RowMajor>(), matrix.m.begin());
  matrix.error = f.error + kScatteringError * std::abs(matrix.m[0]);
  return matrix;
}

}  // namespace

void ReferenceEvaluator::note(double seconds) {
  report_.evaluator = "reference";
  report_.device = processor_name();
  report_.precision = "double";
  report_.kernel_s += seconds;
}

TransmissionIntegral ReferenceEvaluator::transmission() const { return reference::transmission_integral; }

std::vector<Moments> ReferenceEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  check(request);
  const auto start = std::chrono::steady_clock::now();
  reference::Refinement refinement = refinement_;
  if (request.tolerance > 0.0) {
    const double wanted = std::max(refinement_.relative_tolerance, 0.01 * request.tolerance);
    refinement.relative_tolerance = std::min(0.5 * request.tolerance, wanted);
  }
  std::vector<Moments> results(request.size());
  const auto compute = [&](std::size_t i) { results[i] = point_moments(request, request[i], refinement); };
  parallel_for(results.size(), kEntriesAtOnce, compute, progress);
  for (const Moments& moments : results) report_.evaluations += moments.evaluations;
  note(seconds_since(start));
  return results;
}

std::vector<ScatteringMatrix> ReferenceEvaluator::scatter(const ScatteringRequest& request, const Progress& progress) {
  check(request);
  const auto start = std::chrono::steady_clock::now();
  std::vector<ScatteringMatrix> results(request.entries.size());
  const auto compute = [&](std::size_t i) { results[i] = scattering_matrix(request, request.entries[i]); };
  parallel_for(results.size(), kEntriesAtOnce, compute, progress);
  note(seconds_since(start));
  return results;
}

}  // namespace dolp
