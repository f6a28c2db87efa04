#include "run/derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <dolp/number_range.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "base/text.hpp"
#include "model/slopes.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_keys.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

constexpr double kStepTolerance = 1e-8;
constexpr double kStep = 0.01;  // the error of order h^4 and the bounds of the results over h are then similar
// A step is at least this share of the usual step. A shorter one would make the bounds of the results too large.
constexpr double kLeastStep = 1e-3;
constexpr const char* kThetaKey = "grid.theta_deg";
constexpr const char* kWavelengthKey = "spectrum.wavelength_um";

/// The axis on which the entries have the values of the key; nullopt if the scene has the value.
std::optional<Axis> key_axis(const SceneEntries& entries, const std::string& key) {
  const std::string axis_key = key == kWind.key ? describe(Axis::kSigma).key : key;
  for (const Axis axis : kAllAxes) {
    const bool is_axis = key == kThetaKey ? axis == Axis::kTheta : axis_key == describe(axis).key;
    if (is_axis && entries.has_values(axis)) return axis;
  }
  return std::nullopt;
}

bool has_wind(const SceneValues& scene) { return scene.surface.wind_m_s.has_value() || !scene.wind_m_s.empty(); }

bool is_scene_number(const SceneValues& scene, const SceneEntries& entries, const std::string& key) {
  const SceneKey* const known = find_scene_key(key);
  if (key == kThetaKey) return true;
  if (!known || known->description.type != Key::Type::kNumber || key.starts_with("accuracy.")) return false;
  const auto has_films = [](const SceneVariant& variant) { return !variant.films.empty(); };
  if (known->description.layer > 0 && std::ranges::any_of(entries.variants(), has_films)) return false;
  if (key == kWind.key) return has_wind(scene);
  if (key == "surface.sigma") return !has_wind(scene);
  if (key == "surface.sigma_cross" && scene.surface.sigma_cross == 0.0) return key_axis(entries, key).has_value();
  if (key == "surface.q" && scene.surface.distribution == Distribution::kGaussian) return false;
  return key_axis(entries, key) || known->value(scene);
}

/// The step from x. It is 0, which makes the derivative NaN, if x is outside the range or at one of its ends.
double step_at(double x, const NumberRange& range) {
  if (!range.contains(x)) return 0.0;
  const double size = std::min(std::max(std::abs(x), 1.0), x - range.min);
  return std::min(kStep * size, 0.5 * (range.max - x));
}

double wind_from_sigma(double sigma, WindModel model) {
  const double still = sigma_in_wind(0.0, model);
  const double unit = sigma_in_wind(1.0, model);
  return (sigma - still) * (sigma + still) / ((unit - still) * (unit + still));
}

NumberRange key_range(const SceneValues& scene, const std::string& key) {
  if (key == "surface.q" && scene.surface.needs_mean_slope()) return kSmithCauchyQRange;
  return find_scene_key(key)->description.range;
}

/// The results at x - h, x - h / 2, x, x + h / 2 and x + h, for a number x of the scene or of each entry.
constexpr std::array kFactors = {-1.0, -0.5, 0.0, 0.5, 1.0};
using StepResults = std::array<std::vector<PointResult>, kFactors.size()>;

class Steps {
 public:
  Steps(const SceneValues& scene, const SceneEntries& entries, const std::string& key)
      : scene_(scene), entries_(entries), key_(key), axis_(key_axis(entries, key)), range_(key_range(scene, key)) {
    if (key != kWavelengthKey) return;
    std::set<std::optional<std::uint32_t>> materials;
    for (const SceneVariant& variant : entries.variants()) materials.insert(variant.material);
    for (const std::optional<std::uint32_t>& material : materials) {
      const std::vector<double> kinks = kinks_um(with_variant(scene, {.material = material}));
      kinks_.insert(kinks.begin(), kinks.end());
    }
  }

  /// The step h of an entry.
  double step(const SceneEntry& entry) const { return step_from(value(entry)); }

  /// Keeps the values of an axis between the least and the largest value of the entries.
  void stay_on_axis() {
    double least = range_.max, largest = range_.min;
    for (const SceneEntry& entry : entries_.all()) {
      least = std::min(least, value(entry));
      largest = std::max(largest, value(entry));
    }
    range_ = {least, largest};
  }

  /// Nullopt if the scene cannot have a value, for example a wavelength at which n and k are unknown.
  std::optional<StepResults> results(ModelEvaluator& evaluator, const Progress& progress) const {
    StepResults all;
    try {
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = results_at(kFactors[i], evaluator, progress);
    } catch (const InputError&) {
      return std::nullopt;
    }
    return all;
  }

  bool is_on_axis() const { return axis_.has_value(); }

 private:
  double value(const SceneEntry& entry) const {
    return axis_ ? to_key(entries_.value(entry, *axis_)) : std::get<double>(*find_scene_key(key_)->value(scene_));
  }

  /// The step from x. It ends at the nearest kink, but not at one that is much nearer than the usual step.
  double step_from(double x) const {
    const double usual = step_at(x, range_);
    double step = usual;
    for (auto kink = kinks_.lower_bound(x - usual); kink != kinks_.end() && *kink < x + usual; ++kink) {
      const double distance = std::abs(*kink - x);
      if (distance >= kLeastStep * usual) step = std::min(step, distance);
    }
    return step;
  }

