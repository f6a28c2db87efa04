#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/moments.hpp"
#include "plan/response_plan.hpp"
#include "plan/shape_plan.hpp"

namespace dolp {

struct MomentsStep {
  std::vector<std::size_t> bundles;       ///< positions in the request's bundles
  MomentsRequest request;                 ///< the request for these bundles
  std::optional<ShapePlan> shapes;        ///< for interpolation over sigma and q; empty without it
  std::optional<ResponsePlan> responses;  ///< for weighted sums of responses; empty if each index is computed

  const MomentsRequest& nodes() const { return shapes ? shapes->nodes : request; }
  bool saves_work() const { return shapes || responses; }
  std::vector<const MomentsRequest*> kernel_requests() const;
};

/// The plan depends only on the request. The moments of an entry of a grid do not depend on other directions.
class MomentsPlan {
 public:
  MomentsPlan() = default;
  explicit MomentsPlan(const MomentsRequest& request);

  std::size_t size() const { return size_; }        ///< entries of the request
  std::size_t bundles() const { return bundles_; }  ///< bundles of the request
  std::span<const MomentsStep> steps() const { return steps_; }
  /// Entries that are interpolated, or combined from responses, instead of computed by a kernel.
  std::size_t saved_entries() const;
  /// Number of moments that the kernels compute as input for the saved entries.
  std::size_t nodes_of_saved() const;
  std::size_t kernel_moments() const;
  /// For each bundle: 1 if its entries are interpolated or combined from responses.
  std::vector<char> saving_bundles() const;

 private:
  /// Adds a step, or several steps if the responses of the step would take too much memory.
  void add(MomentsStep step);

  std::size_t size_ = 0;
  std::size_t bundles_ = 0;
  std::vector<MomentsStep> steps_;
};

}  // namespace dolp
