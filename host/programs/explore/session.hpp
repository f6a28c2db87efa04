#pragma once

#include <deque>
#include <type_traits>

#include "explore/curve.hpp"
#include "explore/heat_map.hpp"
#include "explore/measured.hpp"
#include "explore/panels.hpp"

namespace dolp::explore {

/// A curve that stays in the plot while the scene changes.
struct Pin {
  std::string name = {};   ///< name that the user typed; if empty, the legend describes the surface
  std::size_t colour = 0;  ///< number of the colour, for pin_style()
  bool is_visible = true;
  Curve curve;
};

struct View {
  Plotted quantity = Plotted::kDolp;
  bool is_log = false;
  bool is_theta_log = false;    ///< true: the zenith axis of the curves is logarithmic
  bool has_overlay = true;      ///< also draws the curve of with_other_distribution()
  bool keeps_all = false;       ///< keeps effects that a run would drop as too small
  double theta_max_deg = 90.0;  ///< largest zenith of the plots and of the search for the maximum
  std::string map_x = "theta";  ///< name of the x axis; if the scene lacks this axis, the map takes another one
  std::string map_y = "sigma";
  /// Ranges that the user chose. The keys are kZeniths, kValues, kColours, and MapAxis::label for other axes.
  std::map<std::string, Scale> ranges = {};
  Panel panel = Panel::kMap;
  std::size_t mueller_row = 0;  ///< row and column, from 0, of the Mueller element in the view "pBRDF"
  std::size_t mueller_column = 0;

  static constexpr const char* kZeniths = "curve zenith";
  static constexpr const char* kValues = "curve values";
  static constexpr const char* kColours = "map colours";  ///< range of the values that the colours show
  static constexpr const char* kSweepValues = "view values";

  std::optional<Scale> range(const std::string& axis) const;
  void set_range(const std::string& axis, const std::optional<Scale>& range);
  friend bool operator==(const View&, const View&) = default;
};

struct Snapshot {
  std::string name;
  SceneEdits edits;
};

struct Message {
  std::string text;  ///< one line
  bool is_error = false;
};

/// The contents of a session file, except for the measured points.
struct SessionState {
  SceneEdits edits;
  std::deque<Pin> pins = {};
  std::vector<Snapshot> snapshots = {};
  View view = {};
  double theta_deg = 60.0;  ///< zenith of the cursor
  FitMarks marked = {};
};

/// State and commands of the window. A Worker computes the jobs of wanted(). The classes in window/ draw the state.
class Session {
 public:
  static constexpr std::size_t kMostPins = 6;
  static constexpr double kLeastThetaMaxDeg = 10.0;

  explicit Session(SceneEdits edits);

  // Commands. If the scene refuses a command, message() has the reason and nothing else changes. If a command also has
  // to change other keys, message() names them.
  void set(const std::string& key, const Value& value) { set({{key, value}}); }
  void set(const std::vector<Setting>& changes);
  void reset(const std::string& key);
  void reset_all() {
    attempt([&] { state_.edits.reset_all(); });
  }
  void go_to(const SceneEdits& edits) {
    attempt([&] { state_.edits.go_to(edits); });
  }
  /// Replaces the state by a saved one, and computes its pins again. undo() still goes back to the earlier scenes.
  void restore(const SessionState& saved, const std::optional<MeasuredData>& measured);
  void undo() { step(done_, undone_, "nothing to undo"); }
  void redo() { step(undone_, done_, "nothing to redo"); }
  void take_snapshot();
  /// While `is_held` is true (the mouse button is down), all changes form one step of undo(), and results are coarse.
  void hold(bool is_held);
  void note_saved() { state_.edits.note_saved(); }
  void pin();
  /// Changes the view. Removes typed ranges that no longer fit: the ranges of values and colours if the quantity or
  /// is_log changes, the range of zeniths if is_theta_log changes, and the values of the view if the panel changes.
  void set_view(const View& view);
  template <class T>
  void set_view(T View::*part, const std::type_identity_t<T>& value) {
    View view = state_.view;
    view.*part = value;
    set_view(view);
  }
  void set_theta(double theta_deg);
  /// Moves the cursor of the map to (x, y), each from 0 to 1, and sets the numbers on the two axes accordingly.
  void set_map_cursor(double x, double y);
  void load_measured(const std::string& path);
  void clear_measured() { residuals_.clear(); }
  void mark(const std::string& key, bool varies) {  // decides whether a number varies in fits
    if (varies) {
      state_.marked.try_emplace(key);
    } else {
      state_.marked.erase(key);
    }
  }
  /// Lets a number vary in fits over a typed range. Returns the reason if the range is refused, otherwise "".
  std::string set_fit_range(const std::string& key, const std::string& low, const std::string& high);
  /// Stores a fit, and visits the minimum nearest to the start of the fit. Returns the position of this minimum.
  std::size_t take_fit(Fit fit, const FitJob& job);
  /// Sets the scene to the scene of the last fit, with the numbers of one minimum of this fit.
  void visit_minimum(std::size_t position);
  void tell(std::string text, bool is_error = false) { message_ = {std::move(text), is_error}; }

  std::vector<Job> wanted() const;                                   ///< the most urgent job first
  bool take_changed() { return std::exchange(is_changed_, false); }  ///< true if wanted() must be called again
  void take(const std::vector<JobResult>& news);

