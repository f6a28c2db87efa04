#include "verify/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "base/numbers.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_run.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostCells = 16;  // cells of an axis that a forecast examines
constexpr std::size_t kLeastCells = 2;
constexpr std::size_t kMostNeeded = 10'000;
constexpr double kAolpPeriod_deg = 180.0;

/// The values of an axis in ascending order, and their positions on the axis of the table.
struct SortedAxis {
  explicit SortedAxis(const std::vector<double>& given) : positions(given.size()) {
    std::iota(positions.begin(), positions.end(), std::size_t{0});
    std::ranges::sort(positions, {}, [&](std::size_t i) { return given[i]; });
    for (const std::size_t position : positions) values.push_back(given[position]);
    is_logarithmic = has_logarithmic_spacing();
  }

  /// Compares the largest step with the smallest: their ratio is nearer to 1 in the scale of the spacing.
  bool has_logarithmic_spacing() const {
    if (values.size() < 3 || values.front() <= 0.0) return false;
    const auto unevenness = [&](const auto& step) {
      double least = kInfinity, most = 0.0;
      for (std::size_t i = 1; i < values.size(); ++i) {
        least = std::min(least, step(i));
        most = std::max(most, step(i));
      }
      return most / least;
    };
    return unevenness([&](std::size_t i) { return std::log(values[i] / values[i - 1]); }) <
           unevenness([&](std::size_t i) { return values[i] - values[i - 1]; });
  }

  double coordinate(double value) const { return is_logarithmic ? std::log(value) : value; }
  /// The value at a fraction of the way from one value to the next.
  double between(std::size_t cell, double fraction) const {
    const double x = std::lerp(coordinate(values[cell]), coordinate(values[cell + 1]), fraction);
    return std::clamp(is_logarithmic ? std::exp(x) : x, values[cell], values[cell + 1]);
  }

  /// The cells that overlap the interval from `low` to `high`.
  std::vector<std::size_t> cells_between(double low, double high) const {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      if (values[i] < high && values[i + 1] > low) cells.push_back(i);
    }
    return cells;
  }

  using Weights = std::vector<std::pair<std::size_t, double>>;  // position on the table's axis, weight
  /// Weights of the polynomial through the `most` values around a value in a cell, or through all values.
  Weights weights(double value, std::size_t cell, std::size_t most) const {
    const std::size_t used = std::min(most, values.size());
    const std::size_t first = std::min(cell - std::min(cell, used / 2 - 1), values.size() - used);
    Weights all;
    for (std::size_t i = first; i < first + used; ++i) {
      double weight = 1.0;
      for (std::size_t j = first; j < first + used; ++j) {
        if (j == i) continue;
        weight *= (coordinate(value) - coordinate(values[j])) / (coordinate(values[i]) - coordinate(values[j]));
      }
      all.emplace_back(positions[i], weight);
    }
    return all;
  }

  std::vector<double> values;
  std::vector<std::size_t> positions;
  bool is_logarithmic = false;
};

/// A whole number below `count`, and a number in (0, 1). Unlike std::uniform_..., the same with each standard library.
std::size_t random_below(std::size_t count, std::mt19937_64& engine) { return engine() % count; }
double random_fraction(std::mt19937_64& engine) { return std::generate_canonical<double, 53>(engine); }

/// A grid with `count` values on an axis, between its first and last value and spaced like the axis.
std::vector<double> respaced(const SortedAxis& axis, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = static_cast<double>(i * (axis.values.size() - 1)) / static_cast<double>(count - 1);
    const auto cell = std::min(static_cast<std::size_t>(place), axis.values.size() - 2);
    values.push_back(axis.between(cell, place - static_cast<double>(cell)));
  }
  return values;
}

class Forecast {
 public:
  Forecast(const SceneValues& scene, const EffectPlan& plan) : scene_(scene), plan_(plan) {}

