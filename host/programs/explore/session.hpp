// The state behind the window: the edited scene, its curves, its map, pins and cursor.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/curve.hpp"
#include "explore/heat_map.hpp"
#include "explore/measured.hpp"
#include "explore/panels.hpp"
#include "explore/parameters.hpp"
#include "explore/peak.hpp"
#include "explore/scene_edits.hpp"
#include "explore/sky_pair.hpp"

namespace dolp::explore {

/// A curve that stays while the scene changes.
struct Pin {
  std::string name = {};   ///< given by the user; empty: by its surface
  std::size_t colour = 0;  ///< position among the colours of pins
  bool is_visible = true;
  Curve curve;
};

/// The displayed quantity, and how it is drawn.
struct View {
  Plotted quantity = Plotted::kDolp;
  bool is_log = false;
  bool is_theta_log = false;    ///< zeniths of curves by their logarithm
  bool has_overlay = true;      ///< the other slope distribution with the same D(0)
  bool keeps_all = false;       ///< compute what the plan would drop, too
  double theta_max_deg = 90.0;  ///< what is shown, and where the maximum is looked for
  Axis map_x = Axis::kTheta;
  Axis map_y = Axis::kSigma;
  Zoom curve_zoom = {};
  std::map<std::string, Scale> map_ranges = {};  ///< that were typed, by the label of the axis
  std::optional<Scale> map_colours = {};         ///< likewise, the values of the first colour and the last
  Panel panel = Panel::kMap;
  std::size_t mueller_row = 0;  ///< of the element in the view of the pBRDF
  std::size_t mueller_column = 0;
};

/// A state of the scene that one can go back to.
struct Snapshot {
  std::string name;
  SceneEdits edits;
};

/// One line for the user.
struct Message {
  std::string text;
  bool is_error = false;
};

/// Keys that vary in fits, with the ranges that were typed for them.
using FitMarks = std::map<std::string, std::optional<FitRange>>;

/// The content of a session file.
struct SavedSession {
  struct SavedPin {
    std::string name;
    std::size_t colour;
    bool is_visible;
    Scene scene;
  };
  SceneEdits edits;
  std::vector<SavedPin> pins = {};
  std::vector<Snapshot> snapshots = {};
  View view = {};
  double theta_deg = 60.0;
  std::optional<MeasuredData> measured = {};
  FitMarks marked = {};
};

/// State and commands; a Worker computes what it wants. Knows nothing of drawing.
class Session {
 public:
  static constexpr std::size_t kMostPins = 6;
  static constexpr double kLeastThetaMaxDeg = 10.0;

  explicit Session(SceneEdits edits);

  // ---- Commands. Those that the scene refuses change nothing and leave the reason in message(); so does what had to
  // change with a choice.
  void set(const std::string& key, const Value& value) { set({{key, value}}); }
  void set(const std::vector<Setting>& changes);
  void reset(const std::string& key);
  void reset_all();
  /// Shows another state, or another scene; `undo` goes back.
  void go_to(const SceneEdits& edits);
  /// Takes the place of all but what `undo` goes back to.
  void restore(const SavedSession& saved);
  void undo() { step(done_, undone_, "nothing to undo"); }
  void redo() { step(undone_, done_, "nothing to redo"); }
  void take_snapshot();
  void rename_snapshot(std::size_t position, std::string name) { snapshots_[position].name = std::move(name); }
  void remove_snapshot(std::size_t position);
  /// Changes while a button of the mouse is held down are one for `undo`, and get coarse results alone.
  void hold(bool is_held);
  void note_saved() { edits_.note_saved(); }
  /// Puts a sky of skies() into a file beside that of a scene, "NAME_sky.csv", which the scene names from then on.
  /// Errors: IoError.
  void keep_sky(const std::filesystem::path& scene_file);
  void pin();
  void remove_pin(std::size_t position);
  void rename_pin(std::size_t position, std::string name) { pins_[position].name = std::move(name); }
  void show_pin(std::size_t position, bool is_visible) { pins_[position].is_visible = is_visible; }
  /// Ranges of values go with the quantity and its logarithm, those of zeniths with theirs.
  void set_view(const View& view);
  void set_theta(double theta_deg);
  /// Moves the cursor of the map; the parameters of its axes follow. Positions from 0 to 1.
  void set_map_cursor(double x, double y);
  void load_measured(const std::string& path);
  void clear_measured() { residuals_.clear(); }
  /// Lets a number vary in fits, or not.
  void mark(const std::string& key, bool varies);
  /// Lets a number vary in fits over a range of its own, in place of its slider's. Returns why it is refused, or
  /// nothing.
  std::string set_fit_range(const std::string& key, const std::string& low, const std::string& high);
  /// Shows a fit, and moves the parameters to the minimum nearest to where the job started. Returns its position.
  std::size_t take_fit(Fit fit, const FitJob& job);
  /// Moves the parameters to a minimum of the last fit; all else becomes as it was fitted.
  void visit_minimum(std::size_t position);
  void tell(std::string text, bool is_error = false) { message_ = {std::move(text), is_error}; }

  // ---- Computing.
  /// The wanted jobs, the most wanted first.
  std::vector<Job> wanted() const;
  /// True where wanted() may have changed since the last call.
  bool take_changed();
  void take(const std::vector<JobPart>& news);

