// Finds the cheapest setting with which a method meets a tolerance. The study of peers uses it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "studies/grids.hpp"

namespace dolp::bench {

/// Entries with one masking. At these entries the study compares the errors of all methods.
struct PeerSample {
  PeerSample(Masking which, const std::vector<NestedGrid::Place>& sample_places);

  Masking masking;
  std::vector<NestedGrid::Place> places;
  MomentsRequest alone;  ///< requests these entries and no others
  std::vector<Truth> truths;
};

/// A request, and for each entry of the sample its position in this request.
struct PeerBatch {
  MomentsRequest request;
  std::vector<std::size_t> positions;

  /// The largest error over the entries of the sample; infinite if an error is NaN. `answers` belong to `request`.
  double worst_error(const std::vector<Answer>& answers, const PeerSample& sample) const;
};

/// A request for only the entries of the sample.
PeerBatch whole_sample(const PeerSample& sample);
/// A request for all entries of NestedGrid::with_stride(stride).
PeerBatch nested_grid(const PeerSample& sample, std::size_t stride);

/// Errors and times of one setting on each entry of the sample.
struct TriedSetting {
  double setting = 0.0;
  std::vector<double> errors = {};
  /// time per entry; for a batched method, the time of the call divided by the number of entries in the call
  std::vector<double> times_s = {};

  double worst_error() const;
};

/// Tries the settings of a method on a sample, from coarse to fine, until one takes too long. Per call, a batched
/// method computes a grid that contains the sample, and any other method computes one entry of the sample.
class PeerSettings {
 public:
  /// `most_s`: limit in seconds. After a setting that takes longer, no finer setting is tried.
  PeerSettings(const Method& method, Solver& solver, const PeerSample& sample, double most_s);

  /// The first setting that meets the tolerance at all entries of the sample; null if there is none.
  const TriedSetting* reaching(double tolerance);

  /// Stores `error`, a larger error that `setting` has on another grid. `reaching` then uses this error.
  void reject(const TriedSetting& setting, double error);

  /// The reason why `reaching` found no setting.
  const std::string& why_not() const { return why_not_; }

  /// Mean time per entry if a user chose for each entry the cheapest setting that meets the tolerance there. Users
  /// cannot do this, because they do not know the true errors. Empty if no setting meets the tolerance for some entry.
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
