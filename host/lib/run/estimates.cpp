#include "run/estimates.hpp"

#include <algorithm>
#include <cmath>

#include <dolp/status.hpp>
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/direction.hpp"
#include "run/drawn_entries.hpp"
#include "run/scene_run.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

constexpr double kTolerance = 1e-3;
constexpr std::size_t kInfluenceMoments = 48;  // at most, but of two entries

double polarisation_change(const PointResult& a, const PointResult& b) {
  using enum Quantity;
  return std::hypot(a[kStokesQ] / a[kStokesI] - b[kStokesQ] / b[kStokesI],
                    a[kStokesU] / a[kStokesI] - b[kStokesU] / b[kStokesI]);
}

std::optional<double> largest_change(const std::vector<PointResult>& a, const std::vector<PointResult>& b) {
  std::optional<double> largest;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!promises_dolp(a[i].status) || !promises_dolp(b[i].status)) continue;
    largest = std::max(largest.value_or(0.0), polarisation_change(a[i], b[i]));
  }
  return largest;
}

constexpr std::size_t kGapMoments = 64;  // at most, but of one entry

bool has_gap(const SceneValues& scene, const EffectPlan& plan) {
  return plan.kept.moments && scene.emission && scene.emission->model != EmissionModel::kFresnel &&
         scene.surface.scattering == Scattering::kSingle && keeps_projected_area(scene.surface.masking) &&
         scene.geometry.mode == Mode::kHemispherical;
}

std::vector<PointResult> results_with(SceneValues scene, EmissionModel model, const SceneEntries& entries) {
  scene.emission->model = model;
  scene.emission->has_bracket = false;
  scene.accuracy = {.tolerance = kTolerance};
  CpuEvaluator evaluator;
  return evaluate_scene(scene, entries, evaluator, {});
}

}  // namespace

void add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries) {
  const std::size_t samples = spectral_rule(scene).samples.size();
  const SceneEntries drawn =
      drawn_entries(entries, std::clamp<std::size_t>(kInfluenceMoments / samples, 2, kInfluenceEntries));
  SceneValues rough = scene;
  rough.accuracy = {.tolerance = kTolerance};
  if (rough.emission) rough.emission->has_bracket = false;
  CpuEvaluator evaluator;
  const auto results_of = [&](const KeptEffects& kept) {
    return evaluate_scene(rough, drawn, evaluator, {}, plan_to_keep(rough, kept));
  };
  std::vector<PointResult> whole;
  for (Effect& row : rows) {
    if (row.state != EffectState::kKept || !row.part || row.influence) continue;
    if (whole.empty()) whole = results_of({});
    row.influence = largest_change(whole, results_of(without({}, *row.part)));
  }
}

std::optional<double> scattering_gap(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan) {
  if (!has_gap(scene, plan)) return {};
  const std::size_t samples = spectral_rule(scene).samples.size();
  const SceneEntries drawn = drawn_entries(entries, std::clamp<std::size_t>(kGapMoments / samples, 1, kGapEntries));
  const std::vector<PointResult> kirchhoff = results_with(scene, EmissionModel::kMoments, drawn);
  const std::vector<PointResult> direct = results_with(scene, EmissionModel::kDirect, drawn);
  std::optional<double> gap;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (!promises_dolp(kirchhoff[i].status) || !promises_dolp(direct[i].status)) continue;
    gap = std::max(gap.value_or(0.0), std::abs(kirchhoff[i][Quantity::kDolp] - direct[i][Quantity::kDolp]));
  }
  return gap;
}

}  // namespace dolp
