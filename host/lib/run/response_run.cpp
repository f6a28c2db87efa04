#include "run/response_run.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <dolp/errors.hpp>
#include <limits>
#include <numbers>

#include "base/stopwatch.hpp"
#include "model/angles.hpp"
#include "model/direction.hpp"
#include "model/response_basis.hpp"
#include "plan/constants.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"
#include "run/closed_forms.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "table/table_file.hpp"
#include "table/table_output.hpp"

namespace dolp {
namespace {

constexpr std::size_t kBetaAngles = kMostResponses;
constexpr double kResponseC0 = 0.01;                // cosine at which the polynomials bend
constexpr OpticalConstants kUnusedIndex{1.5, 0.0};  // moments of it come along unused; its rules bend nowhere
constexpr double kFinerBy = 0.01;                   // chosen: of a rule to the next
constexpr int kMostLevels = 5;
constexpr std::size_t kColumnsAtOnce = std::size_t{1} << 20U;  // for the memory that they take

/// The abscissa of the polynomials, in [-1, 1].
double abscissa(double cosine) { return 2.0 * std::asinh(cosine / kResponseC0) / std::asinh(1.0 / kResponseC0) - 1.0; }

/// T_m(x), m < kBetaAngles. Domain: x in [-1, 1].
Eigen::VectorXd chebyshev_at(double x) {
  const double angle = std::acos(std::clamp(x, -1.0, 1.0));
  return Eigen::VectorXd::NullaryExpr(kBetaAngles,
                                      [&](Eigen::Index m) { return std::cos(static_cast<double>(m) * angle); });
}

/// The angles of a table.
struct Nodes {
  Eigen::MatrixXd weights;  ///< nodes x polynomials: turn sums with polynomials into weights
  Eigen::ArrayXd sin2;      ///< of beta
  std::vector<double> x;
  std::vector<double> beta_deg;

