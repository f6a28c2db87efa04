#include "verify/table_check.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numeric>

#include "model/angles.hpp"
#include "radiometry/radiometry.hpp"
#include "run/scene_run.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

using enum Quantity;
using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
using Gauss = boost::math::quadrature::gauss<double, 7>;

constexpr std::size_t kFirstIntervals = 4;
constexpr std::size_t kMostIntervals = 32;  // largest number of intervals per point; each has 15 wavelengths
constexpr double kQuadratureShare = 0.01;   // the quadrature stops if its error is below this times the tolerance

constexpr std::array kIntegrated = {kStokesI, kStokesQ, kStokesU, kStokesV};
constexpr std::array kMeans = {kRhoI, kRhoQ, kRhoU, kEmissivityS, kEmissivityP};
constexpr Eigen::Index kReflectances = 3;  // the first of kMeans

/// Positions in `Integrals`. The order is: radiation, weight, weighted means, error of DOLP, error of rho.
constexpr std::size_t kWeight = kIntegrated.size();
constexpr std::size_t kDolpError = kWeight + 1 + kMeans.size();
constexpr std::size_t kRhoError = kDolpError + 1;
using Integrals = Eigen::Array<double, kRhoError + 1, 1>;

struct BandPiece {
  double from_um;
  double to_um;
  Integrals value = Integrals::Zero();
  Integrals error = Integrals::Zero();
};

struct PointIntegral {
  SceneEntry entry;
  SceneVariant variant;        ///< variant of the entry; the quadrature sets its wavelength
  std::vector<double> breaks;  ///< wavelengths in um at which the integrand is not smooth
  std::vector<BandPiece> intervals;
  std::size_t first_new = 0;  ///< position of the first interval that is not integrated yet
  PointResult last;           ///< result at the last node, for quantities that are not integrated
};

std::vector<double> band_breaks_um(const SceneModel& scene) {
  std::vector<double> breaks = kinks_um(scene);
  if (const SpectralTable* response = scene.spectrum.response.get())
    breaks.insert(breaks.end(), response->wavelength_um.begin(), response->wavelength_um.end());
  const double from = scene.spectrum.min_um, to = scene.spectrum.max_um;
  std::erase_if(breaks, [&](double at_um) { return at_um <= from || at_um >= to; });
  breaks.insert(breaks.end(), {from, to});
  std::ranges::sort(breaks);
  return breaks;
}

double mean_weight_at(const SceneModel& scene, const SceneVariant& variant, double cosine) {
  const SpectralRule rule = spectral_rule(with_variant(scene, variant));
  const SpectralSample& sample = rule.samples.front();
  if (sample.emitted != 0.0) return sample.emitted;
  const double incident = sample.irradiance * cosine + sample.surroundings;
  return incident != 0.0 ? incident : 1.0;
}

/// The response of the camera: a straight line between the rows around the wavelength, times the number of photons.
double camera_response(const Spectrum& spectrum, double wavelength_um) {
  if (!spectrum.response) return 1.0;
  const std::vector<double>& rows_um = spectrum.response->wavelength_um;
  const std::vector<double>& values = spectrum.response->value;
  std::size_t largest = 0, after = 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] > values[largest]) largest = i;
    if (rows_um[i] < wavelength_um && i + 1 < values.size()) after = i + 1;
  }
  const double width_um = rows_um[after] - rows_um[after - 1];
  const double response = values[after - 1] * (rows_um[after] - wavelength_um) / width_um +
                          values[after] * (wavelength_um - rows_um[after - 1]) / width_um;
  return spectrum.response_per == ResponsePer::kPower ? response : response * wavelength_um / rows_um[largest];
}

Integrals integrand(const PointResult& at, double weight) {
  Integrals value = Integrals::Zero();
  Eigen::Index i = 0;
  for (const Quantity quantity : kIntegrated) value[i++] = at[quantity];
  value[i++] = weight;
  for (const Quantity quantity : kMeans) value[i++] = std::isnan(at[quantity]) ? 0.0 : weight * at[quantity];
  // The error estimate of DOLP may be infinite, for example where nothing is emitted. Even then DOLP errs by at most 1.
  const double error = std::abs(at[kStokesI]) * at[kErrorEstimate];
  value[i++] = std::isfinite(error) ? error : std::abs(at[kStokesI]);
  value[i] = std::abs(weight * at[kRhoI]) * at[kRhoErrorEstimate];
  return value;
}

