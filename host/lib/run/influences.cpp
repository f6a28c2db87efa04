#include "run/influences.hpp"

#include <algorithm>
#include <cmath>

#include <dolp/status.hpp>
#include "evaluate/cpu/cpu_evaluator.hpp"
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

}  // namespace

void add_influences(std::vector<EffectRow>& rows, const SceneValues& scene, const SceneEntries& entries) {
  const std::size_t samples = spectral_rule(scene).samples.size();
  const SceneEntries drawn =
      drawn_entries(entries, std::clamp<std::size_t>(kInfluenceMoments / samples, 2, kInfluenceEntries));
  SceneValues rough = scene;
  rough.accuracy = {.tolerance = kTolerance};
  if (rough.emission) rough.emission->has_bracket = false;
  CpuEvaluator evaluator(rough.accuracy.precision);
  const auto results_of = [&](const KeptEffects& kept) {
    return evaluate_scene(rough, drawn, plan_to_keep(rough, kept), &evaluator, {});
  };
  std::vector<PointResult> whole;
  for (EffectRow& row : rows) {
    if (row.state != EffectState::kKept || !row.part || row.influence) continue;
    if (whole.empty()) whole = results_of({});
    row.influence = largest_change(whole, results_of(without({}, *row.part)));
  }
}

}  // namespace dolp