  Nodes() : weights(kBetaAngles, kBetaAngles), sin2(kBetaAngles) {
    for (Eigen::Index j = 0; j < weights.rows(); ++j) {
      x.push_back(std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / kBetaAngles));
      const double cosine = kResponseC0 * std::sinh(0.5 * (1.0 + x.back()) * std::asinh(1.0 / kResponseC0));
      weights.row(j) = 2.0 / kBetaAngles * chebyshev_at(x.back()).transpose();
      sin2[j] = (1.0 - cosine) * (1.0 + cosine);
      beta_deg.push_back(std::acos(cosine) * 180.0 / std::numbers::pi);
    }
    weights.col(0) *= 0.5;
  }
};

const Nodes& nodes() {
  static const Nodes known;
  return known;
}

/// Weights of an entry, times cos(theta), and the bound of their sums.
struct Weights {
  Eigen::ArrayXd i, q;
  double error = 0.0;
};

/// The distances of the rules and all other errors, for curves with coefficients 2^-m. The rules of q may agree by
/// chance, so that i's bound is added to its own.
Weights weights_of(const std::vector<ColumnMoments>& columns) {
  Weights own{Eigen::ArrayXd::Zero(kBetaAngles), Eigen::ArrayXd::Zero(kBetaAngles)};
  for (std::size_t m = 0; m < columns.size(); ++m) {
    const ColumnMoments& column = columns[m];
    const Eigen::ArrayXd to_weights = nodes().weights.col(static_cast<Eigen::Index>(m));
    own.i += column.i * to_weights;
    own.q += column.q * to_weights / nodes().sin2;
    const double relative = column.relative_error * (2.0 * std::abs(column.i) + std::abs(column.q));
    own.error += std::ldexp(2.0 * std::abs(column.i_apart) + std::abs(column.q_apart) + 3.0 * column.error + relative,
                            -static_cast<int>(m));
  }
  return own;
}

/// The columns of a mirror: the polynomials at the direction itself.
std::vector<ColumnMoments> mirror_columns(const MomentsRequest& request, const Direction& direction,
                                          const SlopeShape& shape) {
  Surface surface;
  surface.distribution = request.distribution;
  const double error = closed_form(surface, direction, shape, kUnusedIndex, nullptr).albedo_error;
  const double sine = cos_sin_deg(direction.theta_deg).sin;
  std::vector<ColumnMoments> columns;
  for (const double polynomial : chebyshev_at(abscissa(direction.cos_theta))) {
    const double i = polynomial * direction.cos_theta;
    columns.push_back({.i = i, .q = sine * sine * i, .error = error});
  }
  return columns;
}

void store(const Weights& weights, double cosine, std::size_t entry, ResponseVariable of_i, ResponseVariable of_q,
           EntryResponses& to) {
  const auto at = static_cast<std::ptrdiff_t>(entry * kBetaAngles);
  Eigen::Map<Eigen::ArrayXd>(&to.responses[of_i][0] + at, kBetaAngles) = weights.i / cosine;
  Eigen::Map<Eigen::ArrayXd>(&to.responses[of_q][0] + at, kBetaAngles) = weights.q / cosine;
}

bool has_emission(Masking masking) { return keeps_projected_area(masking); }

/// Stores an entry where its bound is below the one that is there.
void take_better(const std::vector<ColumnMoments>& reflected, const std::vector<ColumnMoments>* direct, double cosine,
                 std::size_t entry, EntryResponses& to) {
  const Weights weights = weights_of(reflected);
  const Weights emitted = direct ? weights_of(*direct) : Weights{};
  const double error = std::max(weights.error, emitted.error) / cosine;
  double& known = to.responses[ResponseVariable::kResponseError][entry];
  if (!(error < known)) return;
  known = error;
  to.albedo[entry] = weights.i.sum() / cosine;
  store(weights, cosine, entry, ResponseVariable::kResponseI, ResponseVariable::kResponseQ, to);
  if (direct) store(emitted, cosine, entry, ResponseVariable::kEmissionI, ResponseVariable::kEmissionQ, to);
}

EntryResponses nothing_of(const MomentsRequest& request) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EntryResponses none;
  for (const ResponseVariable variable : kAllResponseVariables) {
    const bool is_emission = variable == ResponseVariable::kEmissionI || variable == ResponseVariable::kEmissionQ;
    if (is_emission && !has_emission(request.masking)) continue;
    none.responses[variable].assign(request.size() * (description_of(variable).has_beta ? kBetaAngles : 1), kNan);
  }
  none.albedo.assign(request.size(), kNan);
  return none;
}

/// Sets the entries without an evaluator: mirrors, and where rho has no value. Returns flags of the others.
std::vector<char> set_closed_forms(const MomentsRequest& request, EntryResponses& to) {
  std::vector<char> wanted(request.size(), 1);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const MomentsPoint point = request[i];
    const Direction direction = direction_of(request.distribution, request.masking, point.theta_deg, point.shape);
    wanted[i] = direction.treatment == Treatment::kIntegrated && direction.cos_theta > 0.0 ? 1 : 0;
    double& error = to.responses[ResponseVariable::kResponseError][i];
    if (wanted[i] != 0 || direction.treatment == Treatment::kMirror) error = std::numeric_limits<double>::infinity();
    if (direction.treatment != Treatment::kMirror) continue;
    const std::vector<ColumnMoments> columns = mirror_columns(request, direction, point.shape);
    take_better(columns, has_emission(request.masking) ? &columns : nullptr, direction.cos_theta, i, to);
  }
  return wanted;
}

bool misses(const EntryResponses& of, std::size_t entry, double tolerance) {
  return of.responses[ResponseVariable::kResponseError][entry] > tolerance * of.albedo[entry] ||
         std::isinf(of.responses[ResponseVariable::kResponseError][entry]);
}

}  // namespace

