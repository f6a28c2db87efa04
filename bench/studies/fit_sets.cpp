#include "studies/fit_sets.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <dolp/errors.hpp>
#include <random>

#include "base/stopwatch.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::bench {
namespace {

constexpr std::size_t kPoints = 12;
constexpr double kFirstDeg = 2.0;
constexpr double kLastDeg = 80.0;         // at larger zeniths `integral` masking can make I zero and Q/I infinite
constexpr double kExactTolerance = 1e-8;  // tolerance of the data before noise is added
constexpr double kSameObjective = 0.01;   // minima with a smaller difference of chi^2 count as equal

constexpr const char* kSceneText = R"([surface]
n = 1.5
k = 0.1
sigma = 0.2
q = 3
[emission]
temperature_K = 300
[surroundings]
temperature_K = 200
[spectrum]
wavelength_um = 10
[accuracy]
precision = "auto"
)";

/// Uniform and normal random numbers, with the same values in every standard library.
class Random {
 public:
  explicit Random(std::size_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
  double normal() {  // method of Box and Muller
    constexpr double kTwoPi = 6.283185307179586;
    const double radius = std::sqrt(-2.0 * std::log1p(-unit()));
    return radius * std::cos(kTwoPi * unit());
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  std::mt19937_64 engine_;
};

/// A parameter with the range that the fit searches, and the limits of its random true value.
struct Choice {
  FitRange parameter;
  double least, most;
};

const Choice kN = {{"surface.n", 1.05, 6.0, {}}, 1.3, 2.5};
const Choice kK = {{"surface.k", 0.0, 6.0, {}}, 0.3, 2.0};
const Choice kSigma = {{"surface.sigma", 0.01, 1.5, {}}, 0.08, 0.4};
const Choice kQ = {{"surface.q", 1.6, 50.0, {}}, 2.0, 4.0};
const Choice kSky = {{"surroundings.temperature_K", 0.0, 290.0, {}}, 150.0, 230.0};
const Choice kSpecular = {{"surface.specular", 0.1, 1.0, {}}, 0.6, 0.9};

}  // namespace

std::string FitSet::keys() const {
  std::string text;
  for (const FitRange& parameter : parameters) text += (text.empty() ? "" : " ") + parameter.key;
  return text;
}

FitSet fit_set(std::size_t number) {
  static constexpr std::array<const char*, 4> kMaskings = {"smith", "v-cavity", "integral", "none"};
  static constexpr std::array<const char*, 2> kDistributions = {"cauchy", "gaussian"};
  static const std::array<std::vector<Choice>, 6> varied_choices = {
      {{kN, kSigma}, {kN, kK}, {kN, kK, kSigma}, {kN, kSigma, kQ}, {kN, kSigma, kSpecular}, {kN, kK, kSigma, kSky}}};
  Random random(number);
  FitSet set;
  const std::size_t distribution = random.below(kDistributions.size());
  std::size_t varied = random.below(varied_choices.size());
  if (distribution == 1 && varied == 3) varied = 2;  // Gaussian slopes have no q
  set.scene = parse_scene(kSceneText, "synthetic",
                          {{"surface.masking", kMaskings[random.below(kMaskings.size())]},
                           {"surface.distribution", kDistributions[distribution]}});
  set.truth.resize(static_cast<Eigen::Index>(varied_choices[varied].size()));
  for (std::size_t j = 0; j < varied_choices[varied].size(); ++j) {
    const Choice& choice = varied_choices[varied][j];
    set.parameters.push_back(choice.parameter);
    set.truth[static_cast<Eigen::Index>(j)] = random.uniform(choice.least, choice.most);
  }
  set.observable = random.below(2) == 0 ? Observable::kQOverI : Observable::kDolp;
  set.points = kPoints;
  set.uncertainty = random.log_uniform(5e-4, 1e-2);
  return set;
}

FitSet bracket_set(std::size_t number) {
  Random random(number);
  FitSet set;
  set.scene = parse_scene(kSceneText, "synthetic", {{"surface.masking", TomlText{"v-cavity"}}, {"surface.k", 0.05}});
  set.of_truth = {{"surface.scattering", TomlText{"multiple"}}};
  set.truth = Eigen::Vector2d(random.uniform(1.3, 2.5), random.uniform(0.1, 0.4));
  set.parameters = {{"surface.n", 1.1, 3.0, {}}, {"surface.sigma", 0.02, 1.0, {}}};
  set.points = 15;
  set.uncertainty = 5e-4;
  set.has_noise = number % 2 == 1;
  set.model_error = ModelError::kBracket;
  return set;
}

FitSet timed_set() {
  FitSet set;
  set.scene = parse_scene(kSceneText, "synthetic", {{"surface.masking", "smith"}});
  set.truth = Eigen::Vector3d(1.6, 0.5, 0.2);
  set.parameters = {kN.parameter, kK.parameter, kSigma.parameter};
  set.points = 40;
  set.uncertainty = 2e-3;
  return set;
}

MeasuredData synthetic_data(const FitSet& set, std::size_t number, ModelEvaluator& evaluator) {
  MeasuredData data;
  data.name = "synthetic";
  data.zenith_column = "theta_deg";
  data.has_uncertainties = true;
  for (std::size_t i = 0; i < set.points; ++i) {
    const double share = static_cast<double>(i) / (static_cast<double>(set.points) - 1.0);
    data.measurements.push_back({.observable = set.observable,
                                 .theta_deg = kFirstDeg + share * (kLastDeg - kFirstDeg),
                                 .uncertainty = set.uncertainty});
  }
  const fit::Model model(with_settings(set.scene, set.of_truth), {data}, set.parameters);
  const Eigen::MatrixX2d exact = model.predict({set.truth}, kExactTolerance, evaluator, {}).front().components;
  Random random(number + 1'000'000);
  for (std::size_t i = 0; i < set.points; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double value = set.observable == Observable::kDolp ? exact.row(row).norm() : exact(row, 0);
    data.measurements[i].value = value + (set.has_noise ? set.uncertainty * random.normal() : 0.0);
  }
  return data;
}

bool SetOutcome::is_global() const { return result.chi_square <= chi_square_from_truth + kSameObjective; }

bool SetOutcome::is_consistent() const {
  constexpr double kRise68 = 1.0;
  constexpr double kRise95 = 3.8415;
  const double growth = chi_square_of_truth - result.chi_square + kSameObjective;
  const std::size_t all = result.parameters.size();
  return (growth > kRise68 || held_68 == all) && (growth > kRise95 || held_95 == all);
}

SetOutcome fit_outcome(const FitSet& set, std::size_t number, ModelEvaluator& evaluator) {
  const MeasuredData data = synthetic_data(set, number, evaluator);
  const fit::Model model(set.scene, {data}, set.parameters, set.model_error);
  SetOutcome outcome;
  const auto start = std::chrono::steady_clock::now();
  std::optional<fit::FitResult> result = fit::fit(model, evaluator, {});
  outcome.time_s = seconds_since(start);
  if (!result) throw InputError(fmt::format("set {}: no minimum was found", number));
  outcome.result = std::move(*result);
  for (std::size_t j = 0; j < set.parameters.size(); ++j) {
    const FitParameter& fitted = outcome.result.parameters[j];
    const double truth = set.truth[static_cast<Eigen::Index>(j)];
    const auto holds = [&](const FitInterval& interval) {
      return (!interval.low || *interval.low <= truth) && (!interval.high || truth <= *interval.high);
    };
    outcome.held_68 += holds(fitted.interval_68) ? 1 : 0;
    outcome.held_95 += holds(fitted.interval_95) ? 1 : 0;
  }
  fit::Residuals residuals(model, evaluator, {outcome.result.tolerance, fit::Differences::kCentral});
  Eigen::VectorXd truth = set.truth;
  for (std::size_t j = 0; j < set.parameters.size(); ++j) {
    truth[static_cast<Eigen::Index>(j)] = set.parameters[j].coordinate(truth[static_cast<Eigen::Index>(j)]);
  }
  std::vector<fit::Minimum> from_truth = {{.where = residuals.at({truth}).front()}};
  outcome.chi_square_of_truth = from_truth.front().where.residuals.squaredNorm();
  fit::descend(residuals, from_truth, {});
  outcome.chi_square_from_truth = from_truth.front().objective();
  return outcome;
}

}  // namespace dolp::bench
