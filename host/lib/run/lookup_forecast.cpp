#include "run/lookup_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>

#include "base/numbers.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "table/table_lookup.hpp"

namespace dolp {
namespace {

constexpr std::size_t kLines = 3;         // along an axis, at different values of the others
constexpr std::size_t kParts = 4;         // of an axis, at whose ends the stretches lie
constexpr std::size_t kStretch = 8;       // values: all that the error of a lookup in the middle depends on
constexpr std::size_t kLeastValues = 4;   // for which a lookup states an error
constexpr int kMostAttempts = 4;          // to find how many values are needed
constexpr double kMostValueGrowth = 8.0;  // of the number of values in one attempt
constexpr double kMargin = 1.5;           // of the error that an attempt aims at
// A lookup reads six values of theta, sigma and q, and four of wavelength, n and k. In dense grids the stated error is
// a share of the change by the last of these values, and falls with this power of the spacing; the sizes of the weights
// in the middle of a cell add up to so much, which multiplies the errors along the other axes.
constexpr double kOrderOfSix = 5.0;
constexpr double kOrderOfFour = 3.0;
constexpr double kWeightsOfSix = 356.0 / 256.0;
constexpr double kWeightsOfFour = 20.0 / 16.0;

bool is_read_with_four(Axis axis) { return axis < Axis::kTheta; }

/// The value at a position of an axis, which lies between two values mostly.
double value_at(const std::vector<double>& values, double position) {
  const auto below = std::min(static_cast<std::size_t>(position), values.size() - 2);
  const double share = position - static_cast<double>(below);
  return share == 0.0 ? values[below] : std::lerp(values[below], values[below + 1], share);
}

/// A short part of an axis at one value of each other axis, and a place between its values.
struct Stretch {
  Axes axes;
  TableLookup::Point point{};
};

class Forecast {
 public:
  Forecast(const SceneValues& scene, const EffectPlan& plan) : scene_(scene), grid_(scene.grid), plan_(plan) {
    scene_.wind_m_s.clear();
    std::ranges::copy_if(kAllAxes, std::back_inserter(axes_), [&](Axis axis) { return grid_[axis].size() > 1; });
    lines_ = axes_.size() > 1 ? kLines : 1;
  }

  std::vector<AxisForecast> all() {
    std::vector<AxisForecast> forecasts;
    for (const Axis axis : axes_) {
      double wanted = scene_.accuracy.tolerance / static_cast<double>(axes_.size() + 1);
      for (const Axis other : axes_) {
        if (other != axis) wanted /= is_read_with_four(other) ? kWeightsOfFour : kWeightsOfSix;
      }
      const std::size_t values = grid_[axis].size();
      const double error = error_with(axis, values);
      forecasts.push_back({axis, values, error, wanted, needed(axis, values, error, wanted)});
    }
    return forecasts;
  }

 private:
  /// The least number of values, of those tried, that gives the wanted error; 0 without one.
  std::size_t needed(Axis axis, std::size_t values, double error, double wanted) {
    const double order = is_read_with_four(axis) ? kOrderOfFour : kOrderOfSix;
    std::size_t enough = 0, too_few = 0;
    for (int attempt = 0;; ++attempt) {
      if (error <= wanted) {
        enough = enough == 0 ? values : std::min(enough, values);
      } else {
        too_few = std::max(too_few, values);
      }
      if (attempt == kMostAttempts) return enough;
      const double growth = std::isfinite(error) ? std::pow(kMargin * error / wanted, 1.0 / order) : 2.0;
      const double steps =
          static_cast<double>(values - 1) * std::clamp(growth, 1.0 / kMostValueGrowth, kMostValueGrowth);
      std::size_t next = std::max(kLeastValues, static_cast<std::size_t>(std::ceil(steps)) + 1);
      if (enough > 0) next = std::min(next, enough);
      if (enough > 0 && next <= too_few) next = (enough + too_few) / 2;
      if (next > kMostForecastValues) return enough;
      if (next == enough || next == too_few) return enough;
      values = next;
      error = error_with(axis, values);
    }
  }

