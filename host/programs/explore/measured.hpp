#pragma once

#include <map>

#include "explore/background.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

Plotted plotted(Observable observable);  ///< the quantity of the plot in which measured values of `observable` appear

/// Reads measured points. Accepts only a regular file, because the window must not wait for a pipe. Errors: InputError.
MeasuredData read_measured(const std::string& path);

/// Measured points, and the results of the scene at the zeniths and wavelengths of these points.
class Residuals {
 public:
  explicit Residuals(const Scene& scene) : scene_(scene), loaded_for_(scene) {}

  /// Errors: InputError if the data file contains settings KEY=VALUE, which only `dolp fit` accepts.
  void load(MeasuredData data);
  void clear() { data_.reset(); }
  void follow(const std::string& key, const Scene& scene);

  std::optional<Job> wanted() const { return data_ ? model_.wanted() : std::nullopt; }
  void take(const JobResult& news) { model_.take(news); }

  const std::optional<MeasuredData>& data() const { return data_; }
  const Scene& loaded_for() const { return loaded_for_; }
  bool is_known() const { return data_ && model_.is_finished(); }
  std::vector<Measurement> measured(Plotted quantity) const;
  /// Measured minus computed values. Omits points for which the model gives no value. Empty until is_known() is true.
  std::vector<Measurement> residuals(Plotted quantity) const;

 private:
  std::optional<MeasuredData> data_;
  std::size_t loads_ = 0;
  Scene scene_, loaded_for_;
  Sweep model_;
};

std::optional<double> residual_rms(
    const std::vector<Measurement>& residuals);  ///< root mean square; empty without residuals

/// The scene keys of the numbers that vary in fits. Each key has a range if the user typed one.
using FitMarks = std::map<std::string, std::optional<FitRange>>;

/// The range of a number in a fit, and the start of the fit. `value` is the number in the scene. The range is the one
/// in `marks` if the user typed one. Otherwise it is the slider's range, extended to contain `value`; for k it begins
/// above 0. The fit starts at the number in the range that is nearest to `value`.
FitRange fit_range(const FitMarks& marks, const Scene& scene, const Control& control, double value);

struct FitJob {
  SceneEdits edits;
  MeasuredData data;
  std::vector<FitRange> vary;
};

/// Position in Fit::minima of the minimum nearest to the start. Distances are measured in FitRange::coordinate().
std::size_t nearest_minimum(const Fit& fit, const FitJob& job);

std::string fit_text(const Fit& fit, std::size_t chosen);  ///< one line about Fit::minima[chosen]
std::string interval_text(const FitInterval& interval);    ///< "1.2 to 1.5"; "open" for an end without a value

}  // namespace dolp::explore
