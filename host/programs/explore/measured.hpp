// Measured points beside the model, and the model's fit to them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/background.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// The shown quantity that was measured.
Plotted plotted(Observable observable);

/// The measured points of a regular file: the window never waits for a pipe. Errors: InputError.
MeasuredData read_measured(const std::string& path);

/// The model at the measured points.
class Residuals {
 public:
  explicit Residuals(const Scene& scene) : scene_(scene) {}

  /// Errors: InputError for data with settings of their own.
  void load(MeasuredData data);
  void clear() { data_.reset(); }
  void follow(const std::string& key, const Scene& scene);

  std::optional<Job> wanted() const;
  bool take(const JobPart& news);

  const std::optional<MeasuredData>& data() const { return data_; }
  /// The measured points of a quantity.
  std::vector<Measurement> measured(Plotted quantity) const;
  /// Measured minus model of each point, NaN where the model gives none; empty until it is known.
  std::vector<double> residuals() const;
  /// Root mean square of a quantity's residuals that are numbers; none without any.
  std::optional<double> rms(Plotted quantity) const;

 private:
  std::string job_key() const;

  std::optional<MeasuredData> data_;
  std::size_t loads_ = 0;
  std::string key_;
  Scene scene_;
  std::string known_;  ///< key of the job whose results are here
  std::vector<Point> model_;
};

/// Everything that a fit needs, so that it can run in a thread of its own.
struct FitJob {
  SceneEdits edits;
  MeasuredData data;
  std::vector<FitRange> vary;
};

/// Fits as `dolp fit` does. Errors: InputError where points, parameters and scene do not fit together and where no
/// minimum was found; those of Evaluator::fit; Cancelled.
Fit run_fit(const FitJob& job, Evaluator& evaluator, const Progress& progress,
            const std::function<void(const std::string&)>& phase = {});

/// The position among a fit's minima of the one nearest to where the job started, by the coordinates of its ranges.
std::size_t nearest_minimum(const Fit& fit, const FitJob& job);

/// The result of a fit, of which a minimum was chosen, in one line.
std::string fit_text(const Fit& fit, std::size_t chosen);

/// "1.2 to 1.5"; an end that the range cuts off is "open".
std::string interval_text(const FitInterval& interval);

}  // namespace dolp::explore
