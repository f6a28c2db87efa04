#include "run/run_basis.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "model/sky_basis.hpp"
#include "plan/response_plan.hpp"
#include "run/part_requests.hpp"

namespace dolp {
namespace {

constexpr std::size_t kLeastEntries = 24;  // chosen, of an index: its weights take as long as some of them
// Of points: the directions and slope distributions times the indices, over the points. Each of the first is combined
// with all of the second.
constexpr std::size_t kMostOfPoints = 2;

std::vector<FacetOptics> indices_of_points(const SceneValues& scene, const SceneEntries& entries) {
  const SpectralIndices spectral = spectral_indices(scene, entries);
  const bool has_one_index =
      spectral.size() == 1 && spectral.front().size() == 1 &&
      std::ranges::none_of(entries.all(), [](const SceneEntry& e) { return e.index.has_value(); });
  if (has_one_index) return {};
  std::set<FacetOptics> indices;
  std::set<std::tuple<double, double, double>> shapes;
  std::size_t points = 0;
  const auto add = [&](const FacetOptics& index) { indices.insert(index); };
  for (const SceneEntry& entry : entries.all()) {
    shapes.insert({moment_zenith_deg(scene, entry.theta_deg), entry.shape.sigma, entry.shape.q});
    const std::vector<FacetOptics>& samples = spectral[entry.variant];
    if (entry.index) std::ranges::for_each(with_index(samples, entry.index), add);
    if (!entry.index) std::ranges::for_each(samples, add);
    points += entry.index && samples.front().is_bare() ? 1 : samples.size();
  }
  if (shapes.size() * indices.size() > kMostOfPoints * points) return {};
  return {indices.begin(), indices.end()};
}

std::vector<FacetOptics> indices_of_grid(const SceneValues& scene, const SceneEntries& entries) {
  const PerAxis& counts = entries.whole();
  if (counts[Axis::kTheta] * counts[Axis::kSigma] * counts[Axis::kQ] < kLeastEntries) return {};
  const SceneEntries whole = SceneEntries::of_grid(entries.whole_axes(), entries.index());
  std::vector<FacetOptics> indices;
  if (whole.has_own_index()) {
    PerAxis place{};
    for (const std::vector<FacetOptics>& samples : spectral_indices(scene, whole)) {
      for (std::size_t& n = place[Axis::kN] = 0; n < whole.counts()[Axis::kN]; ++n) {
        for (std::size_t& k = place[Axis::kK] = 0; k < whole.counts()[Axis::kK]; ++k) {
          const std::vector<FacetOptics> own = with_index(samples, whole.index_at(place));
          indices.insert(indices.end(), own.begin(), own.end());
        }
      }
      if (samples.front().is_bare()) break;  // they are the same at all wavelengths
    }
    return indices;
  }
  for (const std::vector<FacetOptics>& own : spectral_indices(scene, whole)) {
    if (indices.size() < own.size() || !std::ranges::equal(own, std::span(indices).last(own.size())))
      indices.insert(indices.end(), own.begin(), own.end());
  }
  return indices;
}

}  // namespace

std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan) {
  const bool has_bounces = plan.kept.further_bounces && scene.surface.scattering == Scattering::kMultiple;
  if (!scene.accuracy.may_interpolate || !plan.kept.moments || has_bounces) return nullptr;
  const std::vector<FacetOptics> indices =
      entries.is_grid() ? indices_of_grid(scene, entries) : indices_of_points(scene, entries);
  const std::size_t passes = response_passes(plan.needs_direct, plan.sky ? plan.sky->size() : 0);
  return indices.empty() ? nullptr : ResponseBasis::of(indices, scene.accuracy.tolerance, passes);
}

}  // namespace dolp
