#include "run/estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include <dolp/status.hpp>
#include <set>
#include <utility>
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/remembering_evaluator.hpp"
#include "model/direction.hpp"
#include "run/scene_run.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

// Multiples of this number, modulo 1, fill [0, 1] evenly without following the regular steps of a grid.
constexpr double kGoldenRatio = 0.6180339887498949;

using enum Quantity;

constexpr double kTolerance = 1e-3;
constexpr std::size_t kBandWavelengths = 8;
constexpr std::size_t kDrawnPoints = 24;  // number of entries that an estimate computes from a list of points

/// How many values of an axis an estimate uses at most. For sigma and q, 2 suffice: effects are largest at an end.
std::size_t most_values(Axis axis) {
  if (axis == Axis::kMaterial) return 64;
  if (axis == Axis::kTheta || axis == Axis::kViewZenith || axis == Axis::kBand) return 8;
  return axis == Axis::kWavelength || axis == Axis::kRelativeAzimuth ? 3 : 2;
}

std::vector<std::size_t> spread_positions(std::size_t size, std::size_t most) {
  std::vector<std::size_t> positions;
  const std::size_t count = std::min(size, most);
  for (std::size_t i = 0; i < count; ++i) positions.push_back(count == 1 ? 0 : (i * (size - 1)) / (count - 1));
  return positions;
}

SceneEntries spread_entries(const SceneEntries& entries) {
  if (!entries.is_grid()) return drawn_entries(entries, kDrawnPoints);
  std::vector<std::size_t> positions;
  const PerAxis& counts = entries.counts();
  AxisArray<std::vector<std::size_t>> values;
  PerAxis value_counts{};
  for (const Axis axis : kAllAxes) {
    values[axis] = spread_positions(counts[axis], most_values(axis));
    // Most light is lost near 90 degrees, and the last zenith may be 90 degrees, where DOLP is a limit or unknown.
    const bool is_zenith = axis == Axis::kTheta || axis == Axis::kViewZenith;
    if (is_zenith && counts[axis] > most_values(axis)) values[axis].insert(values[axis].end() - 1, counts[axis] - 2);
    value_counts[axis] = values[axis].size();
  }
  for (std::size_t i = 0; i < grid_size(value_counts); ++i) {
    const PerAxis chosen = positions_on_axes(i, value_counts);
    std::size_t position = 0;
    for (const Axis axis : kAllAxes) position = position * counts[axis] + values[axis][chosen[axis]];
    positions.push_back(position);
  }
  return entries.chosen(positions);
}

struct Sample {
  SceneValues scene;
  SceneEntries entries;         ///< each chosen entry, repeated for each wavelength
  std::vector<double> weights;  ///< weights of the wavelengths in the integral over a band; {1} without a band
};

/// Multiplies the weights of the wavelengths at `shares` of the band by the response, unless it is 0 at all of them.
void weight_by_response(std::vector<double>& weights, const Spectrum& band, const std::vector<double>& shares) {
  std::vector<double> weighted;
  for (std::size_t j = 0; j < weights.size(); ++j)
    weighted.push_back(weights[j] * band.weight(std::lerp(band.min_um, band.max_um, shares[j])));
  if (std::ranges::max(weighted) > 0.0) weights = weighted;
}

Sample draw_sample(const SceneValues& scene, const SceneEntries& entries, const SpectralRules& rules) {
  Sample sample{scene, spread_entries(entries), {1.0}};
  // Float is enough for an estimate. Repeating inaccurate entries in double could take longer than the whole table.
  sample.scene.accuracy = {.tolerance = kTolerance, .precision = Precision::kFloat};
  if (sample.scene.emission) sample.scene.emission->has_bracket = false;
  if (rules.most_samples(entries) <= kBandWavelengths) return sample;
  using Rule = boost::math::quadrature::gauss<double, kBandWavelengths>;
  std::vector<double> shares;  // positions of the nodes in the band, from 0 (lower end) to 1 (upper end)
  sample.weights.clear();
  for (std::size_t i = 0; i < kBandWavelengths / 2; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      shares.push_back(0.5 + 0.5 * sign * Rule::abscissa()[i]);
      sample.weights.push_back(Rule::weights()[i]);
    }
  }
  std::vector<SceneEntry> all;
  for (SceneEntry entry : sample.entries.all()) {
    const std::uint32_t first = entry.variant * static_cast<std::uint32_t>(kBandWavelengths);
    for (std::uint32_t j = 0; j < kBandWavelengths; ++j) {
      entry.variant = first + j;
      all.push_back(entry);
    }
  }
  std::vector<SceneVariant> variants;
  for (const SceneVariant& variant : sample.entries.variants()) {
    const Spectrum band = variant.band ? scene.bands[*variant.band] : scene.spectrum;
    for (const double share : shares)
      variants.emplace_back(variant).wavelength_um = std::lerp(band.min_um, band.max_um, share);
  }
  if (scene.spectrum.response) weight_by_response(sample.weights, scene.spectrum, shares);
  sample.scene.spectrum.max_um = sample.scene.spectrum.min_um;
  sample.entries = {std::move(all), std::move(variants)};
  return sample;
}

