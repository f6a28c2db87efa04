// Measured points beside the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/plotted.hpp"
#include "explore/worker.hpp"

namespace dolp::explore {

/// One value, as measured.
struct MeasuredPoint {
  Plotted quantity = Plotted::kDolp;
  double theta_deg = 0.0;
  double value = 0.0;
  std::optional<double> uncertainty;  ///< one standard deviation
};

/// The content of a file of `dolp fit --data`.
struct MeasuredPoints {
  MeasuredData data;
  std::vector<MeasuredPoint> points;
  std::vector<double> wavelength_um;  ///< of each point; empty: the scene's
};

/// Errors: those of MeasuredData; InputError for data with keys of their own.
MeasuredPoints points_of(MeasuredData data);

/// The model at the measured points.
class Residuals {
 public:
  explicit Residuals(const Scene& scene) : scene_(scene) {}

  void load(MeasuredPoints points);
  void clear() { points_.reset(); }
  void follow(const std::string& key, const Scene& scene);

  std::optional<Job> wanted() const;
  bool take(const JobPart& news);

  const std::optional<MeasuredPoints>& points() const { return points_; }
  /// Measured minus model of each point, NaN where the model gives none; empty until it is known.
  std::vector<double> residuals() const;
  /// Root mean square of a quantity's residuals that are numbers; none without any.
  std::optional<double> rms(Plotted quantity) const;

 private:
  std::string job_key() const;

  std::optional<MeasuredPoints> points_;
  std::size_t loads_ = 0;
  std::string key_;
  Scene scene_;
  std::string known_;  ///< key of the job whose results are here
  std::vector<Point> model_;
};

}  // namespace dolp::explore
