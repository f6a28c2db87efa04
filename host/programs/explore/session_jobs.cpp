// The results of a session: the jobs that it wants, and where their results go.
#include <fmt/format.h>

#include <algorithm>

#include "base/text.hpp"
#include "explore/session.hpp"

namespace dolp::explore {
namespace {

/// A list of jobs, the most wanted first.
struct JobList {
  std::vector<Job> jobs;

  void add(std::optional<Job> job) {
    if (job) jobs.push_back(std::move(*job));
  }
  void add(std::vector<Job> more) { std::ranges::move(more, std::back_inserter(jobs)); }
};

/// Gives an axis the range that was typed for it, or else the range in which the scene is known. False where that is
/// one value.
bool find_range(const Scene& scene, const View& view, MapAxis& axis) {
  const auto typed = view.map_ranges.find(axis.label);
  // The scene may have changed since the range was typed, and no longer take it.
  if (typed != view.map_ranges.end() && refusal(scene, axis, typed->second).empty()) {
    axis.scale = typed->second;
  } else if (axis.name == "wavelength") {
    axis.scale = known_part(scene, axis);
  }
  return axis.scale.refusal().empty();
}

constexpr const char* kWavelength = "spectrum.wavelength_um";

/// The axis of this name, or, where the scene has none, another one than `other`.
MapAxis axis_or_another(const Scene& scene, const View& view, const std::string& name, const std::string& other) {
  std::vector<MapAxis> axes = map_axes(scene, view.theta_max_deg);
  const auto named = std::ranges::find(axes, name, &MapAxis::name);
  if (named != axes.end() && find_range(scene, view, *named)) return *named;
  MapAxis& another = axes[axes.front().name == other ? 1 : 0];
  find_range(scene, view, another);
  return another;
}

}  // namespace

std::string content_key(const Scene& scene, const std::vector<Setting>& changes, bool keep_all) {
  std::string key = (keep_all ? "all " : "plan ") + scene.name() + '\n' + scene.text();
  for (const Setting& change : changes) key += '\n' + change.text();
  return key;
}

void Session::follow() {
  const std::string content = content_key(scene(), edits_.changes(), keeps_all());
  curve_.follow(content, scene(), keeps_all());
  residuals_.follow(content, scene());
  follow_overlay(content);
  follow_map();
  follow_sweeps(content);
  source_sky_.follow(content_key(scene(), edits_.changes_without({"geometry.relative_azimuth_deg"}), false), scene());
  estimate_influences();
  follow_peak();
  is_changed_ = true;
}

void Session::estimate_influences() {
  const JobPart& curve = curve_.finished();
  // The estimate takes as long as a coarse curve. In a drag neither curve nor zenith changes.
  std::pair<std::string, double> wanted{curve.key, theta_deg_};
  if (influences_of_ == wanted) return;
  influences_of_ = std::move(wanted);
  effects_ = curve.effects;
  if (effects_.empty()) return;
  const std::vector<Effect> at_cursor =
      dolp::effects(curve.scene, points_at(curve.scene, {theta_deg_}).columns(), true);
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    if (effects_[i].state == EffectState::kKept) effects_[i].influence = at_cursor[i].influence;
  }
}

void Session::follow_overlay(const std::string& content) {
  if (!view_.has_overlay) return overlay_.reset();
  try {
    const Scene other = scene().with(other_distribution(scene()));
    if (!overlay_) overlay_.emplace(other, "overlay");
    overlay_->follow(content, other, keeps_all());
  } catch (const InputError&) {
    overlay_.reset();  // its sigma or q is outside the model
  }
}

void Session::follow_map() {
  if (is_dragged() && map_.is_arriving()) return;  // a drag goes from one complete map to the next
  const MapAxis x = axis_or_another(scene(), view_, view_.map_x, view_.map_y);
  const MapAxis y = axis_or_another(scene(), view_, view_.map_y, x.name);
  std::string key = content_key(scene(), edits_.changes_without({x.key, y.key}), keeps_all());
  if (!x.key.empty() && !y.key.empty()) key += "\ntheta=" + format_number(theta_deg_);
  for (const MapAxis& axis : {x, y})
    key += fmt::format("\n{} {} {} {}", axis.label, axis.scale.from, axis.scale.to, axis.scale.is_log);
  map_.follow(key, scene(), keeps_all(), x, y, theta_deg_);
}