TableLayout response_layout(const SceneValues& scene) {
  if (scene.surface.scattering != Scattering::kSingle)
    throw InputError(
        fmt::format("{}: surface.scattering = \"multiple\": must be \"single\" for a response table, because "
                    "the reflectances of several bounces multiply",
                    scene.path_name));
  TableLayout layout = table_layout(scene, {}, scene.grid);
  layout.head.index_n = layout.head.index_k = {};
  layout.head.beta_deg = nodes().beta_deg;
  layout.head.attributes.push_back({"c0", kResponseC0});
  layout.head.attributes.push_back(
      {"comment",
       "With the reflectances r_s and r_p of a facet at the angles beta, k_s = 1 and no diffuse part: rho_i = sum over "
       "beta of response_i (r_s + r_p) / 2, rho_q = sum over beta of response_q (r_s - r_p) / 2. Let a_m and b_m be "
       "the "
       "coefficients of Chebyshev polynomials of x = 2 asinh(cos(beta) / c0) / asinh(1 / c0) - 1 in (r_s + r_p) / 2 "
       "and "
       "in (r_s - r_p) / (2 sin(beta)^2). The errors are at most response_error times the largest of |a_m| 2^m and "
       "|b_m| "
       "2^m, m < 24, which is about 1 for bare materials; what these sums over m leave out of the curves comes on "
       "top."});
  layout.quantities = {Quantity::kAlbedo};
  layout.has_status = false;
  layout.responses = {ResponseVariable::kResponseI, ResponseVariable::kResponseQ};
  if (has_emission(scene.surface.masking))
    layout.responses.insert(layout.responses.end(), {ResponseVariable::kEmissionI, ResponseVariable::kEmissionQ});
  layout.responses.push_back(ResponseVariable::kResponseError);
  return layout;
}

MomentsRequest response_request(const Surface& surface) {
  MomentsRequest request;
  request.distribution = surface.distribution;
  request.masking = surface.masking;
  request.may_interpolate = false;
  request.response = {.count = kBetaAngles, .c0 = kResponseC0, .bend = kResponseC0};
  request.indices = {kUnusedIndex};
  return request;
}

double response_distance(std::span<const double> a, std::span<const double> b, bool is_of_q) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(kBetaAngles);
  for (std::size_t j = 0; j < a.size(); ++j) {
    const double sin2 = nodes().sin2[static_cast<Eigen::Index>(j)];
    sums += (a[j] - b[j]) * (is_of_q ? sin2 : 1.0) * chebyshev_at(nodes().x[j]);
  }
  double distance = 0.0;
  for (Eigen::Index m = 0; m < sums.size(); ++m) distance += std::ldexp(std::abs(sums[m]), -static_cast<int>(m));
  return distance;
}

EntryResponses responses_of(MomentsRequest request, const Accuracy& accuracy, ModelEvaluator& evaluator,
                            const Progress& progress) {
  EntryResponses all = nothing_of(request);
  request.wanted = set_closed_forms(request, all);
  for (double& theta : request.theta_deg) theta = zenith_before_limit_deg(request.masking, theta);
  const bool wants_direct = has_emission(request.masking);
  request.precision = first_level(accuracy, evaluator.has_double()).precision;
  request.tolerance = accuracy.tolerance;
  double share = kResponseTolerance;
  for (int level = 0; level < kMostLevels && request.wanted_count() > 0; ++level, share *= kFinerBy) {
    const auto evaluated = [&](Response::Of of) {
      MomentsRequest pass = request;
      pass.tolerance = request.finer_tolerance(share);
      pass.wants_direct = of == Response::Of::kDirect;
      pass.response->of = of;
      const std::size_t size = request.size();
      return evaluator.evaluate(pass, [&, size](std::size_t done, std::size_t total) {
        const std::size_t own = size * done / std::max<std::size_t>(total, 1);
        const std::size_t half = pass.wants_direct ? (size + own) / 2 : wants_direct ? own / 2 : own;
        return !progress || progress(level == 0 ? half : size, size);
      });
    };
    const std::vector<Moments> reflected = evaluated(Response::Of::kReflected);
    const std::vector<Moments> direct = wants_direct ? evaluated(Response::Of::kDirect) : std::vector<Moments>();
    for (std::size_t i = 0; i < reflected.size(); ++i) {
      if (!request.is_wanted(i)) continue;
      const double cosine = cos_sin_deg(request[i].theta_deg).cos;
      take_better(reflected[i].columns, wants_direct ? &direct[i].columns : nullptr, cosine, i, all);
      request.wanted[i] = misses(all, i, accuracy.tolerance) ? 1 : 0;
    }
    if (accuracy.precision != Precision::kFloat && evaluator.has_double()) request.precision = Precision::kDouble;
  }
  return all;
}

