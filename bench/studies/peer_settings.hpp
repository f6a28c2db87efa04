// Search for the cheapest setting of a method that is fine enough, for the study of peers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "studies/grids.hpp"

namespace dolp::bench {

/// Entries of one masking that all methods are judged by.
struct PeerSample {
  PeerSample(Masking which, const std::vector<NestedGrid::Place>& sample_places);

  Masking masking;
  std::vector<NestedGrid::Place> places;
  MomentsRequest alone;  ///< the sample's entries and no others
  std::vector<Truth> truths;
};

/// Entries to solve, and the positions of the sample among them.
struct PeerBatch {
  MomentsRequest request;
  std::vector<std::size_t> positions;

  /// The largest error of the answers to the request; infinite for NaN.
  double worst_error(const std::vector<Answer>& answers, const PeerSample& sample) const;
};

/// The entries of the sample.
PeerBatch whole_sample(const PeerSample& sample);
/// The nested grid of a stride.
PeerBatch nested_grid(const PeerSample& sample, std::size_t stride);

/// Errors and times of one setting on each entry of the sample.
struct TriedSetting {
  double setting = 0.0;
  std::vector<double> errors = {};
  std::vector<double> times_s = {};  ///< an entry; of methods for many entries a call, that of all in it

  double worst_error() const;
};

/// The settings of one method for one sample, from coarse to fine, as far as they are worth trying. Methods for many
/// entries a call do the smallest nested grid, the others the entries of the sample one by one.
class PeerSettings {
 public:
  /// A call that takes longer than `most_s` is the last.
  PeerSettings(const Method& method, Solver& solver, const PeerSample& sample, double most_s);

  /// Tries settings until one gives all entries the tolerance; null when none does.
  const TriedSetting* reaching(double tolerance);

  /// Records that a setting has a larger error after all, on other entries.
  void reject(const TriedSetting& setting, double error);

  /// The reason why no further setting was tried.
  const std::string& why_not() const { return why_not_; }

  /// Mean time of an entry when each has the cheapest setting that meets the tolerance: a choice that requires
  /// knowledge of the truth. Nothing when one entry has none.
  std::optional<double> with_hindsight(double tolerance) const;

 private:
  void warm_up();
  bool try_next();
  double try_grid(TriedSetting& tried);
  double try_each(TriedSetting& tried);

  const Method& method_;
  Solver& solver_;
  const PeerSample& sample_;
  double most_s_;
  std::vector<TriedSetting> tried_;
  bool is_over_ = false;
  std::string why_not_;
};

}  // namespace dolp::bench
