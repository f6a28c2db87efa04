#include "explore/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/atomic_file.hpp"
#include "base/text.hpp"

namespace dolp::explore {
namespace {

/// Identifies results of a scene's file with changes.
std::string content_key(const Scene& scene, const std::vector<Setting>& changes, bool keep_all) {
  std::string key = (keep_all ? "all " : "plan ") + scene.name() + '\n' + scene.text();
  for (const Setting& change : changes) key += '\n' + change.text();
  return key;
}

std::string text_of(const std::vector<Setting>& changes) {
  std::string text;
  for (const Setting& change : changes) {
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", change.key, word_of(change.value));
  }
  return text;
}

/// The numbers and the sky in which a scene differs from another: "T 300 K, clear-sky".
std::string differences(const Scene& scene, const Scene& other) {
  std::vector<std::string> words;
  for (const Parameter& parameter : parameters()) {
    const std::optional<double> value = parameter.value(scene);
    if (!value || value == parameter.value(other)) continue;
    const std::string unit = unit_text(*parameter.key);
    words.push_back(fmt::format("{} {:.4g}{}{}", parameter.symbol, *value, unit.empty() ? "" : " ", unit));
  }
  const std::string sky = scene.word("surroundings.profile").value_or("");
  if (!sky.empty() && sky != other.word("surroundings.profile"))
    words.push_back(std::filesystem::path(sky).stem().string());
  return fmt::format("{}", fmt::join(words, ", "));
}

/// The words that describe a surface, in groups.
std::vector<std::vector<std::string>> surface_words(const Scene& scene) {
  const std::string distribution = scene.word("surface.distribution").value();
  std::vector<std::vector<std::string>> groups = {
      {distribution, has_wind(scene) ? fmt::format("U {:.4g} m/s", scene.number("surface.wind_m_s").value())
                                     : fmt::format("σ {:.4g}", scene.number("surface.sigma").value())},
      {scene.word("surface.masking").value()}};
  if (distribution == "cauchy") groups[0].push_back(fmt::format("q {:.4g}", scene.number("surface.q").value()));
  if (scene.word("surface.scattering") == "multiple") groups.push_back({"all bounces"});
  if (const auto material = scene.word("surface.material")) {
    groups.push_back({*material});
  } else if (const auto file = scene.word("surface.material_file")) {
    groups.push_back({*file});
  } else {
    groups.push_back({fmt::format("n {:.4g}", scene.number("surface.n").value()),
                      fmt::format("k {:.4g}", scene.number("surface.k").value())});
  }
  return groups;
}

}  // namespace

std::string surface_name(const Scene& scene, const Scene* other) {
  const std::vector<std::vector<std::string>> groups = surface_words(scene);
  const std::vector<std::vector<std::string>> others = other ? surface_words(*other) : groups;
  std::vector<std::string> parts;
  for (const std::vector<std::string>& group : groups) {
    std::vector<std::string> words;
    for (const std::string& word : group) {
      const bool is_common = other && std::ranges::any_of(others, [&](const std::vector<std::string>& of_other) {
                               return std::ranges::find(of_other, word) != of_other.end();
                             });
      if (!is_common) words.push_back(word);
    }
    if (!words.empty()) parts.push_back(fmt::format("{}", fmt::join(words, " ")));
  }
  if (!parts.empty()) return fmt::format("{}", fmt::join(parts, ", "));
  const std::string rest = other ? differences(scene, *other) : "";
  return rest.empty() ? "the same surface" : rest;
}

std::string pin_name(const Pin& pin, const Session& session) {
  if (!pin.name.empty()) return pin.name;
  return surface_name(pin.curve.shown_scene(), &session.curve().shown_scene()) + stale_text(pin.curve.is_stale());
}

const char* stale_text(bool is_stale) { return is_stale ? ", the scene before" : ""; }

std::string curve_name(const Session& session) {
  return surface_name(session.curve().shown_scene()) + session.remark(session.curve());
}

Session::Session(SceneEdits edits)
    : edits_(std::move(edits)), curve_(scene()), map_(scene()), peak_(scene()), residuals_(scene()) {
  tell_remarks_of_scene();
  follow();
}

template <class Command>
void Session::attempt(const Command& command) {
  message_ = {};
  const SceneEdits before = edits_;
  try {
    command();
  } catch (const InputError& error) {
    tell(error.what(), true);
  }
  if (!edits_.is_same_scene(before)) {
    if (!is_in_gesture_) done_.push_back(before);
    undone_.clear();
    is_in_gesture_ = true;
    tell_remarks_of_scene();
  }
  follow();
}

void Session::tell_remarks(const std::vector<std::string>& remarks) {
  if (remarks.empty()) return;
  message_.text += fmt::format("{}{}", message_.text.empty() ? "" : "; ", fmt::join(remarks, "; "));
}

void Session::tell_remarks_of_scene() {
  std::vector<std::string> remarks = scene().remarks();
  if (remarks != remarks_) tell_remarks(remarks);
  remarks_ = std::move(remarks);
}

void Session::hold(bool is_held) {
  const bool was_dragged = is_dragged();
  is_held_ = is_held;
  if (!is_held) is_in_gesture_ = false;
  if (was_dragged != is_dragged()) follow();
}

const char* Session::remark(const Curve& curve) const {
  if (is_outdated(curve)) return stale_text(true);
  return curve.points().empty() || (curve.is_finished() && !is_dragged()) ? "" : ", coarse";
}

void Session::step(std::vector<SceneEdits>& from, std::vector<SceneEdits>& to, const char* nothing) {
  message_ = {};
  is_in_gesture_ = false;
  if (from.empty()) return tell(nothing);
  to.push_back(edits_);
  edits_.go_to(from.back());
  from.pop_back();
  follow();
}

void Session::go_to(const SceneEdits& edits) {
  attempt([&] { edits_.go_to(edits); });
}

void Session::take_snapshot() {
  snapshots_.push_back({fmt::format("{}: {}", snapshots_.size() + 1, surface_name(scene())), edits_});
}

void Session::remove_snapshot(std::size_t position) {
  snapshots_.erase(snapshots_.begin() + static_cast<std::ptrdiff_t>(position));
}

void Session::set(const std::vector<Setting>& changes) {
  attempt([&] {
    const std::vector<Setting> asked = asked_for(scene(), changes);
    std::vector<Setting> all = changes;
    all.insert(all.end(), asked.begin(), asked.end());
    edits_.set(all);
    tell_asked(text_of(changes), asked);
  });
}

void Session::reset(const std::string& key) {
  attempt([&] {
    const std::vector<Setting> chosen = choices_of(edits_.opened(), key);
    const std::vector<Setting> asked = asked_for(scene(), chosen);
    edits_.set(asked);
    edits_.reset(key);
    tell_asked(key + " = as opened", asked);
  });
}

void Session::tell_asked(const std::string& chosen, const std::vector<Setting>& asked) {
  if (!asked.empty()) tell(fmt::format("With {} goes {}", chosen, text_of(asked)));
}

void Session::reset_all() {
  attempt([&] { edits_.reset_all(); });
}

void Session::keep_sky(const std::filesystem::path& scene_file) {
  if (!has_own_sky()) return;
  namespace fs = std::filesystem;
  const fs::path file = fs::absolute(scene_file).replace_filename(scene_file.stem().string() + "_sky.csv");
  write_text_atomically(file, read_sky_pair(sky_file(scene())).value().csv());
  const fs::path folder = fs::absolute(scene().name()).parent_path();
  set("surroundings.profile", file.lexically_normal().lexically_relative(folder.lexically_normal()).string());
}

void Session::load_measured(const std::string& path) {
  attempt([&] {
    residuals_.load(read_measured(path));
    tell_remarks(residuals_.data()->remarks);
  });
}

void Session::mark(const std::string& key, bool varies) {
  if (varies) {
    marked_.try_emplace(key);
  } else {
    marked_.erase(key);
  }
}

std::string Session::set_fit_range(const std::string& key, const std::string& low, const std::string& high) {
  try {
    marked_[key] = FitRange::from_text(fmt::format("{}={}:{}", key, low, high));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

FitRange Session::fit_range(const Parameter& parameter, double value) const {
  // A search along the logarithm of k finds small ones too.
  constexpr double kLeastK = 1e-3;
  const std::string& key = parameter.key->key;
  const auto marked = marked_.find(key);
  if (marked != marked_.end() && marked->second) {
    FitRange own = *marked->second;
    own.start = std::clamp(value, own.low, own.high);
    return own;
  }
  const Scale slider = range_in(scene(), parameter);
  const double low = key == "surface.k" ? kLeastK : std::min(slider.from, value);
  return {key, low, std::max(slider.to, value), std::max(low, value)};
}

std::optional<FitJob> Session::fit_job() const {
  if (!residuals_.data()) return std::nullopt;
  FitJob job{edits_, *residuals_.data(), {}};
  for (const Parameter& parameter : parameters()) {
    const std::optional<double> value = parameter.value(scene());
    if (value && varies(parameter.key->key)) job.vary.push_back(fit_range(parameter, *value));
  }
  return job.vary.empty() ? std::nullopt : std::optional(std::move(job));
}

std::size_t Session::take_fit(Fit fit, const FitJob& job) {
  const std::size_t nearest = nearest_minimum(fit, job);
  fit_ = std::move(fit);
  fit_edits_ = job.edits;
  view_.panel = Panel::kFit;
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
    edits_.go_to(visited);
    minimum_ = position;
    fitted_ = edits_;
  });
}

const FitParameter* Session::fitted(const std::string& key) const {
  if (!fit()) return nullptr;
  const auto found = std::ranges::find(fit_->parameters, key, &FitParameter::key);
  return found == fit_->parameters.end() ? nullptr : &*found;
}

void Session::restore(const SavedSession& saved) {
  go_to(saved.edits);
  snapshots_ = saved.snapshots;
  marked_ = saved.marked;
  residuals_.clear();
  if (saved.measured) attempt([&] { residuals_.load(*saved.measured); });
  pins_.clear();
  view_ = saved.view;
  for (const SavedSession::SavedPin& pin : saved.pins) {
    Curve curve(pin.scene);
    curve.follow(content_key(pin.scene, pin.scene.settings(), keeps_all()), pin.scene, keeps_all());
    pins_.push_back({pin.name, pin.colour, pin.is_visible, std::move(curve)});
  }
  theta_deg_ = saved.theta_deg;
  set_view(saved.view);
}

void Session::pin() {
  if (pins_.size() == kMostPins) {
    tell(fmt::format("{} curves are pinned already: take one away first", kMostPins), true);
    return;
  }
  std::size_t colour = 0;
  while (std::ranges::any_of(pins_, [&](const Pin& pin) { return pin.colour == colour; })) ++colour;
  pins_.push_back({.colour = colour, .curve = curve_});
  is_changed_ = true;
}

void Session::remove_pin(std::size_t position) {
  pins_.erase(pins_.begin() + static_cast<std::ptrdiff_t>(position));
  is_changed_ = true;
}

void Session::set_view(const View& view) {
  const View before = std::exchange(view_, view);
  if (view.quantity != before.quantity || view.is_log != before.is_log) {
    view_.curve_zoom.y.reset();
    view_.map_colours.reset();
  }
  if (view.is_theta_log != before.is_theta_log) view_.curve_zoom.x.reset();
  if (view_.map_x == view_.map_y) {
    view_.map_y = view_.map_x == Axis::kSigma ? Axis::kTheta : Axis::kSigma;
  }
  view_.theta_max_deg = std::clamp(view_.theta_max_deg, kLeastThetaMaxDeg, 90.0);
  set_theta(theta_deg_);
}

void Session::set_theta(double theta_deg) {
  theta_deg_ = std::clamp(theta_deg, 0.0, view_.theta_max_deg);
  follow();
}

void Session::set_map_cursor(double x, double y) {
  std::vector<Setting> changes;
  for (const auto& [of, position] : {std::pair{&map_.x(), x}, {&map_.y(), y}}) {
    const double value = of->scale.value(position);
    if (of->axis == Axis::kTheta) {
      theta_deg_ = value;
    } else {
      // Four digits, as a slider gives.
      changes.push_back({of->key(), TomlText{fmt::format("{:.4g}", of->scale.clamp(value))}});
    }
  }
  set(changes);
}

double Session::map_cursor(const MapAxis& axis) const {
  return axis.scale.position(axis.axis == Axis::kTheta ? theta_deg_
                                                       : scene().number(axis.key()).value_or(axis.scale.from));
}

const Point* Session::at_cursor() const {
  const std::vector<Point>& points = curve_.points();
  if (points.empty()) return nullptr;
  const auto distance = [&](const Point& point) { return std::abs(point.theta_deg - theta_deg_); };
  return &*std::ranges::min_element(points, {}, distance);
}

void Session::follow() {
  const bool keep_all = keeps_all();
  const std::string content = content_key(scene(), edits_.changes(), keep_all);
  curve_.follow(content, scene(), keep_all);
  residuals_.follow(content, scene());
  follow_overlay(content, keep_all);
  follow_map(keep_all);
  sky_.follow(content_key(scene(), edits_.changes_without({"geometry.relative_azimuth_deg"}), false), scene());
  estimate_influences();
  follow_peak();
  is_changed_ = true;
}

void Session::estimate_influences() {
  const JobPart& curve = curve_.finished();
  // It takes as long as a coarse curve: in a drag neither changes.
  std::pair<std::string, double> of{curve.key, theta_deg_};
  if (influences_of_ == of) return;
  influences_of_ = std::move(of);
  effects_ = curve.effects;
  if (effects_.empty()) return;
  const std::vector<Effect> at_cursor =
      dolp::effects(curve.scene, points_at(curve.scene, {theta_deg_}).columns(), true);
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    if (effects_[i].state == EffectState::kKept) effects_[i].influence = at_cursor[i].influence;
  }
}

