// A fit of the window's parameters to measured points.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "explore/measured.hpp"
#include "explore/parameters.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// A number that may vary, over the range of its slider, from the scene's value on.
struct Varied {
  std::string key;
  double low = 0.0;
  double high = 0.0;
  double start = 0.0;
};

/// Everything that a fit needs, so that it can run in a thread of its own.
struct FitJob {
  Scene scene;
  MeasuredData data;
  std::vector<Varied> varied;
};

/// The result of a fit.
struct FitFound {
  std::vector<Setting> values;
  std::map<std::string, FitInterval> interval_68, interval_95;  ///< by key
  std::string text;                                             ///< one line
};

/// Fits as `dolp fit` does. Errors: InputError where points, parameters and scene do not fit together and where no
/// minimum was found; those of Evaluator::fit; Cancelled.
FitFound run_fit(const FitJob& job, Evaluator& evaluator, const Progress& progress);

/// The varied parameters, and the result of the last fit as long as the scene has not changed since.
class Fitting {
 public:
  /// True where a parameter can vary at all.
  static bool can_vary(const Parameter& parameter);

  bool varies(const std::string& key) const { return marked_.contains(key); }
  void mark(const std::string& key, bool varies);

  /// The job of a fit; none without points, or without a marked parameter that the scene has.
  std::optional<FitJob> job(const Scene& scene, const std::optional<MeasuredPoints>& points) const;

  void take(FitFound found, std::vector<Setting> changes);
  /// Null once the scene has other changes than those that the fit left.
  const FitFound* found(const std::vector<Setting>& changes) const;

 private:
  std::set<std::string> marked_;
  std::optional<FitFound> found_;
  std::vector<Setting> changes_;  ///< of the scene with what was found
};

}  // namespace dolp::explore
