#include "table/table_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstdint>
#include <dolp/errors.hpp>
#include <set>

#include <dolp/status.hpp>
#include "base/numbers.hpp"
#include "model/angles.hpp"

namespace dolp {
namespace {

constexpr auto kTheta = static_cast<std::size_t>(Axis::kTheta);
constexpr auto kQ = static_cast<std::size_t>(Axis::kQ);
// How many values an interpolation reads on each axis. On the first two axes, which have labels, it always reads one.
constexpr std::array<std::size_t, kAxisCount> kWindow = {2, 2, 4, 4, 4, 4, 6, 6, 6};
constexpr std::size_t kMostRows = std::size_t{4} * 4 * 4 * 4 * 6 * 6;  // limit of Rows::rows; a row has all values of q
constexpr int kMostShift = 3;            // most values by which the read window moves away from unknown entries
constexpr std::size_t kLeastValues = 4;  // an axis with fewer values gives no reliable error estimate
// These five constants are tuned on 581,000 bistatic lookups. A failure is a lookup whose error exceeds the stated
// error. The stated interpolation error is a factor times the change of the result if one more value of the axis is
// used. The factor is kAtEnds in the first and last interval, and if the interpolation itself uses all values of the
// axis. Otherwise it is kInside. Failures: 147 with both factors halved, 2 with these values, 0 with both doubled.
constexpr double kInside = 16.0;
constexpr double kAtEnds = 37.0;
// This change may be small by chance. So the estimate uses at least kFastestFall times the change that one value fewer
// gives. On a short axis (see is_short), it also uses at least kFastestFallOfTwo times the change from two values
// fewer. Failures: 44 with both factors halved, 2 with these values, 0 with both doubled.
constexpr double kFastestFall = 0.2;
constexpr double kFastestFallOfTwo = 0.25;
// For a kink of the masking, the stated error also contains kKinkMargin times the error that the kink causes.
// Failures: 38 with the factor 0, 4 with 1, 2 with 2, 2 with 4.
constexpr double kKinkMargin = 2.0;

using enum Quantity;

// Quantities that are smooth functions of the axes. Only these are interpolated.
constexpr std::array kSmooth = {kStokesI, kStokesQ,     kStokesU,     kStokesV, kRhoI,    kRhoQ,
                                kAlbedo,  kEmissivityS, kEmissivityP, kDolpLow, kDolpHigh};

bool has_error(Quantity quantity) {
  constexpr std::array kWithout = {kStokesV, kAlbedo, kEmissivityS, kEmissivityP};
  return std::ranges::find(kWithout, quantity) == kWithout.end();
}

constexpr std::array kNeeded = {kDolp, kStokesI, kStokesQ, kStokesU, kStokesV, kErrorEstimate};

const std::vector<double>& checked(const std::vector<double>& values, const char* axis, const std::string& name) {
  if (std::set(values.begin(), values.end()).size() != values.size()) {
    throw InputError(fmt::format("{}: {}: a value appears twice; nothing can be interpolated there", name, axis));
  }
  return values;
}

std::vector<LookupAxis> axes_of(const TableValues& table, const std::string& name) {
  std::vector<LookupAxis> axes;
  for (const Axis axis : kAllAxes) {
    const std::vector<double>& values = table.axes[axis];
    const bool is_linear = axis == Axis::kTheta || description_of(axis).has_labels;
    axes.emplace_back(values.empty() ? std::vector<double>{1.0} : checked(values, description_of(axis).name, name),
                      is_linear ? LookupAxis::Scale::kLinear : LookupAxis::Scale::kLogarithm,
                      axis == Axis::kQ ? 1.0 : 0.0);
  }
  return axes;
}

PointResult unknown() {
  PointResult result;
  result.status = kOutsideModelDomain;
  return result;
}

void check_variables(const TableValues& table, const std::string& name) {
  std::vector<std::string> missing;
  for (const Quantity quantity : kAllQuantities) {
    const bool is_needed =
        std::ranges::find(kNeeded, quantity) != kNeeded.end() || (quantity == kRhoI && table.has(kRhoErrorEstimate));
    if (is_needed && !table.has(quantity)) missing.emplace_back(description_of(quantity).name);
  }
  if (table.status.empty()) missing.emplace_back("status");
  if (missing.empty()) return;
  const bool is_one = missing.size() == 1;
  throw InputError(fmt::format("{}: the variable{} {} {} missing; lookup needs {}", name, is_one ? "" : "s",
                               fmt::join(missing, ", "), is_one ? "is" : "are", is_one ? "it" : "them"));
}

}  // namespace

std::vector<double> masking_kinks(const SceneModel& scene) {
  const Masking masking = scene.surface.masking;
  const double view_deg = scene.geometry.view_zenith_deg;
  if (scene.geometry.mode != Mode::kBistatic || !scene.source) return {};
  if (masking == Masking::kIntegral) return {view_deg};
  if (masking != Masking::kVCavity) return {};
  const CosSin view = cos_sin_deg(view_deg);
  const double cos_azimuth = cos_sin_deg(scene.geometry.relative_azimuth_deg).cos;
  // V-cavity masking is min(1, g), where g is a ratio of cosines. It has a kink at g = 1, and at equal zeniths if g < 1
  // there. hidden() is (1 - g) cos^2(beta), where beta is the angle of incidence.
  const auto hidden = [&](double theta_deg) {
    const CosSin theta = cos_sin_deg(theta_deg);
    const double cos2_beta = 0.5 * (1.0 + theta.cos * view.cos + theta.sin * view.sin * cos_azimuth);
    return cos2_beta - std::min(theta.cos, view.cos) * (theta.cos + view.cos);
  };
  std::vector<double> kinks_deg;
  if (hidden(view_deg) > 0.0) kinks_deg.push_back(view_deg);
  for (int theta_deg = 0; theta_deg < 90; ++theta_deg) {
    const double below = hidden(theta_deg);
    const double above = hidden(theta_deg + 1);
    if ((below > 0.0) != (above > 0.0)) kinks_deg.push_back(theta_deg + below / (below - above));
  }
  return kinks_deg;
}

struct TableLookup::Window {
  std::array<LookupAxis::Location, kAxisCount> locations;
  std::array<Stencil, kAxisCount> stencils;

