// Measured points beside the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/curve.hpp"

namespace dolp::explore {

/// DOLP over zenith, as measured.
struct MeasuredPoints {
  std::string name;  ///< of the file
  std::vector<double> theta_deg;
  std::vector<double> dolp;
  std::vector<double> uncertainty;  ///< one standard deviation of each; empty without the column
};

/// Reads a CSV whose header has the columns `theta_deg` and `dolp`, and any of `uncertainty`, in any order; further
/// columns are ignored.
/// Domain: theta_deg in [0, 90], dolp in [-1, 1] (a fraction, not percent), uncertainty in (0, 1].
/// Errors: InputError, one line that names file, line, column, value and allowed range.
MeasuredPoints read_measured(const std::string& path);
MeasuredPoints parse_measured(const std::string& text, const std::string& path_name);

/// The model at the measured zeniths.
class Residuals {
 public:
  void load(MeasuredPoints points);
  void clear() { points_.reset(); }
  void follow(const std::string& key, const Scene& scene);

  std::optional<Job> wanted() const;
  bool take(const JobPart& news);

  const std::optional<MeasuredPoints>& points() const { return points_; }
  /// Measured minus model, NaN where the model gives none; empty until it is known.
  std::vector<double> residuals() const;
  /// Root mean square of those that are numbers; none without any.
  std::optional<double> rms() const;

 private:
  std::string job_key() const;

  std::optional<MeasuredPoints> points_;
  std::size_t loads_ = 0;
  std::string key_;
  Scene scene_;
  std::string known_;  ///< key of the job whose results are here
  std::vector<PointResult> results_;
};

}  // namespace dolp::explore
