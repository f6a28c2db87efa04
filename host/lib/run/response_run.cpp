#include "run/response_run.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <dolp/errors.hpp>
#include <limits>
#include <numbers>

#include "base/hash.hpp"
#include "base/stopwatch.hpp"
#include "evaluate/planned_moments.hpp"
#include "model/angles.hpp"
#include "model/direction.hpp"
#include "model/response_basis.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"
#include "run/closed_forms.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"

namespace dolp {
namespace {

constexpr std::size_t kBetaAngles = kMostResponses;
constexpr double kResponseC0 = 0.01;  // cosine near which abscissa() changes from linear to logarithmic
// The first quadrature has the tolerance of the table times this factor. Tuned for 64 x 16 x 16 entries at the
// tolerance 1e-4. Million evaluations at half this value, at this value and at double: 21.0, 22.5, 24.1 with smith
// masking; 3.24, 3.00, 2.90 with integral masking.
constexpr double kFirstShare = 0.1;
// Each refinement level has the tolerance of the level before times this factor. Half or twice the factor is as good.
constexpr double kFinerBy = 0.03;
constexpr int kMostLevels = 6;
constexpr std::size_t kColumnsAtOnce = std::size_t{1} << 20U;  // moments computed at once; this limits the memory

/// The variable x of the Chebyshev polynomials: -1 at cos(beta) = 0, 1 at cos(beta) = 1.
double abscissa(double cosine) { return 2.0 * std::asinh(cosine / kResponseC0) / std::asinh(1.0 / kResponseC0) - 1.0; }

Eigen::VectorXd chebyshev_at(double x) {
  const double angle = std::acos(std::clamp(x, -1.0, 1.0));
  return Eigen::VectorXd::LinSpaced(kBetaAngles, 0.0, kBetaAngles - 1.0).unaryExpr([=](double m) {
    return std::cos(m * angle);
  });
}

/// The angles of incidence beta at which a response table has weights, and functions of these angles.
struct Nodes {
  Eigen::MatrixXd polynomials;  ///< the Chebyshev polynomial T_m at angle j, in row m and column j
  Eigen::ArrayXd sin2;          ///< sin^2 of beta
  std::vector<double> beta_deg;

