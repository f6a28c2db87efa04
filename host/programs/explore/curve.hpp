#pragma once

#include <algorithm>

#include "explore/background.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// The results of a scene at zeniths from 0 to 90 degrees: first at few zeniths with a high tolerance, then at many.
class Curve {
 public:
  enum class Stage { kCoarse, kFine };

  static constexpr std::size_t kFineCount = 181;  ///< zeniths from 0 to 90 degrees in steps of half a degree
  static constexpr std::size_t kCoarseCount = 46;
  static constexpr double kCoarseTolerance = 1e-2;

  explicit Curve(const Scene& scene, std::string name = "curve")
      : name_(std::move(name)), scene_(scene), shown_{.scene = scene}, finished_{.scene = scene} {}

  /// Switches to `scene`, whose content_key() is `key`. Until new points arrive, points() returns the old points.
  void follow(const std::string& key, const Scene& scene, bool keep_all);

  std::optional<Job> wanted(Stage stage) const;  ///< job that computes a stage; empty if the stage is done
  bool take(const JobResult& news);  ///< stores results for the current scene; returns false for other results
  /// Shows a coarse curve of an earlier scene until the current scene has points. Returns false for other results.
  bool take_earlier(const JobResult& news);

  const Scene& scene() const { return scene_; }
  const std::string& key() const { return key_; }
  bool is_finished() const { return shown_.key == job_key(Stage::kFine); }
  bool is_stale() const { return !points().empty() && !is_current(); }  ///< points() belong to an earlier scene
  const Scene& shown_scene() const { return points().empty() ? scene_ : shown_.scene; }  ///< the scene of points()
  const std::vector<Point>& points() const { return shown_.points; }
  std::vector<Point> drawn() const;  ///< points(), and the point of the maximum as soon as it is known
  void set_peak(const Point& peak) { peak_ = peak; }
  const JobResult& finished() const { return finished_; }  ///< results of the last finished fine curve; empty at first

  double worst_error() const {  // largest error bound of DOLP among good points
    double worst = 0.0;
    for (const Point& point : points()) {
      if (point.is_good()) worst = std::max(worst, point[Quantity::kErrorEstimate]);
    }
    return worst;
  }

 private:
  std::string key_prefix(Stage stage) const { return (stage == Stage::kCoarse ? "coarse " : "") + name_ + ' '; }
  std::string job_key(Stage stage) const { return key_prefix(stage) + key_; }
  bool is_current() const { return is_finished() || shown_.key == job_key(Stage::kCoarse); }

  std::string name_;
  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  JobResult shown_;
  JobResult finished_;
  std::optional<Point> peak_;  ///< point of the maximum, from set_peak()
};

/// Compares every tenth point of a finished curve with the evaluator "reference". Returns a text with the largest error
/// of DOLP and the error bound of that point. Errors: Cancelled if `progress` returns false.
std::string true_error(const Curve& curve, const Progress& progress);

/// The peak of a curve: the largest DOLP of its trusted points (Point::is_trusted), or of its good points
/// (Point::is_good) if no point is trusted.
struct PeakAnswer {
  Point at;
  // Because of the error bounds, the true maximum near this peak may lie anywhere between these two zeniths.
  double theta_low_deg = 0.0;
  double theta_high_deg = 0.0;
  std::optional<double> rival_deg;  ///< zenith elsewhere on the curve where DOLP may be higher, within the error bounds
  bool is_at_end =
      false;  ///< the peak is the last zenith of the search, or the next zenith is not trusted, or not good
};

/// A scene without one of its effects, and the results of this scene at two zeniths.
struct WithoutEffect {
  std::string effect;  ///< an Effect::name, or "roughness"
  bool radiates;       ///< true for emission, source and surroundings, whose contributions add up to Q/I
  Scene scene;
  std::optional<Point> at_cursor = {}, at_peak = {};  ///< empty until they are computed

  /// The contribution of the effect to Q/I at a point. The contributions of emission, source and surroundings add up to
  /// Q/I. `with` is the result with all effects, `without` the result without this effect.
  static double contribution(const Point& with, const Point& without) {
    return (with[Quantity::kStokesQ] - without[Quantity::kStokesQ]) / with[Quantity::kStokesI];
  }
};

/// Searches the peak of a finished curve. Then computes, for each effect, the scene without this effect at the cursor
/// and at the peak.
class Peak {
 public:
  static constexpr double kStepDeg = 0.02;  ///< step of the zeniths at which the search computes DOLP

  explicit Peak(const Scene& scene) : scene_(scene) {}

  /// Begins the search for the peak of `curve`, up to the zenith `theta_max_deg`.
  void follow(const Curve& curve, double theta_max_deg);
  void set_cursor(const Point& at);  ///< the point of the curve at the cursor
  const Point& cursor() const { return cursor_; }

  std::vector<Job> wanted() const;
  bool take(const JobResult& news);

  const std::optional<PeakAnswer>& answer() const { return answer_; }  ///< empty if not known yet or no point is good
  const std::vector<WithoutEffect>& without() const { return without_; }  ///< one per effect that can be removed
  bool is_complete() const {
    return answer_ &&
           std::ranges::all_of(without_, [](const WithoutEffect& removed) { return removed.at_cursor.has_value(); });
  }

 private:
  void answer_from(const std::vector<Point>& points);
  std::string job_key(const WithoutEffect& removed) const;

  std::string key_;
  Scene scene_;
  Point cursor_;
  std::vector<Point> curve_;
  std::vector<double> theta_deg_;  ///< zeniths at which to search the peak; empty if no point of the curve is good
  std::optional<PeakAnswer> answer_;
  std::vector<WithoutEffect> without_;
};

}  // namespace dolp::explore
