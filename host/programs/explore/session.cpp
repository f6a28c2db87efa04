#include "explore/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

std::string text_of(const std::vector<Setting>& changes) {
  std::vector<std::string> texts;
  for (const Setting& change : changes) texts.push_back(change.key + " = " + word_of(change.value));
  return join(texts);
}

}  // namespace

Session::Session(SceneEdits edits)
    : edits_(std::move(edits)),
      curve_(scene()),
      map_(scene()),
      spectral_scene_(scene()),
      peak_(scene()),
      residuals_(scene()) {
  tell_new_remarks_on_scene();
  follow();
}

void Session::attempt(const std::function<void()>& command) {
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
  if (!needed.empty()) tell(fmt::format("{} also sets {}", chosen, text_of(needed)));
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
  to.push_back(edits_);
  edits_.go_to(from.back());
  from.pop_back();
  follow();
}

void Session::take_snapshot() {
  snapshots_.push_back({fmt::format("{}: {}", snapshots_.size() + 1, surface_name(scene())), edits_});
}

void Session::set(const std::vector<Setting>& changes) {
  attempt([&] {
    const std::vector<Setting> needed = needed_with(scene(), changes);
    std::vector<Setting> all = changes;
    all.insert(all.end(), needed.begin(), needed.end());
    edits_.set(all);
    tell_needed(text_of(changes), needed);
  });
}

void Session::reset(const std::string& key) {
  attempt([&] {
    const std::vector<Setting> needed = needed_with(scene(), choices_of(edits_.opened(), key));
    edits_.set(needed);
    edits_.reset(key);
    tell_needed(key + " = as opened", needed);
  });
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

std::optional<FitJob> Session::fit_job() const {
  if (!residuals_.data()) return std::nullopt;
  FitJob job{edits_, *residuals_.data(), {}};
  for (const Parameter& parameter : parameters()) {
    const std::optional<double> value = parameter.value(scene());
    if (value && varies(parameter.key->key)) job.vary.push_back(fit_range(marked_, scene(), parameter, *value));
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
    visited_ = edits_;
  });
}

std::optional<std::size_t> Session::minimum() const {
  return fit_ && visited_->is_same_scene(edits_) ? std::optional(minimum_) : std::nullopt;
}

const FitParameter* Session::fitted(const std::string& key) const {
  if (!minimum()) return nullptr;
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
  if (pins_.size() == kMostPins)
    return tell(fmt::format("{} curves are pinned already: remove one first", kMostPins), true);
  std::size_t colour = 0;
  while (std::ranges::any_of(pins_, [&](const Pin& pin) { return pin.colour == colour; })) ++colour;
  pins_.push_back({.colour = colour, .curve = curve_});
  is_changed_ = true;
}

void Session::set_view(const View& view) {
  const View before = std::exchange(view_, view);
  if (view.quantity != before.quantity || view.is_log != before.is_log) {
    view_.curve_zoom.y.reset();
    view_.map_colours.reset();
  }
  if (view.is_theta_log != before.is_theta_log) view_.curve_zoom.x.reset();
  if (view_.map_x == view_.map_y) view_.map_y = view_.map_x == "sigma" ? "theta" : "sigma";
  view_.theta_max_deg = std::clamp(view_.theta_max_deg, kLeastThetaMaxDeg, 90.0);
  set_theta(theta_deg_);
}

void Session::set_theta(double theta_deg) {
  theta_deg_ = std::clamp(theta_deg, 0.0, view_.theta_max_deg);
  follow();
}

void Session::set_map_cursor(double x, double y) {
  std::vector<Setting> changes;
  for (const auto& [axis, position] : {std::pair{&map_.x(), x}, {&map_.y(), y}}) {
    const double value = axis->scale.value(position);
    if (axis->key.empty()) {
      theta_deg_ = value;
    } else {
      // Four digits, as a slider gives.
      changes.push_back({axis->key, TomlText{fmt::format("{:.4g}", axis->scale.clamp(value))}});
    }
  }
  set(changes);
}

double Session::map_cursor(const MapAxis& axis) const {
  const double value = axis.key.empty() ? theta_deg_ : scene().number(axis.key).value_or(axis.scale.from);
  return axis.scale.position(axis.scale.clamp(value));
}

const Point* Session::at_cursor() const {
  const std::vector<Point>& points = curve_.points();
  if (points.empty()) return nullptr;
  const auto distance = [&](const Point& point) { return std::abs(point.theta_deg - theta_deg_); };
  return &*std::ranges::min_element(points, {}, distance);
}

}  // namespace dolp::explore
