#include "explore/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

std::string changes_text(const std::vector<Setting>& changes) {
  std::vector<std::string> texts;
  for (const Setting& change : changes) texts.push_back(change.key + " = " + plain_text(change.value));
  return join(texts);
}

/// True if `change` only gives a new value to a number that the scene has, as a slider does.
bool moves_number(const Scene& scene, const Setting& change) {
  return std::ranges::any_of(controls(), [&](const Control& control) {
    return control.key->key == change.key && control.value(scene) && scene.number(change.key);
  });
}

struct JobList {
  std::vector<Job> jobs;

  void add(std::optional<Job> job) {
    if (job) jobs.push_back(std::move(*job));
  }
  void add(std::vector<Job> more) { std::ranges::move(more, std::back_inserter(jobs)); }
};

/// Sets axis.scale to the user's range if the scene accepts it. Otherwise limits a range of wavelengths to the part in
/// which n and k are known. Returns true if axis.scale can be drawn.
bool find_range(const Scene& scene, const View& view, MapAxis& axis) {
  const std::optional<Scale> typed = view.range(axis.label);
  if (typed && refusal(scene, axis, *typed).empty()) {
    axis.scale = *typed;
  } else if (axis.name == "wavelength") {
    axis.scale = known_part(scene, axis);
  }
  return axis.scale.refusal().empty();
}

/// The map axis `name`. If the scene lacks this axis or cannot show it, returns any axis except the axis `other`.
MapAxis axis_or_another(const Scene& scene, const View& view, const std::string& name, const std::string& other) {
  std::vector<MapAxis> axes = map_axes(scene, view.theta_max_deg);
  const auto named = std::ranges::find(axes, name, &MapAxis::name);
  if (named != axes.end() && find_range(scene, view, *named)) return *named;
  MapAxis& another = axes[axes.front().name == other ? 1 : 0];
  find_range(scene, view, another);
  return another;
}

}  // namespace

std::optional<Scale> View::range(const std::string& axis) const {
  const auto found = ranges.find(axis);
  return found == ranges.end() ? std::nullopt : std::optional(found->second);
}

void View::set_range(const std::string& axis, const std::optional<Scale>& range) {
  ranges.erase(axis);
  if (range) ranges.emplace(axis, *range);
}

Session::Session(SceneEdits edits)
    : state_{.edits = std::move(edits)},
      curve_(scene()),
      map_(scene()),
      sky_(scene()),
      sweep_scene_(scene()),
      peak_(scene()),
      residuals_(scene()) {
  tell_new_remarks_on_scene();
  follow();
}

void Session::attempt(const std::function<void()>& command) {
  message_ = {};
  const SceneEdits before = state_.edits;
  try {
    command();
  } catch (const InputError& error) {
    tell(error.what(), true);
  }
  if (!state_.edits.is_same_scene(before)) {
    if (!is_in_gesture_) done_.push_back(before);
    undone_.clear();
    is_in_gesture_ = true;
    tell_new_remarks_on_scene();
  }
  follow();
}

void Session::tell_remarks(const std::vector<std::string>& remarks) {
  if (remarks.empty()) return;
  message_.text += fmt::format("{}{}", message_.text.empty() ? "" : "; ", fmt::join(remarks, "; "));
}

void Session::tell_new_remarks_on_scene() {
  std::vector<std::string> remarks = scene().remarks();
  if (remarks != remarks_) tell_remarks(remarks);
  remarks_ = std::move(remarks);
}

void Session::tell_needed(const std::string& chosen, const std::vector<Setting>& needed) {
  if (!needed.empty()) tell(fmt::format("{} also sets {}", chosen, changes_text(needed)));
}

void Session::hold(bool is_held) {
  const bool was_dragged = is_dragged();
  is_held_ = is_held;
  if (!is_held) is_in_gesture_ = false;
  if (was_dragged != is_dragged()) follow();
}

void Session::step(std::vector<SceneEdits>& from, std::vector<SceneEdits>& to, const char* nothing) {
  message_ = {};
  is_in_gesture_ = false;
  if (from.empty()) return tell(nothing);
  to.push_back(state_.edits);
  state_.edits.go_to(from.back());
  from.pop_back();
  follow();
}

void Session::take_snapshot() {
  state_.snapshots.push_back({fmt::format("{}: {}", state_.snapshots.size() + 1, surface_name(scene())), state_.edits});
}

void Session::set(const std::vector<Setting>& changes) {
  attempt([&] {
    const auto set = [&](SceneEdits& edits) { edits.set(changes); };
    const auto is_moved = [&](const Setting& change) { return moves_number(scene(), change); };
    if (std::ranges::all_of(changes, is_moved)) return set(state_.edits);
    tell_needed(changes_text(changes), change_with_needed(state_.edits, set));
  });
}

