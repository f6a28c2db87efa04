#include "spectrum/spectral_rule.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostKeptSamples = std::size_t{1} << 16U;  // with a sky, a sample takes 1.5 KiB

/// True if the rules of two variants may have different numbers of samples.
bool differ(const SceneVariant& a, const SceneVariant& b) {
  return a.material != b.material || a.band != b.band || a.films != b.films;
}

}  // namespace

SpectralRules::SpectralRules(const SceneModel& scene, const SceneEntries& entries)
    : scene_(scene), is_thin_(!entries.has_own_index()) {
  const std::vector<SceneVariant>& variants = entries.variants();
  std::vector<std::shared_ptr<const SpectralRule>> rules(variants.size());
  rules.front() = computed(variants.front());
  if (rules.front()->samples.size() * variants.size() > kMostKeptSamples) return;
  parallel_for(variants.size() - 1, 1, [&](std::size_t i) { rules[i + 1] = computed(variants[i + 1]); });
  for (std::size_t i = 0; i < variants.size(); ++i) kept_.emplace(variants[i], std::move(rules[i]));
}

std::shared_ptr<const SpectralRule> SpectralRules::computed(const SceneVariant& variant) const {
  const SceneModel scene = with_variant(scene_, variant);
  SpectralRule rule = spectral_rule(scene);
  return std::make_shared<const SpectralRule>(is_thin_ ? thinned_rule(scene, std::move(rule)) : std::move(rule));
}

std::shared_ptr<const SpectralRule> SpectralRules::at(const SceneVariant& variant) const {
  const auto kept = kept_.find(variant);
  return kept == kept_.end() ? computed(variant) : kept->second;
}

std::size_t SpectralRules::most_samples(const SceneEntries& entries) const {
  if (!scene_.spectrum.is_band()) return 1;
  std::size_t most = 0;
  const SceneVariant* last = nullptr;
  for (const SceneVariant& variant : entries.variants()) {
    if (!last || differ(*last, variant)) most = std::max(most, at(variant)->samples.size());
    last = &variant;
  }
  return most;
}

}  // namespace dolp
