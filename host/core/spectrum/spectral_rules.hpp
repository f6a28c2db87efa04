#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "model/scene_entry.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// The spectral rules of a run, one for each variant of its entries. All steps of the run share them.
class SpectralRules {
 public:
  /// The rules are thin (thinned_rule) unless entries replace the medium of the scene.
  SpectralRules(const SceneModel& scene, const SceneEntries& entries);

  /// The rule of a variant. If the rules of all variants would need too much memory, at() computes the rule anew.
  std::shared_ptr<const SpectralRule> at(const SceneVariant& variant) const;

  /// Largest number of samples among the rules of `entries`.
  std::size_t most_samples(const SceneEntries& entries) const;

 private:
  std::shared_ptr<const SpectralRule> computed(const SceneVariant& variant) const;

  SceneModel scene_;
  bool is_thin_;
  std::map<SceneVariant, std::shared_ptr<const SpectralRule>> kept_;
};

}  // namespace dolp
