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
  Point at;
  // Zeniths at which, with all errors, DOLP could be the largest.
  double theta_low_deg = 0.0;
  double theta_high_deg = 0.0;
  std::optional<double> rival_deg;  ///< another zenith, not beside it, at which it could be the largest
  bool is_at_end = false;           ///< the largest is beside entries that are not good, or at the end of the range
};

/// The peak without one effect.
struct WithoutEffect {
  std::string effect;  ///< as in Effect::name, or "roughness"
  bool radiates;       ///< a part of the sum of radiances
  Scene scene;
  std::optional<Point> result = {};  ///< none while it is unknown
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
  std::string key_of(const WithoutEffect& of) const { return "without " + of.effect + ' ' + key_; }
  void take_away(const SceneEdits& edits);

  std::string key_;
  Scene scene_;
  std::vector<Point> curve_;
  std::vector<double> theta_deg_;  ///< around the peak of the curve; empty when no entry is good
  std::optional<PeakAnswer> answer_;
  std::vector<WithoutEffect> without_;
};

}  // namespace dolp::explore