  Window(const TableLookup& lookup, const Point& point) {
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      const LookupAxis& axis = lookup.axes_[i];
      locations[i] = axis.size() == 1 ? LookupAxis::Location{.is_value = true} : axis.locate(point[i]);
      stencils[i] = axis.stencil(locations[i], kWindow[i]);
    }
  }

  bool is_entry() const {
    return std::ranges::all_of(stencils, [](const Stencil& of_axis) { return of_axis.count == 1; });
  }
  /// Rank of the largest value of `axis` that is not above the value of the point.
  std::size_t below(std::size_t axis) const {
    return locations[axis].is_value ? locations[axis].next : locations[axis].next - 1;
  }

  /// Table positions of the corners of the cell around the point. They have position 0 on the axis `without`.
  using Corners = boost::container::static_vector<std::size_t, std::size_t{1} << kAxisCount>;
  Corners corners(const TableLookup& lookup, std::size_t without) const {
    Corners corners = {0};
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      if (axis == without) continue;
      const std::size_t before = corners.size();
      if (!locations[axis].is_value) {
        const std::size_t above = lookup.position(axis, below(axis) + 1);
        for (std::size_t i = 0; i < before; ++i) corners.push_back(corners[i] + above);
      }
      const std::size_t lower = lookup.position(axis, below(axis));
      for (std::size_t i = 0; i < before; ++i) corners[i] += lower;
    }
    return corners;
  }
};

/// The entries that an interpolation reads, in rows: entries of a row differ only in q. All quantities share the rows.
struct TableLookup::Rows {
  struct Row {
    std::size_t begin = 0;
    double weight = 1.0;
  };
  boost::container::static_vector<Row, kMostRows> rows;
  std::array<std::size_t, kMostStencil> along{};  ///< position of each value of a row, relative to Row::begin
  Stencil q;

