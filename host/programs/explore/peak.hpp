// The maximum of a curve's polarisation, its uncertainty, and the effects behind it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/curve.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// The largest DOLP of a curve among entries that status calls good.
struct PeakAnswer {
  double theta_deg = 0.0;
  double dolp = 0.0;
  double q_over_i = 0.0;  ///< positive: s polarised
  double error = 0.0;     ///< bound of |d DOLP|
  double albedo = 0.0;    ///< of the surface model there; NaN where the plan gives none
  // Zeniths at which, with all errors, DOLP could be the largest.
  double theta_low_deg = 0.0;
  double theta_high_deg = 0.0;
  std::optional<double> rival_deg;  ///< another zenith, not beside it, at which it could be the largest
  bool is_at_end = false;           ///< the largest is beside entries that are not good, or at the end of the range
};

/// The peak without one effect.
struct WithoutEffect {
  const char* effect;     ///< as in Effect::name, or "roughness"
  const char* change;     ///< what takes it away
  bool radiates;          ///< a part of the sum of radiances
  bool is_known = false;  ///< otherwise the scene cannot be without it
  Point result = {};
};

/// Looks for the peak of a finished curve on a fine grid, then takes each effect away there.
class Peak {
 public:
  /// Resolution of zeniths.
  static constexpr double kStepDeg = 0.02;

  explicit Peak(const Scene& scene) : scene_(scene) {}

  /// The peak of this curve, which is finished, up to a zenith; the scene behind it is that of `edits`.
  void follow(const Curve& curve, const SceneEdits& edits, double theta_max_deg);

  /// The work still to be done.
  std::vector<Job> wanted() const;
  bool take(const JobPart& news);

  /// The peak; none while it is unknown, or where no entry is good.
  const std::optional<PeakAnswer>& answer() const { return answer_; }
  /// The peak without each effect that the scene has; complete when all are known.
  const std::vector<WithoutEffect>& without() const { return without_; }
  bool is_complete() const;

  /// The part that one radiating effect adds to Q/I at the peak; exact, because Stokes parameters add up.
  double contribution(const WithoutEffect& of) const;

 private:
  std::optional<double> rival(double least) const;
  void answer_from(const std::vector<Point>& points);
  std::string key_of(const WithoutEffect& of) const;
  void take_away(const SceneEdits& edits);

  std::string key_;
  Scene scene_;
  std::vector<Point> curve_;
  std::vector<double> theta_deg_;  ///< around the peak of the curve; empty when no entry is good
  std::optional<PeakAnswer> answer_;
  Point at_peak_ = {};
  std::vector<WithoutEffect> without_;
  std::vector<Scene> scenes_without_;
};

}  // namespace dolp::explore
