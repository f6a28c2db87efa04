#include "run/scattering_gap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <dolp/status.hpp>
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/direction.hpp"
#include "run/drawn_entries.hpp"
#include "run/scene_run.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

constexpr double kGapTolerance = 1e-3;
constexpr std::size_t kGapMoments = 64;  // at most, but of one entry

bool has_gap(const SceneValues& scene, const EffectPlan& plan) {
  return plan.needs_moments && scene.emission && scene.emission->model != EmissionModel::kFresnel &&
         scene.surface.scattering == Scattering::kSingle && has_direct_emission(scene.surface.masking) &&
         scene.geometry.mode == Mode::kHemispherical;
}

std::vector<PointResult> results_with(SceneValues scene, EmissionModel model, const SceneEntries& entries) {
  scene.emission->model = model;
  scene.emission->has_bracket = false;
  scene.accuracy = {.tolerance = kGapTolerance};
  CpuEvaluator evaluator(scene.accuracy.precision);
  return evaluate_scene(scene, entries, evaluator, {});
}

}  // namespace

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