  Rows(const TableLookup& lookup, const Window& window) : q(window.stencils[kQ]) {
    rows.push_back({});
    for (std::size_t axis = 0; axis < kQ; ++axis) {
      const Stencil& stencil = window.stencils[axis];
      const std::size_t before = rows.size();
      for (std::size_t i = stencil.count; i-- > 0;) {  // i = 0 is last, because it overwrites rows that each i needs
        const std::size_t begin = lookup.position(axis, stencil.first + i);
        for (std::size_t row = 0; row < before; ++row) {
          const Row next = {rows[row].begin + begin, rows[row].weight * stencil.weights[i]};
          i > 0 ? rows.push_back(next) : void(rows[row] = next);
        }
      }
    }
    for (std::size_t k = 0; k < q.count; ++k) along[k] = lookup.position(kQ, q.first + k);
  }

  /// Sum over the read entries of weight * value(position of the entry). With `kOfSizes`, |weight| replaces weight.
  template <bool kOfSizes = false, class Value>
  double sum(const Value& value) const {
    bool is_dense = true;  // true if the values of a row are neighbours in memory
    for (std::size_t k = 1; k < q.count; ++k) is_dense = is_dense && along[k] == along[0] + k;
    if (is_dense && q.count == kWindow[kQ]) return sum_dense<kWindow[kQ], kOfSizes>(value);
    if (is_dense && q.count == kWindow[kQ] - 1) return sum_dense<kWindow[kQ] - 1, kOfSizes>(value);
    if (is_dense && q.count == 1) return sum_dense<1, kOfSizes>(value);
    double sum = 0.0;
    for (const Row& row : rows) {
      double of_row = 0.0;
      for (std::size_t k = 0; k < q.count; ++k) of_row += used<kOfSizes>(q.weights[k]) * value(row.begin + along[k]);
      sum += used<kOfSizes>(row.weight) * of_row;
    }
    return sum;
  }

 private:
  template <bool kOfSizes>
  static double used(double weight) {
    return kOfSizes ? std::abs(weight) : weight;
  }
  /// sum() for rows of a length that the compiler knows. The sums over even and odd k can run in parallel on the CPU.
  template <std::size_t kCount, bool kOfSizes, class Value>
  double sum_dense(const Value& value) const {
    std::array<double, kCount> weights;
    for (std::size_t k = 0; k < kCount; ++k) weights[k] = used<kOfSizes>(q.weights[k]);
    double even = 0.0;
    double odd = 0.0;
    for (const Row& row : rows) {
      const std::size_t begin = row.begin + along[0];
      double of_even = 0.0;
      double of_odd = 0.0;
#pragma GCC unroll 3
      for (std::size_t k = 0; k + 1 < kCount; k += 2) {
        of_even += weights[k] * value(begin + k);
        of_odd += weights[k + 1] * value(begin + k + 1);
      }
      if (kCount % 2 == 1) of_even += weights[kCount - 1] * value(begin + kCount - 1);
      even += used<kOfSizes>(row.weight) * of_even;
      odd += used<kOfSizes>(row.weight) * of_odd;
    }
    return even + odd;
  }
};

/// Estimates the interpolation error along one axis. Uses lines: a line has the entries that differ only in the value
/// on this axis. Lines run through all corners of the cell around the point.
struct TableLookup::Lines {
  /// Change of the result if one more axis value is used, below or above the others: divided difference * distances().
  struct Change {
    std::size_t first = 0;  ///< the first value that the change uses, as an index into the line
    std::size_t count = 0;
    /// At level 0, a change uses one value more than the window, or all values of the axis if these are fewer. At
    /// level 1 it uses one value fewer, at level 2 two fewer. The change for a kink has the level kLevels.
    std::size_t level = 0;
  };
  static constexpr std::size_t kLevels = 3;  // levels 0, 1 and 2; only a short axis (see is_short) has level 2
  // On a short axis: one change of level 0, two of level 1, two of level 2 and one for a kink. Other axes have fewer.
  static constexpr std::size_t kMostChanges = 6;
  static constexpr std::size_t kMostValues = kMostStencil + 1;
  boost::container::static_vector<Change, kMostChanges> changes;
  std::array<std::array<double, kMostChanges>, kMostValues>
      factors{};                                 ///< change j is the sum over i of factors[i][j] * (value i of a line)
  std::array<std::size_t, kMostValues> along{};  ///< value i of the line at corner c is entry begin[c] + along[i]
  std::size_t count = 0;
  Window::Corners begin;
  double factor = 1.0;  ///< stated error / change: kInside or kAtEnds, times, for each other axis, the sum of |weight|
  bool has_error = false;
  bool is_short = false;  ///< true if the axis has at most one value more than the window
  bool is_unknown = false;

