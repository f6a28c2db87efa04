#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// The moments of a plan's request. Moments that the plan interpolates over sigma and q are computed when they are
/// read.
class PlannedMoments {
 public:
  /// The computed moments of a step of the plan.
  struct Step {
    std::vector<Moments> moments;    ///< one for each entry of the step; empty if all are interpolated
    std::vector<ShapeBlock> blocks;  ///< for each bundle of the step; empty if `moments` has its entries
    std::vector<std::size_t> first;  ///< for each bundle, the position of its first entry in `moments`
  };

  PlannedMoments() = default;
  PlannedMoments(MomentsPlan plan, std::vector<Step> steps);

  /// Neighbouring entries. They are of one bundle, unless all entries are stored.
  struct Range {
    std::size_t first = 0;
    std::span<const Moments> moments;  ///< valid while the buffer that read() got is unchanged
  };
  /// The moments of some entries, among them `entry`.
  Range read(std::size_t entry, std::vector<Moments>& buffer) const;
  std::vector<Moments> all() const;

 private:
  struct Place {
    std::size_t first_entry = 0;  ///< of the bundle, in the request
    std::size_t step = 0;
    std::size_t position = 0;  ///< in the step
  };

  MomentsPlan plan_;
  std::vector<Step> steps_;
  std::vector<Place> places_;  ///< for each bundle
};

/// Reads moments in any order. It keeps the last range, because neighbouring entries mostly share one.
class MomentsReader {
 public:
  explicit MomentsReader(const PlannedMoments& moments) : moments_(&moments) {}

  /// The moments of consecutive entries, either one entry or entries that are stored. Valid until the next call.
  std::span<const Moments> read(std::size_t first, std::size_t count) {
    if (first < range_.first || first - range_.first >= range_.moments.size()) range_ = moments_->read(first, buffer_);
    return range_.moments.subspan(first - range_.first, count);
  }

 private:
  const PlannedMoments* moments_;
  PlannedMoments::Range range_;
  std::vector<Moments> buffer_;
};

/// Computes the moments of the plan's request. If a known moment of a bundle is infinite or NaN, the evaluator computes
/// all moments of the bundle instead of interpolating them. `work` gets counts and times. `progress`
/// counts entries. Errors: the evaluator's, and Cancelled if `progress` returns false.
PlannedMoments planned_moments(MomentsPlan plan, ModelEvaluator& evaluator, const Progress& progress, Work& work);

}  // namespace dolp