ResponseOutcome run_responses(const SceneValues& scene, const TableLayout& layout, ModelEvaluator& evaluator,
                              const Progress& progress, const TakePart& take) {
  const auto start = std::chrono::steady_clock::now();
  const Axes& axes = layout.head.axes;
  ResponseOutcome outcome;
  const std::size_t of_theta = axes[Axis::kSigma].size() * axes[Axis::kQ].size();
  const std::size_t at_once = std::max<std::size_t>(1, kColumnsAtOnce / (kBetaAngles * of_theta));
  begin(progress, layout.head.size());
  for (std::size_t first = 0; first < axes[Axis::kTheta].size(); first += at_once) {
    TableBox box{{}, layout.head.counts()};
    box.first[Axis::kTheta] = first;
    box.count[Axis::kTheta] = std::min(at_once, axes[Axis::kTheta].size() - first);
    TableValues part;
    static_cast<TableHead&>(part) = head_of(layout.head, box);
    MomentsRequest request = response_request(scene.surface);
    request.theta_deg = part.axes[Axis::kTheta];
    request.sigma = part.axes[Axis::kSigma];
    request.q = part.axes[Axis::kQ];
    EntryResponses of_part = responses_of(request, scene.accuracy, evaluator, [&](std::size_t done, std::size_t) {
      return !progress || progress(outcome.entries + done, layout.head.size());
    });
    for (std::size_t i = 0; i < part.size(); ++i) {
      const double relative = of_part.responses[ResponseVariable::kResponseError][i] / of_part.albedo[i];
      outcome.missed += misses(of_part, i, scene.accuracy.tolerance) ? 1 : 0;
      if (relative > outcome.worst_error) outcome.worst_error = relative;
    }
    outcome.entries += part.size();
    part.responses = std::move(of_part.responses);
    part[Quantity::kAlbedo] = std::move(of_part.albedo);
    take(std::move(part), box.first);
  }
  outcome.evaluation = evaluator.report();
  outcome.wall_s = seconds_since(start);
  return outcome;
}

std::vector<Attribute> attributes_of(const SceneValues& scene, const ResponseOutcome& run,
                                     const std::string& command_line) {
  const EvaluationReport& evaluation = run.evaluation;
  return {{"history", history_text(command_line)},
          {"device", evaluation.device},
          {"driver", evaluation.driver},
          {"evaluator", evaluation.evaluator},
          {"precision", evaluation.precision},
          {"rule", rule_text(scene.accuracy.tolerance, evaluation)},
          {"wall_time_s", run.wall_s}};
}

void check_response_path(const std::filesystem::path& path) {
  if (path.extension() != ".nc") throw InputError(path.string() + ": the name of a response table must end in .nc");
  check_output_path(path);
}

ResponseOutcome write_responses(const SceneValues& scene, const TableLayout& layout, const std::filesystem::path& path,
                                const RunOptions& options, ModelEvaluator& evaluator) {
  TableOutput output({.path = path, .layout = layout});
  const ResponseOutcome outcome =
      run_responses(scene, layout, evaluator, options.progress,
                    [&](TableValues part, const PerAxis& first) { output.write(std::move(part), first, ""); });
  output.finish(attributes_of(scene, outcome, options.history));
  return outcome;
}

}  // namespace dolp