  Lines(const TableLookup& lookup, const Window& window, std::size_t number) {
    const LookupAxis& axis = lookup.axes_[number];
    const Stencil& stencil = window.stencils[number];
    has_error = stencil.count > 1;
    const std::size_t most = std::min(axis.size(), stencil.count + 1);
    is_unknown = has_error && most < kLeastValues;
    if (!has_error || is_unknown) return;
    is_short = most == axis.size();
    const std::size_t levels = is_short ? kLevels : kLevels - 1;
    const std::size_t below = window.below(number);
    const std::size_t start = std::max(stencil.first, std::size_t{1}) - 1;
    for (std::size_t level = 0; level < std::min(levels, most - 2); ++level) {
      const std::size_t values = most - level;
      const std::size_t before = values - 1;
      const std::size_t centred = below + 1 > before / 2 ? below + 1 - before / 2 : 0;
      const std::size_t first = std::clamp(centred, stencil.first, stencil.first + stencil.count - before);
      const double distances = axis.distances(window.locations[number], first, before);
      // If first is 0, first - 1 wraps around to a huge number, which the loop skips.
      for (const std::size_t with : {first - 1, first}) {
        if (with + values > axis.size() || with > first) continue;
        const std::span<const double> of_change = axis.divided_difference(with, values);
        for (std::size_t i = 0; i < values; ++i) factors[with - start + i][changes.size()] = distances * of_change[i];
        changes.push_back({with - start, values, level});
        count = std::max(count, with - start + values);
      }
    }
    for (std::size_t i = 0; i < count; ++i) along[i] = lookup.position(number, start + i);
    begin = window.corners(lookup, number);
    const bool is_at_end = most <= stencil.count || below == 0 || below + 2 == axis.size();
    factor = is_at_end ? kAtEnds : kInside;
    if (number == kTheta) add_kink(axis, window.locations[kTheta].coordinate, stencil, start, lookup.kinks_deg_);
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      if (i == number) continue;
      double sizes = 0.0;
      for (std::size_t k = 0; k < window.stencils[i].count; ++k) sizes += std::abs(window.stencils[i].weights[k]);
      factor *= sizes;
    }
  }

  /// Adds a change for a kink of the masking. A kink adds the ramp max(theta - kink, 0), times a slope, to the entries.
  /// The slope is about (second difference of the entries) / (second difference of the ramp). The kink's interpolation
  /// error is this slope times the interpolation error of the ramp. If the window has several kinks, only the one with
  /// the largest error of its ramp counts.
  void add_kink(const LookupAxis& axis, double theta_deg, const Stencil& stencil, std::size_t start,
                const std::vector<double>& kinks_deg) {
    const std::size_t last = stencil.first + stencil.count - 1;
    double largest = 0.0;
    double kink_deg = 0.0;
    for (const double kink : kinks_deg) {
      if (kink <= axis.coordinate_at(stencil.first) || kink >= axis.coordinate_at(last)) continue;
      double error = -std::max(theta_deg - kink, 0.0);
      for (std::size_t k = 0; k < stencil.count; ++k) {
        error += stencil.weights[k] * std::max(axis.coordinate_at(stencil.first + k) - kink, 0.0);
      }
      if (std::abs(error) <= std::abs(largest)) continue;
      largest = error;
      kink_deg = kink;
    }
    if (largest == 0.0 || stencil.count < 3) return;
    std::size_t middle = stencil.first + 1;  // rank of the value nearest to the kink, ends of the window excluded
    while (middle + 1 < last && axis.coordinate_at(middle) + axis.coordinate_at(middle + 1) < 2.0 * kink_deg) ++middle;
    const std::span<const double> difference = axis.divided_difference(middle - 1, 3);
    const double of_ramp = difference[1] * std::max(axis.coordinate_at(middle) - kink_deg, 0.0) +
                           difference[2] * (axis.coordinate_at(middle + 1) - kink_deg);
    for (std::size_t i = 0; i < 3; ++i) {
      factors[middle - 1 - start + i][changes.size()] = kKinkMargin / factor * largest / of_ramp * difference[i];
    }
    changes.push_back({middle - 1 - start, 3, kLevels});
  }

  /// Computes each change from its own values only, so that an unknown entry spoils only changes that use it.
  void known_changes(const double* values, double* sums) const {
    for (std::size_t j = 0; j < changes.size(); ++j) {
      sums[j] = 0.0;
      for (std::size_t i = changes[j].first; i < changes[j].first + changes[j].count; ++i) {
        sums[j] += factors[i][j] * values[along[i]];
      }
    }
  }

  double error(const std::vector<double>& column) const {
    if (!has_error) return 0.0;
    if (is_unknown) return kInfinity;
    double of_change[kMostChanges];
    std::fill(std::begin(of_change), std::end(of_change), -1.0);
    const std::size_t* const positions = along.data();
    for (const std::size_t first : begin) {
      const double* const values = column.data() + first;
      double sums[kMostChanges] = {};
      for (std::size_t i = 0; i < count; ++i) {
        const double value = values[positions[i]];
        const double* const of_value = factors.data()[i].data();
#pragma GCC unroll 6
        for (std::size_t j = 0; j < kMostChanges; ++j) sums[j] += of_value[j] * value;
      }
      // A change that uses an unknown (NaN) entry is NaN. It does not count: `size > of_change[j]` is then false.
      if (!std::isfinite(sums[0])) known_changes(values, sums);
#pragma GCC unroll 6
      for (std::size_t j = 0; j < kMostChanges; ++j) {
        const double size = std::abs(sums[j]);
        of_change[j] = size > of_change[j] ? size : of_change[j];
      }
    }
    std::array<double, kLevels + 1> largest;
    largest.fill(-1.0);
    for (std::size_t j = 0; j < changes.size(); ++j) {
      largest[changes[j].level] = std::max(largest[changes[j].level], of_change[j]);
    }
    if (largest[0] < 0.0) return kInfinity;
    if (largest[0] == 0.0) return 0.0;
    // On a coarse axis, all changes of level 0 may be small by chance. So levels 1 and 2, with fewer values, count too.
    largest[0] = std::max(largest[0], kFastestFall * largest[1]);
    if (is_short) largest[0] = std::max(largest[0], kFastestFallOfTwo * largest[2]);
    return factor * (largest[0] + std::max(largest[kLevels], 0.0));
  }
};