  // ---- State.
  const SceneEdits& edits() const { return edits_; }
  const Scene& scene() const { return edits_.scene(); }
  const View& view() const { return view_; }
  double theta_deg() const { return theta_deg_; }
  const Curve& curve() const { return curve_; }
  const std::optional<Curve>& overlay() const { return overlay_; }
  std::string overlay_name() const;
  const std::deque<Pin>& pins() const { return pins_; }
  const std::vector<Snapshot>& snapshots() const { return snapshots_; }
  const HeatMap& map() const { return map_; }
  const Sky& sky() const { return sky_; }
  const Peak& peak() const { return peak_; }
  const Residuals& residuals() const { return residuals_; }
  const FitMarks& marked() const { return marked_; }
  /// Skies whose files go with the session; true where the scene names one of them.
  SkyFiles& skies() { return skies_; }
  const SkyFiles& skies() const { return skies_; }
  bool has_own_sky() const { return skies_.hold(sky_file(scene())); }
  bool varies(const std::string& key) const { return marked_.contains(key); }
  /// The range of a parameter in fits: its own, or that of its slider as far as the scene takes it. The value is the
  /// start.
  FitRange fit_range(const Parameter& parameter, double value) const;
  /// The fit of the marked parameters, over their ranges, to the measured points; none without points, or without a
  /// marked parameter that the scene has.
  std::optional<FitJob> fit_job() const;
  /// The last fit, and its minimum on display: none once the scene has changed.
  const std::optional<Fit>& last_fit() const { return fit_; }
  std::optional<std::size_t> minimum() const { return fit() ? std::optional(minimum_) : std::nullopt; }
  /// The result of the last fit, and what it says of a number; null once the scene has changed.
  const Fit* fit() const { return fit_ && fitted_->is_same_scene(edits_) ? &*fit_ : nullptr; }
  const FitParameter* fitted(const std::string& key) const;
  const Message& message() const { return message_; }
  /// True while the mouse changes the scene.
  bool is_dragged() const { return is_held_ && is_in_gesture_; }
  /// True where a curve belongs to an earlier scene, and not to one of the same drag.
  bool is_outdated(const Curve& curve) const { return curve.is_stale() && !is_dragged(); }
  /// The mark of a curve that is not the finished one of its scene: ", coarse" or ", the scene before"; else empty.
  const char* remark(const Curve& curve) const;
  /// The effects of the last finished curve; influences of what is kept are those at the cursor's zenith.
  const std::vector<Effect>& effects() const { return effects_; }
  /// Why the map cannot have a range along an axis; empty where it can.
  std::string refusal(const MapAxis& axis, const Scale& range) const;
  /// The position of the scene's own value on an axis of the map.
  double map_cursor(const MapAxis& axis) const;
  /// The point on display at the zenith nearest to the cursor's; null before there is one.
  const Point* at_cursor() const;

 private:
  template <class Command>
  void attempt(const Command& command);
  void step(std::vector<SceneEdits>& from, std::vector<SceneEdits>& to, const char* nothing);
  bool keeps_all() const { return view_.keeps_all || described(view_.quantity).needs_rho; }
  /// Adds remarks to the message. Remarks on the scene are told once, until it changes.
  void tell_remarks(const std::vector<std::string>& remarks);
  void tell_remarks_of_scene();
  void tell_asked(const std::string& chosen, const std::vector<Setting>& asked);
  void follow();
  void follow_overlay(const std::string& content, bool keep_all);
  void follow_map(bool keep_all);
  MapAxis map_axis(Axis axis) const;
  std::vector<Job> wanted_in_drag() const;
  bool shows_map() const { return view_.panel == Panel::kMap; }
  void estimate_influences();
  void follow_peak();

  SkyFiles skies_;
  SceneEdits edits_;
  std::vector<SceneEdits> done_, undone_;  ///< before each gesture; after each that was undone
  std::vector<Snapshot> snapshots_;
  bool is_held_ = false;
  bool is_in_gesture_ = false;
  View view_;
  double theta_deg_ = 60.0;
  Curve curve_;
  std::optional<Curve> overlay_;
  std::deque<Pin> pins_;
  HeatMap map_;
  Sky sky_;
  Peak peak_;
  Residuals residuals_;
  FitMarks marked_;
  std::optional<Fit> fit_;
  std::optional<SceneEdits> fit_edits_;  ///< the scene that was fitted
  std::optional<SceneEdits> fitted_;     ///< with the minimum that was visited
  std::size_t minimum_ = 0;
  std::vector<Effect> effects_;
  std::pair<std::string, double> influences_of_;  ///< key of the curve, zenith
  Message message_;
  std::vector<std::string> remarks_;  ///< of the scene, told already
  bool is_changed_ = true;
  // The order of coarse results in a drag.
  bool is_curve_next_ = true;
  bool is_map_next_ = false;
};

/// The surface of a scene in few words: "cauchy σ 0.15 q 3, smith, n 1.5 k 0.1"; with `other` those alone in which it
/// differs.
std::string surface_name(const Scene& scene, const Scene* other = nullptr);

/// The name of a pin, without what the curve has in common with it.
std::string pin_name(const Pin& pin, const Session& session);

/// The surface of the curve on display, with its remark.
std::string curve_name(const Session& session);

/// Empty, or the mark of outdated values.
const char* stale_text(bool is_stale);

}  // namespace dolp::explore
