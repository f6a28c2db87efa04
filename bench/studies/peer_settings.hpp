// Search for the cheapest setting of a method that reaches an accuracy, for the study of peers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "studies/grids.hpp"

namespace dolp::bench {

/// Entries of one masking on which all methods are compared.
struct PeerSample {
  PeerSample(Masking which, const std::vector<NestedGrid::Place>& sample_places);

  Masking masking;
  std::vector<NestedGrid::Place> places;
  MomentsRequest alone;  ///< a request with only the entries of the sample
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
  /// time per entry; methods for many entries per call have one time per call, divided by its entries
  std::vector<double> times_s = {};

  double worst_error() const;
};

/// The settings of one method for one sample, from coarse to fine, as far as they are worth trying. Methods for many
/// entries per call compute the smallest nested grid, the other methods each entry of the sample separately.
class PeerSettings {
 public:
  /// Stops after a call that takes longer than `most_s`.
  PeerSettings(const Method& method, Solver& solver, const PeerSample& sample, double most_s);

  /// Tries settings until one keeps the tolerance at all entries; null if none does.
  const TriedSetting* reaching(double tolerance);

  /// Records a larger error of a setting, found on other entries.
  void reject(const TriedSetting& setting, double error);

  /// The reason why no more settings were tried.
  const std::string& why_not() const { return why_not_; }

  /// Mean time per entry if each entry has the cheapest setting that meets the tolerance. Such a choice is possible
  /// only if the truth is known. Empty if no setting meets the tolerance at some entry.
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