/// A node of the quadrature: its offset in an interval (-1 to 1), and its Kronrod and Gauss weights.
struct KronrodNode {
  double offset;
  double kronrod;
  double gauss;
};
std::vector<KronrodNode> kronrod_nodes() {
  std::vector<KronrodNode> all;
  for (std::size_t i = 0; i < Kronrod::abscissa().size(); ++i) {
    const double gauss = i % 2 == 0 ? Gauss::weights()[i / 2] : 0.0;
    all.push_back({Kronrod::abscissa()[i], Kronrod::weights()[i], gauss});
    if (i > 0) all.push_back({-Kronrod::abscissa()[i], Kronrod::weights()[i], gauss});
  }
  return all;
}

Integrals sum_pieces(const std::vector<BandPiece>& intervals, Integrals BandPiece::*part) {
  Integrals sum = Integrals::Zero();
  for (const BandPiece& interval : intervals) sum += interval.*part;
  return sum;
}

/// The error of the quadrature: the error of DOLP or the error of the mean rho, whichever is larger.
double quadrature_error(const Integrals& value, const Integrals& error) {
  const double mean_error = error.segment(kWeight + 1, kReflectances).sum() / std::abs(value[kWeight + 1]);
  return std::max(error.head(kWeight).sum() / std::abs(value[0]), mean_error + error[kWeight] / value[kWeight]);
}

/// Splits the interval with the largest error: at one of PointIntegral::breaks if one lies in it, else in the middle.
void split_worst(PointIntegral& point) {
  const Integrals value = sum_pieces(point.intervals, &BandPiece::value);
  const auto worst = std::ranges::max_element(
      point.intervals, {}, [&](const BandPiece& interval) { return quadrature_error(value, interval.error); });
  const BandPiece old = *worst;
  point.intervals.erase(worst);
  const auto first = std::ranges::upper_bound(point.breaks, old.from_um);
  const auto last = std::ranges::lower_bound(point.breaks, old.to_um);
  const double at_um = first < last ? *(first + (last - first) / 2) : 0.5 * (old.from_um + old.to_um);
  point.first_new = point.intervals.size();
  point.intervals.push_back({old.from_um, at_um});
  point.intervals.push_back({at_um, old.to_um});
}

void integrate_new(const SceneValues& scene, std::vector<PointIntegral*>& points, ModelEvaluator& evaluator,
                   const Progress& progress) {
  static const std::vector<KronrodNode> kNodes = kronrod_nodes();
  std::vector<SceneEntry> entries;
  std::vector<SceneVariant> variants;
  for (PointIntegral* point : points) {
    for (std::size_t i = point->first_new; i < point->intervals.size(); ++i) {
      const BandPiece& interval = point->intervals[i];
      for (const KronrodNode& node : kNodes) {
        entries.push_back(point->entry);
        entries.back().variant = static_cast<std::uint32_t>(variants.size());
        variants.push_back(point->variant);
        variants.back().wavelength_um =
            std::midpoint(interval.from_um, interval.to_um) + 0.5 * node.offset * (interval.to_um - interval.from_um);
      }
    }
  }
  SceneValues at_one = scene;
  at_one.spectrum.max_um = at_one.spectrum.min_um;
  const std::vector<PointResult> results = evaluate_scene(at_one, {entries, variants}, evaluator, progress);
  std::size_t next = 0;
  for (PointIntegral* point : points) {
    const double zenith_deg = moment_zenith_deg(scene, point->entry);
    for (std::size_t i = point->first_new; i < point->intervals.size(); ++i) {
      BandPiece& interval = point->intervals[i];
      const double half_um = 0.5 * (interval.to_um - interval.from_um);
      Integrals gauss = Integrals::Zero();
      for (const KronrodNode& node : kNodes) {
        const Integrals value =
            camera_response(scene.spectrum, *variants[next].wavelength_um) *
            integrand(results[next], mean_weight_at(scene, variants[next], cos_sin_deg(zenith_deg).cos));
        interval.value += half_um * node.kronrod * value;
        gauss += half_um * node.gauss * value;
        point->last = results[next++];
      }
      interval.error = (interval.value - gauss).abs();
    }
    point->first_new = point->intervals.size();
  }
}