  Nodes() : polynomials(kBetaAngles, kBetaAngles), sin2(kBetaAngles) {
    for (Eigen::Index j = 0; j < sin2.size(); ++j) {
      const double x = std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / kBetaAngles);
      const double cosine = kResponseC0 * std::sinh(0.5 * (1.0 + x) * std::asinh(1.0 / kResponseC0));
      polynomials.col(j) = chebyshev_at(x);
      sin2[j] = (1.0 - cosine) * (1.0 + cosine);
      beta_deg.push_back(std::acos(cosine) * 180.0 / std::numbers::pi);
    }
  }
};

const Nodes& nodes() {
  static const Nodes known;
  return known;
}

/// Weights of an entry, times cos(theta). `error` bounds their response_distance() from the exact values.
struct Weights {
  Eigen::ArrayXd i, q;
  double error = 0.0;
};

/// Weights of an entry. `columns` are its moments with a Chebyshev polynomial T_m instead of the reflectance. The error
/// estimate i_apart of a column is the difference of two quadrature rules, which may be too small by chance. So the
/// bound of a column is at least `whole_error`, the bound for 1 instead of T_m, which holds because |T_m| <= 1.
Weights response_weights(const std::vector<ColumnMoments>& columns, double whole_error) {
  Weights own{Eigen::ArrayXd::Zero(kBetaAngles), Eigen::ArrayXd::Zero(kBetaAngles)};
  for (std::size_t m = 0; m < columns.size(); ++m) {
    const ColumnMoments& sum = columns[m];
    const Eigen::ArrayXd share =
        (m == 0 ? 1.0 : 2.0) / kBetaAngles * nodes().polynomials.row(static_cast<Eigen::Index>(m));
    own.i += sum.i * share;
    own.q += sum.q * share / nodes().sin2;
    // q_apart may be too small, too, and q has no bound like whole_error. So i and q get the sum of both bounds.
    const double i_error = std::abs(sum.i_apart) + sum.relative_error * std::abs(sum.i) + sum.error;
    const double q_error = std::abs(sum.q_apart) + sum.relative_error * std::abs(sum.q) + sum.error;
    own.error += std::ldexp(std::max(i_error, whole_error) + q_error, -static_cast<int>(m));
  }
  return own;
}

/// The moments of a mirror. They need no integral, because beta (the angle of incidence) is theta on all of the mirror.
Moments mirror_response(const MomentsRequest& request, const Direction& direction, const SlopeShape& shape) {
  Surface surface;
  surface.distribution = request.distribution;
  Moments mirror = closed_form(surface, direction, shape, kUnusedIndex, nullptr);
  const double sine = cos_sin_deg(direction.theta_deg).sin;
  for (const double polynomial : chebyshev_at(abscissa(direction.cos_theta))) {
    const double i = polynomial * direction.cos_theta;
    mirror.columns.push_back({.i = i, .q = sine * sine * i, .error = mirror.albedo_error});
  }
  return mirror;
}

bool has_emission(Masking masking) { return keeps_projected_area(masking); }

/// Stores the weights of an entry in `to` if they have a smaller error bound than the weights in `to`.
void take_better(const Moments& reflected, const Moments* direct, double cosine, std::size_t entry,
                 EntryResponses& to) {
  const Weights weights = response_weights(reflected.columns, reflected.albedo_error);
  const Weights emitted = direct ? response_weights(direct->columns, direct->direct_i_error) : Weights{};
  const double error = std::max(weights.error, emitted.error) / cosine;
  double& known = to.responses[ResponseVariable::kResponseError][entry];
  if (!(error < known)) return;
  known = error;
  to.albedo[entry] = weights.i.sum() / cosine;
  const auto store = [&](ResponseVariable variable, const Eigen::ArrayXd& values) {
    const auto at = to.responses[variable].begin() + static_cast<std::ptrdiff_t>(entry * kBetaAngles);
    std::ranges::transform(values, at, [&](double value) { return value / cosine; });
  };
  store(ResponseVariable::kResponseI, weights.i);
  store(ResponseVariable::kResponseQ, weights.q);
  if (!direct) return;
  store(ResponseVariable::kEmissionI, emitted.i);
  store(ResponseVariable::kEmissionQ, emitted.q);
}

EntryResponses empty_responses(const MomentsRequest& request) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EntryResponses none;
  for (const ResponseVariable variable : kAllResponseVariables) {
    const bool is_emission = variable == ResponseVariable::kEmissionI || variable == ResponseVariable::kEmissionQ;
    if (is_emission && !has_emission(request.masking)) continue;
    none.responses[variable].assign(request.size() * (describe(variable).has_beta ? kBetaAngles : 1), kNan);
  }
  none.albedo.assign(request.size(), kNan);
  return none;
}

/// Sets the weights of mirrors. Other weights stay NaN. Returns the entries that need the evaluator.
std::vector<std::size_t> set_closed_forms(const MomentsRequest& request, EntryResponses& to) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < request.size(); ++i) {
    const MomentsPoint point = request[i];
    const Direction direction = make_direction(request.distribution, request.masking, point.theta_deg, point.shape);
    const bool is_integrated = direction.treatment == Treatment::kIntegrated && direction.cos_theta > 0.0;
    if (is_integrated) wanted.push_back(i);
    double& error = to.responses[ResponseVariable::kResponseError][i];
    if (is_integrated || direction.treatment == Treatment::kMirror) error = std::numeric_limits<double>::infinity();
    if (direction.treatment != Treatment::kMirror) continue;
    const Moments mirror = mirror_response(request, direction, point.shape);
    take_better(mirror, has_emission(request.masking) ? &mirror : nullptr, direction.cos_theta, i, to);
  }
  return wanted;
}

bool misses(const EntryResponses& of, std::size_t entry, double tolerance) {
  const double error = of.responses[ResponseVariable::kResponseError][entry];
  return !std::isnan(error) && !(error <= tolerance * of.albedo[entry]);
}

/// The fingerprint of an entry of a response table, which has all other variables already.
double entry_fingerprint(const TableValues& table, const SceneEntry& entry, std::size_t i) {
  std::vector<double> numbers = {entry.theta_deg, entry.shape.sigma, entry.shape.q, table[Quantity::kAlbedo][i],
                                 table.responses[ResponseVariable::kResponseError][i]};
  for (const ResponseVariable variable : {ResponseVariable::kResponseI, ResponseVariable::kResponseQ}) {
    const auto weights = std::span(table.responses[variable]).subspan(i * kBetaAngles, kBetaAngles);
    numbers.insert(numbers.end(), weights.begin(), weights.end());
  }
  return response_fingerprint(numbers);
}

}  // namespace

