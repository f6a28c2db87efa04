#include "run/response_bases.hpp"

#include <algorithm>

#include "model/sky_basis.hpp"
#include "plan/response_plan.hpp"
#include "run/part_requests.hpp"

namespace dolp {
namespace {

constexpr std::size_t kLeastEntries = 24;  // chosen, of an index: its weights take as long as some of them

std::vector<OpticalConstants> indices_of(const SceneValues& scene, const SceneEntries& entries) {
  const SceneEntries whole = SceneEntries::of_grid(entries.whole_axes(), entries.index());
  std::vector<OpticalConstants> indices;
  if (whole.has_own_index()) {
    PerAxis place{};
    for (std::size_t& n = place[Axis::kN]; n < whole.counts()[Axis::kN]; ++n) {
      std::size_t& k = place[Axis::kK];
      for (k = 0; k < whole.counts()[Axis::kK]; ++k) indices.push_back(whole.index_at(place));
    }
    return indices;
  }
  for (const std::vector<OpticalConstants>& own : spectral_indices(scene, whole)) {
    if (indices.size() < own.size() || !std::ranges::equal(own, std::span(indices).last(own.size())))
      indices.insert(indices.end(), own.begin(), own.end());
  }
  return indices;
}

}  // namespace

ResponseBases::ResponseBases(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan)
    : passes_(response_passes(plan.needs_direct, plan.sky ? plan.sky->size() : 0)) {
  const bool has_bounces = plan.kept.further_bounces && scene.surface.scattering == Scattering::kMultiple;
  const PerAxis& counts = entries.whole();
  const bool pays = counts[Axis::kTheta] * counts[Axis::kSigma] * counts[Axis::kQ] >= kLeastEntries;
  if (entries.is_grid() && pays && plan.kept.moments && !has_bounces) indices_ = indices_of(scene, entries);
}

std::shared_ptr<const ResponseBasis> ResponseBases::of(const RefinementLevel& level) {
  if (!level.may_interpolate || indices_.empty()) return nullptr;
  const auto [place, is_new] = of_tolerance_.try_emplace(level.tolerance);
  if (is_new) place->second = ResponseBasis::of(indices_, level.tolerance, passes_);
  return place->second;
}

}  // namespace dolp
