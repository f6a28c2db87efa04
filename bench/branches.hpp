// Specialised kernels against one kernel for all models, which branches by uniform values.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/moments.hpp"

namespace dolp::bench {

/// Times of both kernels for one request, in turns, and how their moments differ.
struct BranchTimes {
  std::vector<double> specialised_s;  ///< in kernels, of one call each; the masking tables are those of one kernel
  std::vector<double> uniform_s;      ///< likewise
  double error = 0.0;                 ///< largest max(|d r_i|, |d r_q|)/r_i of an entry
};

/// Both kernels on one device, in float. They are one text; that of uniform branches hides distribution and masking
/// from the compiler, so that it holds the code of all of them and decides while it runs.
class BranchComparison {
 public:
  /// Errors: DeviceError when there is no usable device.
  explicit BranchComparison(const std::string& device);
  BranchComparison(const BranchComparison&) = delete;
  BranchComparison& operator=(const BranchComparison&) = delete;
  ~BranchComparison();

  /// `repeats` times of each, after a warm-up. Errors: DeviceError.
  BranchTimes compare(const MomentsRequest& request, std::size_t repeats);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp::bench
