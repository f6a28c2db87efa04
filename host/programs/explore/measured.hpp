// Measured points, and fits of the model to them.
#pragma once

#include <map>

#include "explore/background.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// The quantity of the plot in which an observable is shown.
Plotted plotted(Observable observable);

/// Reads measured points from a regular file, so that the window never waits for a pipe. Errors: InputError.
MeasuredData read_measured(const std::string& path);

/// Measured points, and the model at their zeniths and wavelengths.
class Residuals {
 public:
  explicit Residuals(const Scene& scene) : scene_(scene), loaded_for_(scene) {}

  /// Errors: InputError if the data come with settings KEY=VALUE, which only `dolp fit` accepts.
  void load(MeasuredData data);
  void clear() { data_.reset(); }
  void follow(const std::string& key, const Scene& scene);

  std::optional<Job> wanted() const { return data_ ? model_.wanted() : std::nullopt; }
  void take(const JobPart& news) { model_.take(news); }

  const std::optional<MeasuredData>& data() const { return data_; }
  /// The scene for which the data were loaded.
  const Scene& loaded_for() const { return loaded_for_; }
  bool is_known() const { return data_ && model_.is_finished(); }
  /// The measured points for a quantity.
  std::vector<Measurement> measured(Plotted quantity) const;
  /// The measured points for a quantity, each with measured minus model as its value. Leaves out points where the model
  /// has no value. Empty until the model has been computed.
  std::vector<Measurement> residuals(Plotted quantity) const;

 private:
  std::optional<MeasuredData> data_;
  std::size_t loads_ = 0;
  Scene scene_, loaded_for_;
  Sweep model_;
};

/// Root mean square of the values; empty without values.
std::optional<double> rms_of(const std::vector<Measurement>& residuals);

/// Keys that vary in fits, with the ranges that the user typed.
using FitMarks = std::map<std::string, std::optional<FitRange>>;

/// The range of a parameter in fits: the range that the user typed, or the part of the slider's range that the scene's
/// masking allows, extended to `value`. The range of k then begins at 0.001. The fit starts at `value`, if the range
/// contains it.
FitRange fit_range(const FitMarks& marks, const Scene& scene, const Control& control, double value);

/// All inputs of a fit, so that it can run on a separate thread.
struct FitJob {
  SceneEdits edits;
  MeasuredData data;
  std::vector<FitRange> vary;
};

/// Fits as `dolp fit` does. Errors: InputError if points, parameters and scene do not fit together or no minimum was
/// found; other errors of Evaluator::fit; Cancelled.
Fit run_fit(const FitJob& job, Evaluator& evaluator, const Progress& progress,
            const std::function<void(const std::string&)>& phase = {});

/// The position of the minimum that is nearest to the start of `job`. FitRange::coordinate measures the distance.
std::size_t nearest_minimum(const Fit& fit, const FitJob& job);

/// One line about a fit and the chosen minimum.
std::string fit_text(const Fit& fit, std::size_t chosen);

/// An interval as text: "1.2 to 1.5". An end that the range cuts off is "open".
std::string interval_text(const FitInterval& interval);

}  // namespace dolp::explore