  std::vector<PointResult> results_at(double factor, ModelEvaluator& evaluator, const Progress& progress) const {
    const auto moved = [&](double x) { return x + factor * step_from(x); };
    SceneValues changed = axis_ ? scene_ : with_settings(scene_, {{key_, moved(value({}))}});
    changed.accuracy.tolerance = std::min(scene_.accuracy.tolerance, kStepTolerance);
    if (evaluator.has_double()) changed.accuracy.precision = Precision::kDouble;
    if (!axis_) return evaluate_scene(changed, entries_.with_slopes(changed.cross_slopes()), evaluator, progress);
    const auto change = [&](double own) { return from_key(moved(to_key(own))); };
    return evaluate_scene(changed, entries_.changed(*axis_, change), evaluator, progress);
  }

  double to_key(double own) const { return key_ == kWind.key ? wind_from_sigma(own, scene_.surface.wind_model) : own; }
  double from_key(double value) const {
    return key_ == kWind.key ? sigma_in_wind(value, scene_.surface.wind_model) : value;
  }

  const SceneValues& scene_;
  const SceneEntries& entries_;
  std::string key_;
  std::optional<Axis> axis_;
  NumberRange range_;
  std::set<double> kinks_;  ///< values of the key at which results may have kinks, as far as they are known
};

double u_over_i(const PointResult& result) {
  if (result[Quantity::kDolp] == 0.0) return 0.0;  // there is no angle of polarisation
  return result[Quantity::kDolp] * std::sin(2.0 * result[Quantity::kAolp] * std::numbers::pi / 180.0);
}

/// The derivative of a function at x, from its values at the steps of StepResults, with a bound of its error. A kink at
/// x + a h changes the slope by D. From one of the four intervals to the next, the slopes then change by 0, (1 - 2a) D
/// and 2a D. For any a, kBent times the largest difference of these changes plus kUneven times their second difference
/// is at least the error of the derivative, (1/2 - 7a/6) D or D (1 - a)/6. Where the function is smooth, the bound is
/// 0.11 h^2 times the third derivative.
struct Derivative {
  double value = 0.0;
  double bound = 0.0;
};
Derivative derivative_at(const std::array<double, kFactors.size()>& values, double step) {
  constexpr double kBent = 0.22, kUneven = 0.2;
  std::array<double, kFactors.size() - 1> slopes{};
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] = (values[i + 1] - values[i]) / (0.5 * step);
  const std::array<double, 3> changes = {slopes[1] - slopes[0], slopes[2] - slopes[1], slopes[3] - slopes[2]};
  const double narrow = (values[3] - values[1]) / step, wide = (values[4] - values[0]) / (2.0 * step);
  const auto [least, most] = std::ranges::minmax(changes);
  return {(4.0 * narrow - wide) / 3.0,
          kBent * (most - least) + kUneven * std::abs(changes[0] - 2.0 * changes[1] + changes[2])};
}

std::string per_unit(const std::string& unit) {
  if (unit == "1") return unit;
  return unit.find(' ') == std::string::npos ? unit + "-1" : "(" + unit + ")-1";
}

}  // namespace

std::vector<DerivativeColumn> scene_derivatives(const SceneValues& scene, const SceneEntries& entries,
                                                const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    if (!is_scene_number(scene, entries, key))
      throw InputError(fmt::format(
          "derivatives: {}: is no number of this scene; must be a key with a number that the scene has, such as "
          "surface.sigma, or grid.theta_deg (see dolp keys)",
          one_line(key)));
    if (std::ranges::count(keys, key) > 1)
      throw InputError(fmt::format("derivatives: {}: appears twice", one_line(key)));
  }
  std::vector<DerivativeColumn> columns = derivative_columns(keys);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& key = keys[i / kDerivativesPerKey];
    columns[i].units = per_unit(find_scene_key(key)->description.unit);
  }
  return columns;
}

void compute_derivatives(const SceneValues& scene, const SceneEntries& entries, const std::string& key,
                         ModelEvaluator& evaluator, const Progress& progress, std::span<DerivativeColumn> columns) {
  Steps steps(scene, entries, key);
  std::optional<StepResults> at = steps.results(evaluator, progress);
  if (!at && steps.is_on_axis()) {
    steps.stay_on_axis();
    at = steps.results(evaluator, progress);
  }
  for (DerivativeColumn& column : columns)
    column.values.assign(entries.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double step = at ? steps.step(entries[i]) : 0.0;
    if (!(step > 0.0)) continue;
    const auto component = [&](double (*read)(const PointResult&)) {
      std::array<double, kFactors.size()> values{};
      for (std::size_t k = 0; k < values.size(); ++k) values[k] = read((*at)[k][i]);
      return derivative_at(values, step);
    };
    const auto read_q = [](const PointResult& r) { return r[Quantity::kQOverI]; };
    const Derivative q = component(read_q), u = component(u_over_i);
    const auto bound = [&](std::size_t k) { return (*at)[k][i][Quantity::kErrorEstimate]; };
    const double noise = ((bound(0) + bound(4)) / 6.0 + (bound(1) + bound(3)) * (4.0 / 3.0)) / step;
    const PointResult& middle = (*at)[2][i];
    const double q_there = read_q(middle), u_there = u_over_i(middle);
    const double dolp = std::hypot(q_there, u_there);
    const double sign = std::signbit(middle[Quantity::kDolp]) ? -1.0 : 1.0;  // I may be negative
    // DOLP is the length of (Q/I, U/I). Its derivative needs their direction, which errors may turn.
    const double turned = bound(2) < dolp ? bound(2) / dolp : 2.0;
    const double rate = std::hypot(q.value, u.value);
    static_assert(kDerivativesPerKey == 3);
    columns[0].values[i] = dolp == 0.0 ? 0.0 : sign * (q_there * q.value + u_there * u.value) / dolp + 0.0;
    columns[1].values[i] = q.value + 0.0;  // adding 0 turns -0 into 0
    columns[2].values[i] = std::hypot(q.bound, u.bound) + noise + turned * rate;
  }
}

}  // namespace dolp