double response_fingerprint(std::span<const double> numbers) {
  std::vector<double> plain(numbers.begin(), numbers.end());
  for (double& number : plain) {
    if (std::isnan(number)) number = std::numeric_limits<double>::quiet_NaN();  // files may store another NaN
  }
  constexpr int kUnusedBits = 64 - std::numeric_limits<double>::digits;
  return static_cast<double>(hashed(kHashStart, plain) >> kUnusedBits);
}

TableLayout response_layout(const SceneValues& scene) {
  if (scene.surface.scattering != Scattering::kSingle)
    throw InputError(
        fmt::format("{}: surface.scattering = \"multiple\": must be \"single\" for a response table, because "
                    "the reflectances of several bounces multiply",
                    scene.path_name));
  if (scene.surface.has_cross_slopes())
    throw InputError(
        fmt::format("{}: surface.sigma_cross and surface.wind_model = \"directional\" are not for response "
                    "tables, which hold for every azimuth",
                    scene.path_name));
  Axes axes;  // responses depend on no other axis
  for (const Axis axis : {Axis::kTheta, Axis::kSigma, Axis::kQ}) axes[axis] = scene.grid[axis];
  TableLayout layout = table_layout(scene, {}, axes);
  layout.head.labels = {};
  layout.head.index_n = layout.head.index_k = {};
  layout.head.beta_deg = nodes().beta_deg;
  layout.head.attributes.push_back({"c0", kResponseC0});
  layout.head.attributes.push_back(
      {"comment",
       "rho_i = sum over beta of response_i r, rho_q = sum over beta of response_q d, where r = (r_s + r_p) / 2 and "
       "d = (r_s - r_p) / 2 of a facet at the angle beta, k_s = 1, without a diffuse part. Let a_m and b_m, m < 24, be "
       "the coefficients of r and of d / sin(beta)^2 in Chebyshev polynomials of "
       "2 asinh(cos(beta) / c0) / asinh(1 / c0) - 1. The error of rho_i and rho_q is at most response_error times the "
       "largest 2^m |a_m| or 2^m |b_m|, which is about 1 for bare materials, plus what the polynomials leave out of r "
       "and d."});
  layout.quantities = {Quantity::kAlbedo};
  layout.has_status = false;
  layout.responses = {ResponseVariable::kResponseI, ResponseVariable::kResponseQ};
  if (has_emission(scene.surface.masking))
    layout.responses.insert(layout.responses.end(), {ResponseVariable::kEmissionI, ResponseVariable::kEmissionQ});
  layout.responses.insert(layout.responses.end(), {ResponseVariable::kResponseError, ResponseVariable::kFingerprint});
  return layout;
}

MomentsRequest response_request(const Surface& surface) {
  MomentsRequest request;
  request.distribution = surface.distribution;
  request.masking = surface.masking;
  request.response = {.count = kBetaAngles, .c0 = kResponseC0, .bend = kResponseC0};
  return request;
}

double response_distance(std::span<const double> a, std::span<const double> b, bool is_of_q) {
  using Values = Eigen::Map<const Eigen::ArrayXd>;
  Eigen::ArrayXd apart = Values(a.data(), kBetaAngles) - Values(b.data(), kBetaAngles);
  if (is_of_q) apart *= nodes().sin2;
  const Eigen::VectorXd sums = nodes().polynomials * apart.matrix();
  double distance = 0.0;
  for (Eigen::Index m = 0; m < sums.size(); ++m) distance += std::ldexp(std::abs(sums[m]), -static_cast<int>(m));
  return distance;
}