  const SceneEdits& edits() const { return state_.edits; }
  const Scene& scene() const { return state_.edits.scene(); }
  const View& view() const { return state_.view; }
  double theta_deg() const { return state_.theta_deg; }
  const Curve& curve() const { return curve_; }
  const std::optional<Curve>& overlay() const { return overlay_; }
  std::deque<Pin>& pins() { return state_.pins; }
  const std::deque<Pin>& pins() const { return state_.pins; }
  std::vector<Snapshot>& snapshots() { return state_.snapshots; }
  const std::vector<Snapshot>& snapshots() const { return state_.snapshots; }
  const HeatMap& map() const { return map_; }
  const HeatMap& sky() const { return sky_; }  ///< bistatic results over the azimuth and zenith of the source
  /// The results at the cursor's zenith over another number of the scene, for the views of swept_name().
  const Sweep& sweep() const { return sweep_; }
  const MapAxis& sweep_axis() const { return sweep_axis_; }
  const Scene& sweep_scene() const { return sweep_scene_; }          ///< scene(); over wavelength, without its band
  const Sweep& smooth_spectrum() const { return smooth_spectrum_; }  ///< results for sigma = 0, over wavelength
  const Sweep& smooth() const { return smooth_; }                    ///< results for sigma = 0, over zenith
  const Peak& peak() const { return peak_; }
  const Residuals& residuals() const { return residuals_; }
  bool is_foreign(const Scene& other) const { return other.name() != scene().name() || other.text() != scene().text(); }
  const FitMarks& marked() const { return state_.marked; }
  bool varies(const std::string& key) const { return state_.marked.contains(key); }
  std::optional<FitJob> fit_job() const;  ///< empty without measured points, or if no number may vary
  const std::optional<Fit>& last_fit() const { return fit_; }
  /// Position in Fit::minima of the minimum at which the sliders are. Empty after a change of the scene.
  std::optional<std::size_t> minimum() const {
    return fit_ && visited_->is_same_scene(state_.edits) ? std::optional(minimum_) : std::nullopt;
  }
  /// The result of the last fit for the number `key`. Null if the fit did not vary it, or after a change of the scene.
  const FitParameter* fitted(const std::string& key) const;
  const Message& message() const { return message_; }
  bool is_dragged() const { return is_held_ && is_in_gesture_; }  ///< the mouse is down and has changed the scene
  /// True if a curve shows an earlier scene. False during a drag, because then every curve lags behind the slider.
  bool is_outdated(const Curve& curve) const { return curve.is_stale() && !is_dragged(); }
  /// The effects in the last finished curve. Effect::influence is estimated only at the zenith of the cursor.
  const std::vector<Effect>& effects() const { return effects_; }
  double map_cursor(const MapAxis& axis) const {
    const double value = axis.key.empty() ? state_.theta_deg : scene().number(axis.key).value_or(axis.scale.from);
    return axis.scale.position(axis.scale.clamp(value));
  }
  const Point* at_cursor() const;  ///< point of the curve nearest to the cursor; null if the curve has no points

 private:
  /// Runs `command` and records the previous state for undo(). The reason of an InputError becomes the message.
  void attempt(const std::function<void()>& command);
  void step(std::vector<SceneEdits>& from, std::vector<SceneEdits>& to, const char* nothing);
  bool keeps_all() const { return state_.view.keeps_all || described(state_.view.quantity).needs_rho; }
  void tell_remarks(const std::vector<std::string>& remarks);
  void tell_new_remarks_on_scene();
  void tell_needed(const std::string& chosen, const std::vector<Setting>& needed);
  void follow();
  void follow_overlay(const std::string& content);
  void follow_map();
  void follow_sky();
  void follow_over(HeatMap& map, const MapAxis& x, const MapAxis& y);
  void follow_peak() {
    if (!curve_.is_finished()) return;
    peak_.set_cursor(*at_cursor());
    peak_.follow(curve_, state_.view.theta_max_deg);
  }
  std::vector<const Sweep*> shown_sweeps() const;
  std::vector<Job> wanted_in_drag() const;
  bool find_sweep_axis(const std::string& name);
  void follow_over_axis(Sweep& sweep, const Scene& swept, std::size_t count);
  void follow_sweep();
  void follow_smooth(const std::string& content);
  bool shows(Panel panel) const { return state_.view.panel == panel; }
  bool shows_sweep() const { return *swept_name(state_.view.panel) != '\0'; }
  void estimate_influences();

  SessionState state_;
  std::vector<SceneEdits> done_, undone_;  ///< states that undo() and redo() restore, the last element first
  bool is_held_ = false;
  bool is_in_gesture_ = false;
  Curve curve_;
  std::optional<Curve> overlay_;
  HeatMap map_;
  HeatMap sky_;
  Scene sweep_scene_;
  MapAxis sweep_axis_;
  Sweep sweep_, smooth_, smooth_spectrum_;
  Peak peak_;
  Residuals residuals_;
  std::optional<Fit> fit_;
  std::optional<SceneEdits> fit_edits_;  ///< the scene that was fitted
  std::optional<SceneEdits> visited_;    ///< the scene after the last visit_minimum()
  std::size_t minimum_ = 0;
  std::vector<Effect> effects_;
  std::pair<std::string, double> influences_of_;  ///< curve (JobResult::key) and zenith of the influences in effects_
  Message message_;
  std::vector<std::string> remarks_;  ///< remarks on the scene that message() has shown before
  bool is_changed_ = true;
  // Whose turn it is while the user drags a slider. The order is: curve, map (or sky), curve, overlay.
  bool is_curve_next_ = true;
  bool is_map_next_ = false;
};

/// A text that identifies results: it is equal for two scenes with the same file, the same changes and `keep_all`.
std::string content_key(const Scene& scene, const std::vector<Setting>& changes, bool keep_all);

}  // namespace dolp::explore