void Session::follow_sweeps(const std::string& content) {
  constexpr std::size_t kSpectrum = 121;
  constexpr std::size_t kSmooth = 901;  // fringes of films, in closed form
  constexpr double kWidth = 2.0;        // from half of the opened scene's wavelength to twice
  const bool is_spectrum = view_.panel == Panel::kSpectrum;
  if (!is_spectrum && view_.panel != Panel::kSmooth) return;
  spectral_scene_ = at_one_wavelength(scene());
  const auto [from_um, to_um] = spectrum_um(edits_.opened());
  wavelengths_ = {"wavelength", parameter(kWavelength).label(), kWavelength, {from_um / kWidth, to_um * kWidth}};
  wavelengths_.scale = wavelengths_.scale.including(spectral_scene_.number(kWavelength).value());
  const bool has_range = find_range(spectral_scene_, view_, wavelengths_);
  const auto follow_wavelengths = [&](Sweep& sweep, const Scene& one, std::size_t count, bool keep_all) {
    if (!has_range) return;
    PointList list = points_at(one, std::vector<double>(count, theta_deg_));
    std::vector<double>& all = list["wavelength_um"];
    for (std::size_t i = 0; i < count; ++i)
      all.push_back(wavelengths_.scale.value(static_cast<double>(i) / static_cast<double>(count - 1)));
    const std::string key = fmt::format("{} wavelengths from {} to {}, {} at {}\n{}", count, all.front(), all.back(),
                                        wavelengths_.scale.is_log, theta_deg_, content);
    sweep.follow(key, one, list, "wavelength_um", keep_all);
  };
  if (is_spectrum) return follow_wavelengths(spectrum_, spectral_scene_, kSpectrum, keeps_all());
  const Scene smooth = smooth_scene(scene());
  smooth_.follow("smooth\n" + content, smooth, points_at(smooth, zeniths(0.0, 90.0, Curve::kFineCount)), "theta_deg",
                 true);
  follow_wavelengths(smooth_spectrum_, smooth_scene(spectral_scene_), kSmooth, true);
}

void Session::follow_peak() {
  if (curve_.is_finished()) peak_.follow(curve_, edits_, view_.theta_max_deg);
}

std::vector<Job> Session::wanted_in_drag() const {
  JobList list;
  const auto add_other = [&](bool is_map) {
    if (is_map && shows_map() && !map_.is_coarse_done()) list.add(map_.wanted(0));
    if (is_map && view_.panel == Panel::kSky) list.add(source_sky_.wanted());
    if (!is_map && overlay_) list.add(overlay_->wanted(Curve::Stage::kCoarse));
  };
  if (!is_curve_next_) add_other(is_map_next_);
  list.add(curve_.wanted(Curve::Stage::kCoarse));
  if (is_curve_next_) add_other(is_map_next_);
  if (view_.panel == Panel::kSmooth) list.add(smooth_.wanted());
  if (view_.panel == Panel::kSmooth) list.add(smooth_spectrum_.wanted());
  add_other(!is_map_next_);
  return list.jobs;
}

std::vector<Job> Session::wanted() const {
  if (is_dragged()) return wanted_in_drag();
  JobList list;
  list.add(curve_.wanted(Curve::Stage::kCoarse));
  list.add(curve_.wanted(Curve::Stage::kFine));
  if (overlay_) list.add(overlay_->wanted(Curve::Stage::kFine));
  if (shows_map()) list.add(map_.wanted(0));
  if (view_.panel == Panel::kSmooth) list.add(smooth_.wanted());
  if (view_.panel == Panel::kSmooth) list.add(smooth_spectrum_.wanted());
  if (view_.panel == Panel::kSpectrum) list.add(spectrum_.wanted());
  list.add(peak_.wanted());
  list.add(residuals_.wanted());
  for (const Pin& pin : pins_) list.add(pin.curve.wanted(Curve::Stage::kFine));
  if (view_.panel == Panel::kSky) list.add(source_sky_.wanted());
  for (std::size_t level = 1; shows_map() && level < HeatMap::kLevels.size(); ++level) list.add(map_.wanted(level));
  return list.jobs;
}

void Session::take(const std::vector<JobPart>& news) {
  for (const JobPart& part : news) {
    const bool is_curve = curve_.take(part) || curve_.take_earlier(part);
    if (overlay_ && !overlay_->take(part)) overlay_->take_earlier(part);
    for (Pin& pin : pins_) pin.curve.take(part);
    const bool is_map = map_.take(part);
    is_curve_next_ = !is_curve;
    if (!is_curve) is_map_next_ = !is_map;
    if (is_map && part.is_last && is_dragged()) follow();
    source_sky_.take(part);
    for (Sweep* sweep : {&spectrum_, &smooth_, &smooth_spectrum_}) sweep->take(part);
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

}  // namespace dolp::explore