  /// Measures the error between the values of an axis, then between a number of values that may suffice.
  AxisForecast along(Axis axis, std::size_t cells) {
    const SortedAxis sorted(scene_.grid[axis]);
    const std::size_t values = sorted.values.size();
    AxisForecast forecast{axis, values, {}, 0};
    if (cells < kLeastCells) return forecast;
    const std::vector<Place> places = spread_places(sorted, cells);
    forecast.error = error(axis, sorted, places);
    const double first = forecast.error.largest;
    const std::size_t guess = needed(values, first, 2.0);
    forecast.needed_values = guess;
    if (guess == 0 || guess == values) return forecast;
    const SortedAxis other(respaced(sorted, guess));
    std::vector<Place> again = spread_places(other, cells);
    const Place& worst = places[forecast.error.where];
    for (const std::size_t cell : other.cells_between(sorted.values[worst.cell], sorted.values[worst.cell + 1]))
      if (again.size() < 2 * kMostCells) again.push_back({cell, worst.draw});
    const double second = error(axis, other, again).largest;
    // The error is proportional to a power of the spacing: to its square, or at a kink to the spacing itself.
    const double finer = static_cast<double>(guess - 1) / static_cast<double>(values - 1);
    const double power = first > 0.0 && second > 0.0 ? std::log(first / second) / std::log(finer) : 2.0;
    forecast.needed_values = needed(guess, second, std::clamp(power, 1.0, 2.0));
    if (forecast.needed_values > 0) {
      const bool suffices = first <= scene_.accuracy.tolerance;
      forecast.needed_values =
          suffices ? std::min(forecast.needed_values, values) : std::max(forecast.needed_values, values + 1);
    }
    return forecast;
  }
  double evaluations() const { return evaluator_.report().evaluations; }

 private:
  struct Place {
    std::size_t cell = 0;
    std::size_t draw = 0;  ///< number of the random values on the other axes
  };

  /// The number of values for an error equal to the tolerance, if the error is proportional to a power of the spacing.
  std::size_t needed(std::size_t values, double error, double power) const {
    const double steps = static_cast<double>(values - 1) * std::pow(error / scene_.accuracy.tolerance, 1.0 / power);
    return steps < static_cast<double>(kMostNeeded) ? std::max<std::size_t>(2, 1 + std::lround(std::ceil(steps))) : 0;
  }

  /// One cell in each of `cells` equal parts of the axis, so that both ends of the axis have cells near them.
  static std::vector<Place> spread_places(const SortedAxis& sorted, std::size_t cells) {
    std::vector<Place> places;
    for (std::size_t i = 0; i < cells; ++i)
      places.push_back({cells > 1 ? i * (sorted.values.size() - 2) / (cells - 1) : 0, i});
    return places;
  }

  ErrorSummary error(Axis axis, const SortedAxis& sorted, const std::vector<Place>& places) {
    std::mt19937_64 engine(kMostCells);
    Points points;
    points.count = 3 * places.size();
    for (const Axis each : kAllAxes) {
      const std::vector<double>& values = scene_.grid[each];
      if (values.empty()) continue;
      std::vector<double>& column = points[each].emplace();
      points.labels[each] = scene_.labels[each];
      std::vector<double> drawn;
      for (std::size_t i = 0; i < kMostCells; ++i) drawn.push_back(values[random_below(values.size(), engine)]);
      for (const Place& place : places) {
        for (const double fraction : {0.0, 0.5, 1.0})
          column.push_back(each == axis ? sorted.between(place.cell, fraction) : drawn[place.draw]);
      }
    }
    const std::vector<PointResult> results =
        evaluate_scene(scene_, point_entries(scene_, points), evaluator_, {}, plan_);
    std::vector<double> errors;
    for (std::size_t i = 0; i < results.size(); i += 3) {
      const auto dolp = [&](std::size_t k) { return results[i + k][Quantity::kDolp]; };
      errors.push_back(std::abs(dolp(1) - std::midpoint(dolp(0), dolp(2))));
    }
    return summary(errors);
  }

  const SceneValues& scene_;
  const EffectPlan& plan_;
  CpuEvaluator evaluator_;
};

}  // namespace

ErrorSummary summary(const std::vector<double>& errors) {
  ErrorSummary result;
  std::vector<double> known;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    known.push_back(errors[i]);
    if (errors[i] > result.largest || known.size() == 1) result.where = i;
    result.largest = std::max(result.largest, errors[i]);
  }
  result.compared = known.size();
  if (known.empty()) return result;
  std::ranges::sort(known);
  const auto quantile = [&](double share) {
    return known[static_cast<std::size_t>(share * static_cast<double>(known.size() - 1))];
  };
  result.median = quantile(0.5);
  result.p95 = quantile(0.95);
  return result;
}