void Session::reset(const std::string& key) {
  attempt([&] {
    tell_needed(key + " = as opened", change_with_needed(state_.edits, [&](SceneEdits& edits) { edits.reset(key); }));
  });
}

void Session::load_measured(const std::string& path) {
  attempt([&] {
    residuals_.load(read_measured(path));
    tell_remarks(residuals_.data()->remarks);
  });
}

std::string Session::set_fit_range(const std::string& key, const std::string& low, const std::string& high) {
  try {
    state_.marked[key] = FitRange::from_text(fmt::format("{}={}:{}", key, low, high));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::optional<FitJob> Session::fit_job() const {
  if (!residuals_.data()) return std::nullopt;
  FitJob job{state_.edits, *residuals_.data(), {}};
  for (const Control& control : controls()) {
    const std::optional<double> value = control.value(scene());
    if (value && varies(control.key->key)) job.vary.push_back(fit_range(state_.marked, scene(), control, *value));
  }
  return job.vary.empty() ? std::nullopt : std::optional(std::move(job));
}

std::size_t Session::take_fit(Fit fit, const FitJob& job) {
  const std::size_t nearest = nearest_minimum(fit, job);
  fit_ = std::move(fit);
  fit_edits_ = job.edits;
  state_.view.panel = Panel::kFit;
  visit_minimum(nearest);
  return nearest;
}

void Session::visit_minimum(std::size_t position) {
  std::vector<Setting> values;
  for (std::size_t j = 0; j < fit_->parameters.size(); ++j) {
    values.push_back({fit_->parameters[j].key, TomlText{fmt::format("{:.6g}", fit_->minima[position].values[j])}});
  }
  attempt([&] {
    SceneEdits visited = *fit_edits_;
    visited.set(values);
    state_.edits.go_to(visited);
    minimum_ = position;
    visited_ = state_.edits;
  });
}

const FitParameter* Session::fitted(const std::string& key) const {
  if (!minimum()) return nullptr;
  const auto found = std::ranges::find(fit_->parameters, key, &FitParameter::key);
  return found == fit_->parameters.end() ? nullptr : &*found;
}

void Session::restore(const SessionState& saved, const std::optional<MeasuredData>& measured) {
  go_to(saved.edits);
  residuals_.clear();
  if (measured) attempt([&] { residuals_.load(*measured); });
  const SceneEdits edits = state_.edits;
  state_ = saved;
  state_.edits = edits;
  for (Pin& pin : state_.pins) {
    const Scene scene = pin.curve.scene();
    pin.curve.follow(content_key(scene, scene.settings(), keeps_all()), scene, keeps_all());
  }
  set_view(saved.view);
}

void Session::pin() {
  if (state_.pins.size() == kMostPins)
    return tell(fmt::format("{} curves are pinned already: remove one first", kMostPins), true);
  std::size_t colour = 0;
  while (std::ranges::any_of(state_.pins, [&](const Pin& pin) { return pin.colour == colour; })) ++colour;
  state_.pins.push_back({.colour = colour, .curve = curve_});
  is_changed_ = true;
}

void Session::set_view(const View& view) {
  const View before = std::exchange(state_.view, view);
  if (view.quantity != before.quantity || view.is_log != before.is_log) {
    for (const char* range : {View::kValues, View::kColours, View::kSweepValues}) state_.view.ranges.erase(range);
  }
  if (view.panel != before.panel) state_.view.ranges.erase(View::kSweepValues);
  if (view.is_theta_log != before.is_theta_log) state_.view.ranges.erase(View::kZeniths);
  if (state_.view.map_x == state_.view.map_y) state_.view.map_y = state_.view.map_x == "sigma" ? "theta" : "sigma";
  state_.view.theta_max_deg = std::clamp(state_.view.theta_max_deg, kLeastThetaMaxDeg, 90.0);
  set_theta(state_.theta_deg);
}

void Session::set_theta(double theta_deg) {
  state_.theta_deg = std::clamp(theta_deg, 0.0, state_.view.theta_max_deg);
  follow();
}

void Session::set_map_cursor(double x, double y) {
  std::vector<Setting> changes;
  for (const auto& [axis, position] : {std::pair{&map_.x(), x}, {&map_.y(), y}}) {
    if (axis->key.empty()) {
      state_.theta_deg = axis->scale.value(position);
    } else {
      changes.push_back({axis->key, axis->scale.rounded(position)});
    }
  }
  set(changes);
}

const Point* Session::at_cursor() const {
  const std::vector<Point>& points = curve_.points();
  if (points.empty()) return nullptr;
  const auto distance = [&](const Point& point) { return std::abs(point.theta_deg - state_.theta_deg); };
  return &*std::ranges::min_element(points, {}, distance);
}

std::string content_key(const Scene& scene, const std::vector<Setting>& changes, bool keep_all) {
  std::string key = (keep_all ? "all " : "plan ") + scene.name() + '\n' + scene.text();
  for (const Setting& change : changes) {
    if (change.key != "title") key += '\n' + change.text();
  }
  return key;
}

void Session::follow() {
  const std::string content = content_key(scene(), state_.edits.changes(), keeps_all());
  curve_.follow(content, scene(), keeps_all());
  residuals_.follow(content, scene());
  follow_overlay(content);
  follow_map();
  follow_sweep();
  follow_smooth(content);
  follow_sky();
  estimate_influences();
  follow_peak();
  is_changed_ = true;
}

void Session::estimate_influences() {
  const JobResult& curve = curve_.finished();
  // The estimate takes as long as a coarse curve. So it is made only for a new finished curve or a new zenith.
  std::pair<std::string, double> wanted{curve.key, state_.theta_deg};
  if (influences_of_ == wanted) return;
  influences_of_ = std::move(wanted);
  effects_ = curve.effects;
  if (effects_.empty()) return;
  const std::vector<Effect> at_cursor =
      dolp::effects(curve.scene, points_at(curve.scene, {state_.theta_deg}).columns(), true);
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    if (effects_[i].state == EffectState::kKept) effects_[i].influence = at_cursor[i].influence;
  }
}

void Session::follow_overlay(const std::string& content) {
  const std::optional<Scene> other = state_.view.has_overlay ? with_other_distribution(scene()) : std::nullopt;
  if (!other) return overlay_.reset();
  if (!overlay_) overlay_.emplace(*other, "overlay");
  overlay_->follow(content, *other, keeps_all());
}

void Session::follow_map() {
  if (is_dragged() && map_.is_arriving()) return;  // a drag must not interrupt a map that is being computed
  const MapAxis x = axis_or_another(scene(), state_.view, state_.view.map_x, state_.view.map_y);
  const MapAxis y = axis_or_another(scene(), state_.view, state_.view.map_y, x.name);
  follow_over(map_, x, y);
}

/// With equal slopes along and across, half of the sky is the mirror image of the other half.
void Session::follow_sky() {
  if (!shows(Panel::kSky) || !is_bistatic(scene())) return;
  const double last_deg = has_cross_slopes(scene()) ? 360.0 : 180.0;
  follow_over(sky_, {"azimuth", "Δφ", "geometry.relative_azimuth_deg", {0.0, last_deg}}, {});
}

void Session::follow_over(HeatMap& map, const MapAxis& x, const MapAxis& y) {
  std::string key = content_key(scene(), state_.edits.changes_without({x.key, y.key}), keeps_all());
  if (!x.key.empty() && !y.key.empty()) key += "\ntheta=" + format_number(state_.theta_deg);
  for (const MapAxis& axis : {x, y})
    key += fmt::format("\n{} {} {} {}", axis.label, axis.scale.from, axis.scale.to, axis.scale.is_log);
  map.follow(key, scene(), keeps_all(), x, y, state_.theta_deg);
}

/// Finds the axis `name` of the shown view. Returns false if the scene lacks it, or its range cannot be drawn.
bool Session::find_sweep_axis(const std::string& name) {
  constexpr double kWidth = 2.0;  // the wavelength axis extends beyond the band by this factor at each end
  const bool is_spectrum = name == "wavelength";
  sweep_scene_ = is_spectrum ? at_one_wavelength(scene()) : scene();
  const std::vector<MapAxis> axes = map_axes(sweep_scene_, state_.view.theta_max_deg);
  const auto named = std::ranges::find(axes, name, &MapAxis::name);
  if (named == axes.end()) return false;
  sweep_axis_ = *named;
  if (is_spectrum) {
    const auto [from_um, to_um] = spectrum_um(state_.edits.opened());
    sweep_axis_.scale = Scale{from_um / kWidth, to_um * kWidth}.including(sweep_scene_.number(sweep_axis_.key).value());
  }
  return find_range(sweep_scene_, state_.view, sweep_axis_);
}

void Session::follow_over_axis(Sweep& sweep, const Scene& swept, std::size_t count) {
  const bool keep_all = &sweep == &smooth_spectrum_ || keeps_all();
  const Scale& range = sweep_axis_.scale;
  PointList list = points_at(swept, std::vector<double>(count, state_.theta_deg));
  list[sweep_axis_.column()] = range.values(count);
  const std::string key =
      fmt::format("{} {} from {} to {}, {} at {}\n{}", count, sweep_axis_.name, range.from, range.to, range.is_log,
                  state_.theta_deg, content_key(swept, state_.edits.changes_without({sweep_axis_.key}), keep_all));
  sweep.follow({.key = key, .scene = swept, .list = list, .keep_all = keep_all}, sweep_axis_.column());
}

void Session::follow_sweep() {
  constexpr std::size_t kSpectrum = 121;
  if (!shows_sweep()) return;
  if (!find_sweep_axis(swept_name(state_.view.panel))) {
    sweep_ = {};
    return;
  }
  follow_over_axis(sweep_, sweep_scene_, shows(Panel::kSpectrum) ? kSpectrum : Curve::kFineCount);
}

void Session::follow_smooth(const std::string& content) {
  constexpr std::size_t kWavelengths = 901;  // enough to show interference fringes of films
  if (!shows(Panel::kSmooth)) return;
  const Scene smooth = smooth_scene(scene());
  smooth_.follow({.key = "smooth\n" + content,
                  .scene = smooth,
                  .list = points_at(smooth, Scale{0.0, 90.0}.values(Curve::kFineCount)),
                  .keep_all = true});
  if (find_sweep_axis("wavelength")) follow_over_axis(smooth_spectrum_, smooth_scene(sweep_scene_), kWavelengths);
}

std::vector<const Sweep*> Session::shown_sweeps() const {
  if (shows(Panel::kSmooth)) return {&smooth_, &smooth_spectrum_};
  return shows_sweep() ? std::vector{&sweep_} : std::vector<const Sweep*>{};
}

std::vector<Job> Session::wanted_in_drag() const {
  JobList list;
  const auto add_other = [&](bool is_map) {
    if (is_map && shows(Panel::kMap)) list.add(map_.wanted(0));
    if (is_map && shows(Panel::kSky)) list.add(sky_.wanted(0));
    if (!is_map && overlay_) list.add(overlay_->wanted(Curve::Stage::kCoarse));
  };
  if (!is_curve_next_) add_other(is_map_next_);
  list.add(curve_.wanted(Curve::Stage::kCoarse));
  if (is_curve_next_) add_other(is_map_next_);
  for (const Sweep* sweep : shown_sweeps()) {
    if (!shows(Panel::kSpectrum)) list.add(sweep->wanted());
  }
  add_other(!is_map_next_);
  return list.jobs;
}

std::vector<Job> Session::wanted() const {
  if (is_dragged()) return wanted_in_drag();
  JobList list;
  list.add(curve_.wanted(Curve::Stage::kCoarse));
  list.add(curve_.wanted(Curve::Stage::kFine));
  if (overlay_) list.add(overlay_->wanted(Curve::Stage::kFine));
  if (shows(Panel::kMap)) list.add(map_.wanted(0));
  for (const Sweep* sweep : shown_sweeps()) list.add(sweep->wanted());
  list.add(peak_.wanted());
  list.add(residuals_.wanted());
  for (const Pin& pin : state_.pins) list.add(pin.curve.wanted(Curve::Stage::kFine));
  for (std::size_t level = 0; level < HeatMap::kLevels.size(); ++level) {
    if (shows(Panel::kMap) && level > 0) list.add(map_.wanted(level));
    if (shows(Panel::kSky)) list.add(sky_.wanted(level));
  }
  return list.jobs;
}

void Session::take(const std::vector<JobResult>& news) {
  for (const JobResult& result : news) {
    const bool is_curve = curve_.take(result) || curve_.take_earlier(result);
    if (overlay_ && !overlay_->take(result)) overlay_->take_earlier(result);
    for (Pin& pin : state_.pins) pin.curve.take(result);
    const bool is_map = map_.take(result);
    is_curve_next_ = !is_curve;
    if (!is_curve) is_map_next_ = !is_map;
    if (is_map && !map_.is_arriving() && is_dragged()) follow();
    sky_.take(result);
    for (Sweep* sweep : {&sweep_, &smooth_, &smooth_spectrum_}) sweep->take(result);
    if (peak_.take(result) && peak_.answer()) {
      for (Pin& pin : state_.pins) {
        if (pin.curve.key() == curve_.key()) pin.curve.set_peak(peak_.answer()->at);
      }
      curve_.set_peak(peak_.answer()->at);
    }
    residuals_.take(result);
    if (!result.refusal.empty()) tell(result.refusal, true);
    is_changed_ = true;
  }
  follow_peak();
  if (curve_.is_finished() && !news.empty()) estimate_influences();
}

}  // namespace dolp::explore