PointResult band_result(const PointIntegral& point) {
  const Integrals value = sum_pieces(point.intervals, &BandPiece::value);
  const Integrals error = sum_pieces(point.intervals, &BandPiece::error);
  PointResult result = point.last;
  Eigen::Index i = 0;
  for (const Quantity quantity : kIntegrated) result[quantity] = value[i++];
  ++i;
  for (const Quantity quantity : kMeans) {
    if (!std::isnan(result[quantity])) result[quantity] = value[i] / value[kWeight];
    ++i;
  }
  const double intensity = std::abs(value[0]);
  result[kDolp] = std::hypot(value[1], value[2]) / value[0];
  result[kQOverI] = value[1] / value[0];
  result[kAolp] = polarisation_angle_deg(value[1], value[2]);
  result[kErrorEstimate] =
      (value[kDolpError] + std::hypot(error[1], error[2]) + std::abs(result[kDolp]) * error[0]) / intensity;
  result[kRhoErrorEstimate] =
      (value[kRhoError] + error.segment(kWeight + 1, kReflectances).sum()) / std::abs(value[kWeight + 1]) +
      error[kWeight] / value[kWeight];
  return result;
}

}  // namespace

std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress) {
  std::vector<std::vector<double>> variant_breaks;
  for (const SceneVariant& variant : points.variants())
    variant_breaks.push_back(band_breaks_um(with_variant(scene, variant)));
  std::vector<PointIntegral> integrals;
  for (const SceneEntry& entry : points.all()) {
    const std::vector<double>& breaks = variant_breaks[entry.variant];
    PointIntegral& point =
        integrals.emplace_back(PointIntegral{entry, points.variants()[entry.variant], breaks, {}, 0, {}});
    const std::size_t count = std::min(kFirstIntervals, breaks.size() - 1);
    for (std::size_t i = 0; i < count; ++i)
      point.intervals.push_back(
          {breaks[i * (breaks.size() - 1) / count], breaks[(i + 1) * (breaks.size() - 1) / count]});
  }
  std::vector<PointIntegral*> unfinished;
  for (PointIntegral& point : integrals) unfinished.push_back(&point);
  const Progress point_progress = [&](std::size_t, std::size_t) {
    return !progress || progress(points.size() - unfinished.size(), points.size());
  };
  while (!unfinished.empty()) {
    integrate_new(scene, unfinished, evaluator, point_progress);
    std::erase_if(unfinished, [&](PointIntegral* point) {
      const double error = quadrature_error(sum_pieces(point->intervals, &BandPiece::value),
                                            sum_pieces(point->intervals, &BandPiece::error));
      const bool is_finished =
          !(error > kQuadratureShare * scene.accuracy.tolerance) || point->intervals.size() >= kMostIntervals;
      if (!is_finished) split_worst(*point);
      return is_finished;
    });
  }
  std::vector<PointResult> results;
  for (const PointIntegral& point : integrals) results.push_back(band_result(point));
  std::vector<std::size_t> rule_entries;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (std::isnan(results[i][kDolp]) || !std::isnan(results[i][kDolpLow])) rule_entries.push_back(i);
  if (rule_entries.empty()) return results;
  const std::vector<PointResult> others = evaluate_scene(scene, points.chosen(rule_entries), evaluator, progress);
  for (std::size_t i = 0; i < rule_entries.size(); ++i) {
    PointResult& result = results[rule_entries[i]];
    if (std::isnan(result[kDolp])) result = others[i];
    result[kDolpLow] = others[i][kDolpLow];
    result[kDolpHigh] = others[i][kDolpHigh];
  }
  return results;
}

}  // namespace dolp