PointResult weighted_sum(std::span<const PointResult> results, std::span<const double> weights) {
  if (results.size() == 1) return results.front();
  PointResult sum;
  for (const Quantity stokes : {kStokesI, kStokesQ, kStokesU}) sum[stokes] = 0.0;
  double changed = 0.0;
  double dolp_changed = 0.0;
  for (std::size_t j = 0; j < results.size(); ++j) {
    for (const Quantity stokes : {kStokesI, kStokesQ, kStokesU}) sum[stokes] += weights[j] * results[j][stokes];
    changed += weights[j] * results[j].model_change * std::abs(results[j][kStokesI]);
    dolp_changed += weights[j] * results[j].model_change_dolp * std::abs(results[j][kStokesI]);
    sum.status |= results[j].status;
  }
  sum.model_change = changed / std::abs(sum[kStokesI]);
  sum.model_change_dolp = dolp_changed / std::abs(sum[kStokesI]);
  sum[kDolp] = std::hypot(sum[kStokesQ], sum[kStokesU]) / sum[kStokesI];
  return sum;
}

std::vector<PointResult> sample_results(const Sample& sample, ModelEvaluator& evaluator, const EffectPlan& plan) {
  const std::vector<PointResult> all = evaluate_scene(sample.scene, sample.entries, evaluator, {}, plan);
  std::vector<PointResult> sums;
  const std::size_t count = sample.weights.size();
  for (std::size_t i = 0; i < all.size(); i += count) {
    sums.push_back(weighted_sum(std::span(all).subspan(i, count), sample.weights));
  }
  return sums;
}

std::vector<PointResult> sample_results(const Sample& sample) {
  CpuEvaluator evaluator;
  return sample_results(sample, evaluator, keep_everything(sample.scene));
}

double polarisation_change(const PointResult& a, const PointResult& b) {
  return std::hypot(a[kStokesQ] / a[kStokesI] - b[kStokesQ] / b[kStokesI],
                    a[kStokesU] / a[kStokesI] - b[kStokesU] / b[kStokesI]);
}

/// The largest change(a, b) among entries for which promises_dolp() holds in `a` and in `b`. Empty if there is none.
template <class Change>
std::optional<double> largest_change(const std::vector<PointResult>& a, const std::vector<PointResult>& b,
                                     const Change& change) {
  std::optional<double> largest;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!promises_dolp(a[i].status) || !promises_dolp(b[i].status)) continue;
    largest = std::max(largest.value_or(0.0), change(a[i], b[i]));
  }
  return largest;
}

bool has_gap(const SceneValues& scene, const EffectPlan& plan) {
  return plan.gives_albedo && scene.emission && scene.emission->model != EmissionModel::kFresnel &&
         scene.surface.scattering == Scattering::kSingle && keeps_projected_area(scene.surface.masking) &&
         scene.geometry.mode == Mode::kHemispherical;
}

Looked looked_at(const Sample& sample) {
  return {sample.entries.size() / sample.weights.size(), sample.weights.size()};
}

}  // namespace

std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count) {
  std::set<std::size_t> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = std::fmod(static_cast<double>(i + 1) * kGoldenRatio, 1.0);
    positions.insert(static_cast<std::size_t>(part * static_cast<double>(size)));
  }
  return {positions.begin(), positions.end()};
}

SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count) {
  if (entries.size() <= count) return entries;
  return entries.chosen(drawn_positions(entries.size(), count));
}

std::string Looked::text() const {
  const std::string counted = fmt::format("{} {}", entries, entries == 1 ? "entry" : "entries");
  return wavelengths == 1 ? counted : fmt::format("{} and {} wavelengths of the band", counted, wavelengths);
}

Influences add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries,
                          const EffectPlan& plan) {
  const Sample sample = draw_sample(scene, entries, *with_spectra(plan, scene, entries).rules);
  const EffectPlan all = with_spectra(plan_to_keep(sample.scene, {}), sample.scene, sample.entries);
  CpuEvaluator cpu;
  // The same moments, with and without an effect, give its influence.
  RememberingEvaluator evaluator(cpu, [](const MomentsRequest&) { return true; });
  const std::vector<PointResult> whole = sample_results(sample, evaluator, all);
  for (Effect& row : rows) {
    if (row.state != EffectState::kKept || !row.part || row.influence) continue;
    EffectPlan others = plan_to_keep(sample.scene, without({}, *row.part));
    others.rules = all.rules;
    if (others.kept.moments && others.kept.surroundings && others.kept.profile) others.sky = all.sky;
    row.influence = largest_change(whole, sample_results(sample, evaluator, others), polarisation_change);
  }
  Influences influences{looked_at(sample)};
  for (const PointResult& result : whole) influences.model_change.add(result);
  influences.evaluations = evaluator.report().evaluations;
  return influences;
}

std::optional<ScatteringGap> scattering_gap(const SceneValues& scene, const SceneEntries& entries,
                                            const EffectPlan& plan) {
  if (entries.empty() || !has_gap(scene, plan)) return {};
  Sample sample = draw_sample(scene, entries, *plan.rules);
  sample.scene.emission->model = EmissionModel::kMoments;
  const std::vector<PointResult> kirchhoff = sample_results(sample);
  sample.scene.emission->model = EmissionModel::kDirect;
  const std::vector<PointResult> direct = sample_results(sample);
  const std::optional<double> dolp = largest_change(
      kirchhoff, direct, [](const PointResult& a, const PointResult& b) { return std::abs(a[kDolp] - b[kDolp]); });
  return dolp ? std::optional(ScatteringGap{*dolp, looked_at(sample)}) : std::nullopt;
}

}  // namespace dolp
