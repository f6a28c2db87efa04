// For the study of peers: search for the cheapest setting with which a method meets a tolerance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "studies/grids.hpp"

namespace dolp::bench {

/// Entries on which all methods are compared, for one masking.
struct PeerSample {
  PeerSample(Masking which, const std::vector<NestedGrid::Place>& sample_places);

  Masking masking;
  std::vector<NestedGrid::Place> places;
  MomentsRequest alone;  ///< a request with only the entries of the sample
  std::vector<Truth> truths;
};

/// Entries to compute, and which of them belong to the sample.
struct PeerBatch {
  MomentsRequest request;
  std::vector<std::size_t> positions;

  /// The largest error over the entries of the sample; infinite if one is NaN. `answers` belong to `request`.
  double worst_error(const std::vector<Answer>& answers, const PeerSample& sample) const;
};

/// A batch of only the entries of the sample.
PeerBatch whole_sample(const PeerSample& sample);
/// A batch of the nested grid with this stride.
PeerBatch nested_grid(const PeerSample& sample, std::size_t stride);

/// Errors and times of one setting on each entry of the sample.
struct TriedSetting {
  double setting = 0.0;
  std::vector<double> errors = {};
  /// time per entry; for a batched method the time of the call divided by its number of entries
  std::vector<double> times_s = {};

  double worst_error() const;
};

/// Tries the settings of one method on one sample, from coarse to fine, until a call takes too long. A batched method
/// computes a nested grid in one call; any other method computes the entries of the sample one by one.
class PeerSettings {
 public:
  /// `most_s`: after a run that takes more seconds, no finer setting is tried.
  PeerSettings(const Method& method, Solver& solver, const PeerSample& sample, double most_s);

  /// The first setting that meets the tolerance at all entries of the sample; null if there is none.
  const TriedSetting* reaching(double tolerance);

  /// Records a larger error of a setting, which a run on a larger grid has shown.
  void reject(const TriedSetting& setting, double error);

  /// The reason why `reaching` found no setting.
  const std::string& why_not() const { return why_not_; }

  /// Mean time per entry if each entry had its cheapest setting that meets the tolerance. In practice this choice is
  /// impossible, because it needs the truth. Empty if some entry has no such setting.
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