std::string Session::overlay_name() const {
  if (!overlay_) return {};
  const Scene& shown = overlay_->shown_scene();
  return fmt::format("{} σ {:.4g}, same D(0){}", shown.word("surface.distribution").value(),
                     shown.number("surface.sigma").value(), remark(*overlay_));
}

void Session::follow_overlay(const std::string& content, bool keep_all) {
  if (!view_.has_overlay) {
    overlay_.reset();
    return;
  }
  try {
    const Scene other = scene().with(other_distribution(scene()));
    if (!overlay_) overlay_.emplace(other, "overlay");
    overlay_->follow(content, other, keep_all);
  } catch (const InputError&) {
    overlay_.reset();  // its sigma or q is outside the model
  }
}

std::string Session::refusal(const MapAxis& axis, const Scale& range) const {
  try {
    for (const double end : {range.from, range.to}) {
      if (axis.axis == Axis::kTheta && !description_of(axis.axis).range.contains(end))
        return "must be numbers in [0, 90]";
      if (axis.axis != Axis::kTheta) static_cast<void>(scene().with(axis.key(), end));
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

MapAxis Session::map_axis(Axis axis) const {
  MapAxis suggested = suggested_axis(axis, scene(), view_.theta_max_deg);
  const auto typed = view_.map_ranges.find(suggested.label());
  // The scene may have changed since, and no longer take it.
  if (typed != view_.map_ranges.end() && refusal(suggested, typed->second).empty()) suggested.scale = typed->second;
  return suggested;
}

void Session::follow_map(bool keep_all) {
  if (is_dragged() && map_.is_arriving()) return;  // in a drag it goes from one complete map to the next
  const MapAxis x = map_axis(view_.map_x);
  const MapAxis y = map_axis(view_.map_y);
  std::string key = content_key(scene(), edits_.changes_without({x.key(), y.key()}), keep_all);
  if (x.axis != Axis::kTheta && y.axis != Axis::kTheta) key += "\ntheta=" + format_number(theta_deg_);
  for (const MapAxis& axis : {x, y}) {
    key += fmt::format("\n{} {} {} {}", axis.label(), axis.scale.from, axis.scale.to, axis.scale.is_log);
  }
  map_.follow(key, scene(), keep_all, x, y, theta_deg_);
}

std::vector<Job> Session::wanted_in_drag() const {
  std::vector<Job> jobs;
  const auto add = [&](std::optional<Job> job) {
    if (job) jobs.push_back(std::move(*job));
  };
  const auto add_other = [&](bool is_map) {
    if (is_map && shows_map() && !map_.is_coarse_done()) add(map_.wanted(0));
    if (is_map && view_.panel == Panel::kSky) {
      for (Job& job : sky_.wanted()) jobs.push_back(std::move(job));
    }
    if (!is_map && overlay_) add(overlay_->wanted(Curve::Stage::kCoarse));
  };
  if (!is_curve_next_) add_other(is_map_next_);
  add(curve_.wanted(Curve::Stage::kCoarse));
  if (is_curve_next_) add_other(is_map_next_);
  add_other(!is_map_next_);
  return jobs;
}

std::vector<Job> Session::wanted() const {
  if (is_dragged()) return wanted_in_drag();
  std::vector<Job> jobs;
  const auto add = [&](std::optional<Job> job) {
    if (job) jobs.push_back(std::move(*job));
  };
  add(curve_.wanted(Curve::Stage::kCoarse));
  add(curve_.wanted(Curve::Stage::kFine));
  if (overlay_) add(overlay_->wanted(Curve::Stage::kFine));
  if (shows_map()) add(map_.wanted(0));
  for (Job& job : peak_.wanted()) jobs.push_back(std::move(job));
  add(residuals_.wanted());
  for (const Pin& pin : pins_) add(pin.curve.wanted(Curve::Stage::kFine));
  if (view_.panel == Panel::kSky) {
    for (Job& job : sky_.wanted()) jobs.push_back(std::move(job));
  }
  if (shows_map()) {
    add(map_.wanted(1));
    add(map_.wanted(2));
  }
  return jobs;
}

bool Session::take_changed() { return std::exchange(is_changed_, false); }

void Session::take(const std::vector<JobPart>& news) {
  for (const JobPart& part : news) {
    const bool is_curve = curve_.take(part) || curve_.take_earlier(part);
    if (overlay_ && !overlay_->take(part)) overlay_->take_earlier(part);
    for (Pin& pin : pins_) pin.curve.take(part);
    const bool is_map = map_.take(part);
    is_curve_next_ = !is_curve;
    if (!is_curve) is_map_next_ = !is_map;
    if (is_map && part.is_last && is_dragged()) follow();
    sky_.take(part);
    if (peak_.take(part) && peak_.answer()) {
      for (Pin& pin : pins_) {
        if (pin.curve.key() == curve_.key()) pin.curve.set_peak(peak_.answer()->at);
      }
      curve_.set_peak(peak_.answer()->at);
    }
    residuals_.take(part);
    is_changed_ = is_changed_ || part.is_last;
  }
  follow_peak();
  if (curve_.is_finished() && !news.empty()) estimate_influences();
}

void Session::follow_peak() {
  if (curve_.is_finished()) peak_.follow(curve_, edits_, view_.theta_max_deg);
}

}  // namespace dolp::explore