TableLookup::TableLookup(const TableValues& table, const SceneModel& scene, const std::string& name)
    : table_(table),
      tolerance_(scene.accuracy.tolerance),
      kinks_deg_(masking_kinks(scene)),
      axes_(axes_of(table, name)) {
  check_variables(table, name);
  std::size_t stride = 1;
  for (std::size_t i = kAxisCount; i-- > 0; stride *= axes_[i].size()) strides_[i] = stride;
  for (const Quantity quantity : kSmooth) {
    if (std::ranges::any_of(table[quantity], [](double value) { return value != 0.0; }))
      interpolated_.push_back(quantity);
  }
  std::vector<char> known(axes_[kTheta].size(), 1);
  const std::vector<double>& stokes_i = table[kStokesI];
  for (std::size_t i = 0; i < stokes_i.size(); ++i) {
    if (!std::isfinite(stokes_i[i])) known[i / strides_[kTheta] % known.size()] = 0;
  }
  for (std::size_t i = 0; i < known.size(); ++i) is_known_.push_back(known[axes_[kTheta].position(i)]);
}

bool TableLookup::is_known(const Window& window) const {
  const Stencil& theta = window.stencils[kTheta];
  const auto first = is_known_.begin() + static_cast<std::ptrdiff_t>(theta.first);
  if (std::all_of(first, first + static_cast<std::ptrdiff_t>(theta.count), [](char known) { return known != 0; })) {
    return true;
  }
  const std::vector<double>& stokes_i = table_[kStokesI];
  return std::isfinite(Rows(*this, window).sum([&](std::size_t position) { return stokes_i[position]; }));
}

bool TableLookup::make_known(Window& window, double theta_deg) const {
  int shift = 0;
  std::size_t count = kWindow[kTheta];
  const int away = theta_deg > 45.0 ? -1 : 1;
  while (!is_known(window)) {
    if (++shift > kMostShift) {
      shift = 0;
      if (--count < 2) return false;
    }
    window.stencils[kTheta] = axes_[kTheta].stencil(window.locations[kTheta], count, away * shift);
  }
  return true;
}

