// One curve over theta, from the first coarse one to that at the scene's own tolerance.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/background.hpp"

namespace dolp::explore {

/// Results of a scene over all zeniths.
class Curve {
 public:
  enum class Stage { kCoarse, kFine };

  /// Zeniths of the finished curve: 0 to 90 degrees by half a degree.
  static constexpr std::size_t kFineCount = 181;
  static constexpr std::size_t kCoarseCount = 46;
  static constexpr double kCoarseTolerance = 1e-2;

  /// `name`: begins the keys of its jobs.
  explicit Curve(const Scene& scene, std::string name = "curve")
      : name_(std::move(name)), scene_(scene), shown_{.scene = scene}, finished_{.scene = scene} {}

  /// Switches to the curve of `scene`. `key` identifies the scene's content. The curve on display stays, marked as
  /// outdated, until newer points arrive.
  void follow(const std::string& key, const Scene& scene, bool keep_all);

  /// The work still to be done, one stage at a time.
  std::optional<Job> wanted(Stage stage) const;

  /// Takes what is this curve's; false for the rest.
  bool take(const JobPart& news);
  /// Takes a coarse curve that was begun before the scene changed, where what is shown is older still; false for the
  /// rest.
  bool take_earlier(const JobPart& news);

  const Scene& scene() const { return scene_; }
  const std::string& key() const { return key_; }
  bool is_finished() const { return shown_.key == key_of(Stage::kFine); }
  /// True where the points on display belong to an earlier scene.
  bool is_stale() const { return !points().empty() && !is_current(); }
  // The points on display, and the scene that they were computed with.
  const Scene& shown_scene() const { return points().empty() ? scene_ : shown_.scene; }
  const std::vector<Point>& points() const { return shown_.points; }
  /// The same with the maximum, which may lie between them; for drawing.
  std::vector<Point> drawn() const;
  void set_peak(const Point& peak) { peak_ = peak; }
  /// The last finished curve; without points before there is one.
  const JobPart& finished() const { return finished_; }

  /// The largest stated error of DOLP where status promises one.
  double worst_error() const;

 private:
  std::string prefix_of(Stage stage) const { return (stage == Stage::kCoarse ? "coarse " : "") + name_ + ' '; }
  std::string key_of(Stage stage) const { return prefix_of(stage) + key_; }
  bool is_current() const { return is_finished() || shown_.key == key_of(Stage::kCoarse); }

  std::string name_;
  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  JobPart shown_;
  JobPart finished_;
  std::optional<Point> peak_;  ///< of the finished curve
};

/// Compares every tenth point of a finished curve with the independent reference, everything kept. Returns the largest
/// error of DOLP beside its bound, in words.
/// Errors: Cancelled when `progress` returns false.
std::string true_error(const Curve& curve, const Progress& progress);

}  // namespace dolp::explore