PointsBetween::PointsBetween(const TableHead& table, std::size_t count, std::uint64_t seed) : labels_(table.labels) {
  std::mt19937_64 engine(seed);
  points_.name = "points";
  points_.count = count;
  points_.labels = table.labels;
  for (Method& method : methods_) method.weights.assign(count, {{0, 1.0}});
  for (const Axis axis : kAllAxes) {
    if (table.axes[axis].empty()) continue;
    const SortedAxis sorted(table.axes[axis]);
    const bool has_cells = !describe(axis).has_labels && sorted.values.size() > 1;
    std::vector<double>& column = points_[axis].emplace();
    for (std::size_t point = 0; point < count; ++point) {
      const std::size_t place = random_below(sorted.values.size() - (has_cells ? 1 : 0), engine);
      column.push_back(has_cells ? sorted.between(place, random_fraction(engine)) : sorted.values[place]);
      for (Method& method : methods_) {
        std::vector<Weight> product;
        for (const Weight& before : method.weights[point]) {
          for (const auto& [position, value] : has_cells ? sorted.weights(column.back(), place, method.values)
                                                         : SortedAxis::Weights{{sorted.positions[place], 1.0}})
            product.push_back({before.position * sorted.values.size() + position, before.value * value});
        }
        method.weights[point] = std::move(product);
      }
    }
  }
}

std::vector<std::size_t> PointsBetween::positions() const {
  std::vector<std::size_t> all;
  for (const Method& method : methods_) {
    for (const std::vector<Weight>& weights : method.weights) {
      for (const Weight& weight : weights) all.push_back(weight.position);
    }
  }
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

std::vector<InterpolationError> PointsBetween::errors(const TableValues& entries, std::span<const PointResult> computed,
                                                      const Quantities& quantities) const {
  const std::vector<std::size_t> known = positions();
  std::vector<InterpolationError> all;
  for (const Quantity quantity : quantities) {
    for (const Method& method : methods_) {
      std::vector<double> errors;
      for (std::size_t point = 0; point < points_.size(); ++point) {
        double value = 0.0;
        for (const Weight& weight : method.weights[point]) {
          const auto entry = std::ranges::lower_bound(known, weight.position) - known.begin();
          value += weight.value * entries[quantity][static_cast<std::size_t>(entry)];
        }
        const double error = value - computed[point][quantity];
        errors.push_back(std::abs(quantity == Quantity::kAolp ? std::remainder(error, kAolpPeriod_deg) : error));
      }
      InterpolationError& error = all.emplace_back(InterpolationError{quantity, method.name, summary(errors), {}});
      for (const Axis axis : kAllAxes) {
        if (!points_[axis] || error.error.compared == 0) continue;
        const double value = (*points_[axis])[error.error.where];
        const bool is_label = describe(axis).has_labels;
        error.at.push_back({axis, value, is_label ? labels_[axis][static_cast<std::size_t>(value)] : ""});
      }
    }
  }
  return all;
}

InterpolationForecast forecast_interpolation(const SceneValues& scene, const EffectPlan& plan, double evaluations,
                                             double per_entry) {
  std::vector<Axis> axes;
  for (const Axis axis : kAllAxes) {
    if (scene.grid[axis].size() > 1 && !describe(axis).has_labels) axes.push_back(axis);
  }
  Forecast forecast(scene, plan);
  InterpolationForecast result;
  for (const Axis axis : axes) {
    // Each cell takes three entries, once with the grid's values and up to twice with another number of values.
    const double affordable = evaluations / std::max(1.0, per_entry) / (9.0 * static_cast<double>(axes.size()));
    const auto cells = static_cast<std::size_t>(std::min(affordable, static_cast<double>(kMostCells)));
    result.axes.push_back(forecast.along(axis, cells));
  }
  result.evaluations = forecast.evaluations();
  return result;
}

}  // namespace dolp