std::uint32_t TableLookup::cell_status(const Window& window) const {
  std::uint32_t status = 0;
  for (const std::size_t position : window.corners(*this, kAxisCount)) status |= table_.status[position];
  return status;
}

PointResult TableLookup::at(const Point& point) const {
  Window window(*this, point);
  if (window.is_entry())
    return table_.at(Rows(*this, window).rows.front().begin + position(kQ, window.stencils[kQ].first));
  if (!make_known(window, point[kTheta])) return unknown();
  const Rows rows(*this, window);
  PointResult result;
  PointResult change;
  for (const Quantity quantity : kSmooth) {
    if (table_.has(quantity)) result[quantity] = 0.0;
    change[quantity] = 0.0;
  }
  for (const Quantity quantity : interpolated_) {
    result[quantity] = rows.sum([values = table_[quantity].data()](std::size_t position) { return values[position]; });
  }
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    if (window.stencils[axis].count == 1) continue;
    const Lines lines(*this, window, axis);
    for (const Quantity quantity : interpolated_) {
      if (has_error(quantity)) change[quantity] += lines.error(table_[quantity]);
    }
  }
  const double error =
      rows.sum<true>([bounds = table_[kErrorEstimate].data()](std::size_t position) { return bounds[position]; });
  double rho_error = 0.0;  // absolute error of rho
  if (table_.has(kRhoErrorEstimate)) {
    const std::vector<double>& rho = table_[kRhoI];
    const std::vector<double>& bounds = table_[kRhoErrorEstimate];
    rho_error = rows.sum<true>([&](std::size_t position) { return std::abs(rho[position]) * bounds[position]; });
  }
  result.status = cell_status(window) & (kReflectanceOutsideZeroToOne | kModelInaccurate);
  finish(result, change, error, rho_error);
  return result;
}

void TableLookup::finish(PointResult& result, const PointResult& change, double error, double rho_error) const {
  // Error of the quotient `above` / `below`: (error of above + |quotient| * error of below) / least possible |below|.
  const auto over = [](double below, double below_error, double quotient, double above_error) {
    const double least = std::abs(below) - below_error;
    // If the quotient is 0, of_below is 0 even if below_error is infinite: the product would be NaN.
    const double of_below = quotient == 0.0 ? 0.0 : std::abs(quotient) * below_error;
    return above_error + of_below == 0.0 ? 0.0 : least > 0.0 ? (above_error + of_below) / least : kInfinity;
  };
  result[kDolp] = std::hypot(result[kStokesQ], result[kStokesU]) / result[kStokesI];
  result[kQOverI] = result[kStokesQ] / result[kStokesI];
  double dolp_error =
      over(result[kStokesI], change[kStokesI], result[kDolp], std::hypot(change[kStokesQ], change[kStokesU]));
  if (table_.has(kDolpLow)) dolp_error = std::max({dolp_error, change[kDolpLow], change[kDolpHigh]});
  result[kErrorEstimate] = error + dolp_error;
  if (table_.has(kRhoErrorEstimate)) {
    result[kRhoErrorEstimate] =
        over(result[kRhoI], rho_error + change[kRhoI], 0.0, rho_error + std::max(change[kRhoI], change[kRhoQ]));
  }
  add_status(result);
}

void TableLookup::add_status(PointResult& result) const {
  if (result[kStokesI] <= 0.0) result.status |= kIntensityNotPositive;
  const bool states_dolp = promises_dolp(result.status);
  if (states_dolp && !(result[kErrorEstimate] <= tolerance_)) result.status |= kToleranceNotMet;
  if (result[kRhoErrorEstimate] > tolerance_) result.status |= kRhoToleranceNotMet;
}

Quantities TableLookup::quantities() const {
  Quantities given;
  for (const Quantity quantity : kAllQuantities) {
    if (!description_of(quantity).is_optional() || table_.has(quantity)) given.push_back(quantity);
  }
  return given;
}

const LookupAxis* TableLookup::axis(Axis axis) const {
  return table_.axes[axis].empty() ? nullptr : &axes_[static_cast<std::size_t>(axis)];
}

}  // namespace dolp