EntryResponses compute_responses(MomentsRequest request, const Accuracy& accuracy, ModelEvaluator& evaluator,
                                 const Progress& progress) {
  EntryResponses all = empty_responses(request);
  std::vector<std::size_t> wanted = set_closed_forms(request, all);
  const std::size_t size = request.size();
  for (double& theta : request.theta_deg) theta = zenith_before_limit_deg(request.masking, theta);
  const bool wants_direct = has_emission(request.masking);
  request.precision = first_level(accuracy, evaluator.has_double()).precision;
  request.may_interpolate = accuracy.may_interpolate && !evaluator.computes_each_entry();
  request.tolerance = accuracy.tolerance;
  Work host_work;
  double share = kFirstShare;
  for (int level = 0; level < kMostLevels && !wanted.empty(); ++level, share *= kFinerBy) {
    const auto evaluated = [&](Response::Of of) {
      MomentsRequest pass = request.select_entries(wanted);
      pass.tolerance = request.finer_tolerance(share);
      pass.wants_direct = of == Response::Of::kDirect;
      pass.response->of = of;
      const Progress pass_progress = [&](std::size_t done, std::size_t total) {
        const std::size_t own = size * done / std::max<std::size_t>(total, 1);
        const std::size_t half = pass.wants_direct ? (size + own) / 2 : wants_direct ? own / 2 : own;
        return !progress || progress(level == 0 ? half : size, size);
      };
      return planned_moments(MomentsPlan(pass), evaluator, pass_progress, host_work);
    };
    const PlannedMoments reflected = evaluated(Response::Of::kReflected);
    const PlannedMoments direct = wants_direct ? evaluated(Response::Of::kDirect) : PlannedMoments();
    MomentsReader reflected_reader(reflected), direct_reader(direct);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const double cosine = cos_sin_deg(request[wanted[i]].theta_deg).cos;
      const Moments* const own_direct = wants_direct ? &direct_reader.read(i, 1).front() : nullptr;
      take_better(reflected_reader.read(i, 1).front(), own_direct, cosine, wanted[i], all);
    }
    std::erase_if(wanted, [&](std::size_t i) { return !misses(all, i, accuracy.tolerance); });
    if (accuracy.precision != Precision::kFloat && evaluator.has_double()) request.precision = Precision::kDouble;
    request.may_interpolate = false;
  }
  return all;
}

ResponseOutcome run_responses(const SceneValues& scene, const TableLayout& layout, const RunOptions& options,
                              ModelEvaluator& evaluator, const TakePart& take) {
  const auto start = std::chrono::steady_clock::now();
  const Axes& axes = layout.head.axes;
  ResponseOutcome outcome;
  const std::size_t entries_per_theta = axes[Axis::kSigma].size() * axes[Axis::kQ].size();
  const std::size_t at_once = std::max<std::size_t>(1, kColumnsAtOnce / (kBetaAngles * entries_per_theta));
  const Progress& progress = options.progress;
  report_start(progress, layout.head.size());
  for (std::size_t first = 0; first < axes[Axis::kTheta].size(); first += at_once) {
    GridBox box{{}, layout.head.counts()};
    box.first[Axis::kTheta] = first;
    box.count[Axis::kTheta] = std::min(at_once, axes[Axis::kTheta].size() - first);
    TableValues part{part_head(layout.head, box)};
    MomentsRequest request = response_request(scene.surface);
    request.optics = {kUnusedIndex};
    request.theta_deg = part.axes[Axis::kTheta];
    request.shapes = shape_product(part.axes[Axis::kSigma], part.axes[Axis::kQ]);
    request.set_grid();
    EntryResponses computed = compute_responses(request, scene.accuracy, evaluator, [&](std::size_t done, std::size_t) {
      return !progress || progress(outcome.entries + done, layout.head.size());
    });
    for (std::size_t i = 0; i < part.size(); ++i) {
      const double relative = computed.responses[ResponseVariable::kResponseError][i] / computed.albedo[i];
      outcome.missed += misses(computed, i, scene.accuracy.tolerance) ? 1 : 0;
      if (relative > outcome.worst_error) outcome.worst_error = relative;
    }
    outcome.entries += part.size();
    part.responses = std::move(computed.responses);
    part[Quantity::kAlbedo] = std::move(computed.albedo);
    const SceneEntries entries = SceneEntries::grid(part.axes, kUnusedIndex);
    for (std::size_t i = 0; i < part.size(); ++i)
      part.responses[ResponseVariable::kFingerprint][i] = entry_fingerprint(part, entries[i], i);
    take(std::move(part), box.first);
  }
  const EvaluationReport& evaluation = outcome.evaluation = evaluator.report();
  outcome.wall_s = seconds_since(start);
  outcome.attributes = {{"history", history_text(options.history)},
                        {"device", evaluation.device},
                        {"driver", evaluation.driver},
                        {"evaluator", evaluation.evaluator},
                        {"precision", evaluation.precision},
                        {"rule", rule_text(scene.accuracy.tolerance, evaluation)},
                        {"wall_time_s", outcome.wall_s}};
  return outcome;
}

}  // namespace dolp