  /// The largest error of a lookup along an axis of so many values, at the examined places.
  double error_with(Axis axis, std::size_t values) {
    if (values < kLeastValues) return kInfinity;
    std::vector<Stretch> stretches;
    for (std::size_t line = 0; line < lines_; ++line) {
      std::set<std::size_t> cells;
      for (std::size_t i = 0; i <= kParts; ++i) cells.insert(i * (values - 2) / kParts);
      for (const std::size_t cell : cells) stretches.push_back(stretch(axis, values, cell, line));
    }
    double largest = -1.0;  // NaN is not larger
    for (const double error : errors_in(stretches)) largest = error > largest ? error : largest;
    if (largest < 0.0) return kInfinity;
    return largest;
  }

  /// The values around a cell, and its middle.
  Stretch stretch(Axis axis, std::size_t values, std::size_t cell, std::size_t line) const {
    const std::size_t length = std::min(values, kStretch);
    const std::size_t centred = std::max(cell, kStretch / 2 - 1) - (kStretch / 2 - 1);
    const std::size_t first = std::min(centred, values - length);
    Stretch stretch;
    for (const Axis each : kAllAxes) {
      const std::vector<double>& whole = grid_[each];
      std::vector<double>& own = stretch.axes[each];
      if (whole.empty()) continue;
      if (each != axis) {
        const std::size_t part = (line + static_cast<std::size_t>(each)) % kLines;
        own = {whole[(2 * part + 1) * whole.size() / (2 * kLines)]};
        stretch.point[each] = own.front();
        continue;
      }
      const double step = static_cast<double>(whole.size() - 1) / static_cast<double>(values - 1);
      for (std::size_t k = first; k < first + length; ++k) {
        own.push_back(k + 1 == values ? whole.back() : value_at(whole, static_cast<double>(k) * step));
      }
      stretch.point[each] = std::midpoint(own[cell - first], own[cell - first + 1]);
    }
    return stretch;
  }

  /// The error of a lookup in each stretch; NaN where the model has no value. All stretches are computed together.
  std::vector<double> errors_in(const std::vector<Stretch>& stretches) {
    std::vector<SceneEntry> all;
    std::vector<SceneVariant> variants;
    std::vector<SceneEntries> grids;
    for (const Stretch& stretch : stretches) {
      scene_.grid = stretch.axes;
      const SceneEntries& own = grids.emplace_back(grid_entries(scene_));
      for (std::size_t i = 0; i < own.size(); ++i) {
        all.push_back(own[i]);
        all.back().variant += static_cast<std::uint32_t>(variants.size());
      }
      variants.insert(variants.end(), own.variants().begin(), own.variants().end());
    }
    const std::vector<PointResult> results = evaluate_scene(scene_, {all, variants}, evaluator_, {}, plan_);
    std::vector<double> errors;
    auto next = results.begin();
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      const auto end = next + static_cast<std::ptrdiff_t>(grids[i].size());
      scene_.grid = stretches[i].axes;
      TableValues table = table_part(table_layout(scene_, plan_, stretches[i].axes), grids[i], {next, end});
      next = end;
      std::ranges::fill(table[Quantity::kErrorEstimate], 0.0);  // what remains is the interpolation's
      std::ranges::fill(table[Quantity::kRhoErrorEstimate], 0.0);
      const TableLookup lookup(table, scene_, "forecast");
      errors.push_back(lookup.at(stretches[i].point)[Quantity::kErrorEstimate]);
    }
    return errors;
  }

  SceneValues scene_;  ///< with the grid of a stretch
  const Axes& grid_;   ///< the whole
  const EffectPlan& plan_;
  CpuEvaluator evaluator_;
  std::vector<Axis> axes_;
  std::size_t lines_ = 1;
};

}  // namespace

std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan) {
  return Forecast(scene, plan).all();
}

}  // namespace dolp
