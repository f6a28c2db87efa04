#include "explore/readout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

// If the albedo is outside these limits, the text about the maximum mentions it.
constexpr double kAlbedoMin = 0.95;
constexpr double kAlbedoMax = 1.05;
constexpr double kPercent = 100.0;

/// An error bound of DOLP as text, in percentage points.
std::string points_text(double bound) { return std::isfinite(bound) ? fmt::format("{:.2g}", kPercent * bound) : "∞"; }

struct Part {
  std::string name;
  double q_over_i;  ///< contribution of the effect to Q/I at the cursor
};

/// The contributions of emission, source and surroundings to Q/I at the cursor, whose result is `with`. The class Peak
/// knows them only for effects that can be removed. If the scene is invalid without an effect, its contribution is Q/I
/// minus the others.
std::vector<Part> radiating_parts(const Session& session, const Point& with) {
  double rest = with[Quantity::kQOverI];
  std::vector<Part> parts;
  for (const WithoutEffect& away : session.peak().without()) {
    if (!away.radiates) continue;
    parts.push_back({away.effect, WithoutEffect::contribution(with, *away.at_cursor)});
    rest -= parts.back().q_over_i;
  }
  const bool has_emission = !parts.empty() && parts.front().name == "emission";
  if (has_emission) return parts;
  const auto has = [&](const char* effect) { return has_effect(session.scene(), effect); };
  const char* name = has("emission") ? "emission" : has("source") ? "source" : "surroundings";
  const bool is_known = std::ranges::any_of(parts, [&](const Part& part) { return part.name == name; });
  if (!is_known) parts.insert(parts.begin(), {name, rest});
  return parts;
}

const WithoutEffect* without(const Session& session, const std::string& effect) {  // null if not known at the cursor
  const std::vector<WithoutEffect>& all = session.peak().without();
  const auto away = std::ranges::find(all, effect, &WithoutEffect::effect);
  return away == all.end() || !away->at_cursor ? nullptr : &*away;
}

std::string polarisation(const Point& point) {
  if (point[Quantity::kStokesU] != 0.0) return fmt::format("AOLP {:.2f}°", point[Quantity::kAolp]);
  return point[Quantity::kQOverI] > 0.0 ? "s polarised" : "p polarised";
}

bool is_medium(const std::string& key) {
  return key == "surface.n" || key == "surface.k" || key == "surface.reflectance_file" ||
         key.starts_with("surface.material") || key.starts_with("surface.coating");
}

/// A setting of the scene in words, for a title: "σ 0.3". Empty for settings that change no result.
std::string change_text(const Scene& scene, const Setting& change) {
  const std::string& key = change.key;
  const bool is_table = key.find('.') == std::string::npos;
  if (is_table) return "without " + key;  // a setting can only remove a table
  if (std::holds_alternative<std::monostate>(change.value.content())) return "";
  if (is_medium(key)) return material_name(scene);
  const bool is_flag = described(key).type == Key::Type::kFlag;
  if (is_flag || key.starts_with("grid.") || key.starts_with("accuracy.")) return "";
  const std::vector<double> band = scene.numbers("spectrum.band_um");
  if (key == "spectrum.band_um") return fmt::format("λ {:.4g} to {:.4g} µm", band.at(0), band.at(1));
  const auto shown = std::ranges::find(controls(), key, [](const Control& control) { return control.key->key; });
  if (shown == controls().end()) return key + ' ' + std::filesystem::path(plain_text(change.value)).filename().string();
  if (!shown->is_number()) return shown->label + ' ' + scene.word(key).value_or("");
  return shown->text(scene.number(key).value_or(0.0));
}

std::string without_spectrum(const std::string& title) {  // "Paint, 8-14 um" becomes "Paint"
  const std::size_t comma = title.rfind(", ");
  const bool has_unit = title.ends_with("um") || title.ends_with("µm");
  return has_unit && comma != std::string::npos ? title.substr(0, comma) : title;
}

bool has_q_over_i(const Point& point) { return point.is_good() && std::isfinite(point[Quantity::kQOverI]); }

using nlohmann::json;

json axis_json(const std::string& label, const Scale& scale) {
  return {{"label", label}, {"from", scale.from}, {"to", scale.to}, {"is_log", scale.is_log}};
}

/// `style` is "curve", "overlay", or the number of a pin's colour (Pin::colour).
json curve_json(const std::string& name, const json& style, const std::vector<Point>& points, Plotted quantity) {
  const PlottedDescription& description = described(quantity);
  json curve = {{"name", name}, {"style", style}};
  for (const char* list : {"at", "values", "good", "low", "high"}) curve[list] = json::array();
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const Point& point : points) {
    const double value = description.shown(point);
    const auto band_end = [&](Quantity end) {
      const bool has_band = quantity == Plotted::kDolp && style == "curve" && point.is_good() && point.has_bracket();
      return has_band ? json(description.scale() * point[end]) : json();
    };
    curve["at"].push_back(point.theta_deg);
    curve["values"].push_back(description.jumps(std::exchange(last, value), value) ? json() : json(value));
    curve["good"].push_back(point.is_good());
    curve["low"].push_back(band_end(Quantity::kDolpLow));
    curve["high"].push_back(band_end(Quantity::kDolpHigh));
  }
  return curve;
}

/// The curve over another number of the scene (Session::sweep()), with its axes. Null if the window does not show it.
json sweep_json(const Session& session) {
  const Sweep& sweep = session.sweep();
  const std::string name = swept_name(session.view().panel);
  if (name.empty() || !sweep.is_finished()) return {};
  const PlottedDescription& quantity = described(session.view().quantity);
  json curve = curve_json(sweep_name(session), "curve", sweep.points(), quantity.quantity);
  curve["at"] = sweep.at();
  return {{"x", axis_json(session.sweep_axis().label, session.sweep_axis().scale)},
          {"y", axis_json(quantity.label(), sweep_values(session))},
          {"curves", {curve}},
          {"measured", json::array()}};
}

json map_json(const Session& session) {
  const PlottedDescription& description = described(session.view().quantity);
  const MapField field = session.map().field(description.quantity);
  if (session.view().panel != Panel::kMap || field.count == 0) return {};
  json rows(field.count, json::array());
  for (std::size_t i = 0; i < field.values.size(); ++i)
    rows[i / field.count].push_back(description.scale() * field.values[i]);  // in JSON a NaN becomes null
  json colours;                                                              // null unless the user typed a range
  if (const auto& typed = session.view().range(View::kColours)) {
    colours = {{"from", description.scale() * typed->from}, {"to", description.scale() * typed->to}};
  }
  return {{"x", axis_json(session.map().x().label, session.map().x().scale)},
          {"y", axis_json(session.map().y().label, session.map().y().scale)},
          {"label", description.label()},
          {"is_log", session.view().is_log},
          {"is_signed", description.is_signed},
          {"colours", colours},
          {"rows", rows}};
}

}  // namespace

const char* stale_text(bool is_stale) { return is_stale ? ", the scene before" : ""; }

const char* remark(const Session& session, const Curve& curve) {
  if (session.is_outdated(curve)) return stale_text(true);
  return curve.points().empty() || (curve.is_finished() && !session.is_dragged()) ? "" : ", coarse";
}

std::string curve_name(const Session& session) {
  return surface_name(session.curve().shown_scene()) + remark(session, session.curve());
}

std::string overlay_name(const Session& session) {
  if (!session.overlay()) return {};
  const Scene& shown = session.overlay()->shown_scene();
  return slopes_name(shown) + ", same D(0)" + remark(session, *session.overlay());
}

std::string pin_name(const Session& session, const Pin& pin) {
  const Scene& scene = pin.curve.shown_scene();
  const std::string name = pin.name.empty() ? surface_name(scene, &session.curve().shown_scene()) : pin.name;
  return name + (session.is_foreign(scene) ? ", another scene" : stale_text(pin.curve.is_stale()));
}

std::string zenith_label(const Scene& scene) {
  return is_bistatic(scene) ? "zenith θ of the source [°]" : "zenith θ [°]";
}

std::string sweep_name(const Session& session) {
  return fmt::format("{}θ = {:.4g}°", is_bistatic(session.scene()) ? "source at " : "", session.theta_deg());
}

Scale sweep_values(const Session& session) {
  const PlottedDescription& quantity = described(session.view().quantity);
  std::vector<double> values;
  for (const Point& point : session.sweep().points()) {
    if (point.is_good()) values.push_back(quantity.shown(point));
  }
  const Scale automatic = value_scale(std::move(values), session.view().is_log);
  return session.view().range(View::kSweepValues).value_or(automatic);
}

std::string no_residuals_text(const Session& session, const Scale& theta) {
  const Plotted shown = session.view().quantity;
  const std::vector<Measurement>& all = session.residuals().data().value().measurements;
  if (all.empty()) return "the file has no points";
  const bool is_shown = !session.residuals().measured(shown).empty();
  if (!is_shown) return fmt::format("measured: {}; choose it above", described(plotted(all[0].observable)).name);
  if (!session.residuals().is_known()) return "…";
  const std::vector<Measurement> residuals = session.residuals().residuals(shown);
  if (residuals.empty()) return "the model has no value at the measured points";
  const auto is_inside = [&](const Measurement& point) {
    return theta.from <= point.theta_deg && point.theta_deg <= theta.to;
  };
  return std::ranges::any_of(residuals, is_inside) ? "" : "no measured point is at these zeniths";
}

std::string view_refusal(const Session& session, Panel panel) {
  const Scene& scene = session.scene();
  const bool has_index = !scene.word("surface.reflectance_file");
  const bool is_rough = scene.number("surface.sigma") > 0.0;
  const bool has_cross = has_cross_slopes(scene);
  if (panel == Panel::kSlopes && !is_rough) return "A mirror: all facets lie in the mean plane.";
  if (panel == Panel::kSlopes && has_cross)
    return "D depends on the azimuth of the facets, too: slopes differ along and across.";
  if (panel == Panel::kMaterial && !has_index) return "The scene has measured reflectances instead of n and k.";
  if (panel == Panel::kScattering && !has_index) return "The pBRDF needs phases, which measured reflectances lack.";
  if (panel == Panel::kShapes && is_bistatic(scene))
    return "A sphere needs all directions of view, and bistatic mode has one: choose the mode hemispherical.";
  if (panel == Panel::kShapes && has_cross)
    return "Slopes differ along and across, and a sphere has no single direction along.";
  if (panel == Panel::kAzimuth && !has_cross)
    return "All azimuths are alike: slopes are equal along and across. Move σ_c, or choose a directional wind.";
  if (panel == Panel::kSky && !is_bistatic(scene)) return "This view needs a source: choose the mode bistatic.";
  if (panel == Panel::kCamera && !is_bistatic(scene))
    return "This view needs a camera beside a source: choose the mode bistatic.";
  if (panel == Panel::kFit && !session.last_fit())
    return "No fit yet: load measured points (Ctrl+O), mark the numbers that vary in the boxes beside their sliders, "
           "then press Ctrl+F.";
  return "";
}

std::string quantity_refusal(const Scene& scene, Plotted quantity) {
  const bool needs_u = quantity == Plotted::kUOverI || quantity == Plotted::kAolp;
  if (!needs_u || has_cross_slopes(scene) || is_bistatic(scene)) return "";
  return "U is 0: slopes are equal along and across, and the mode is hemispherical.";
}

std::string headline(const Session& session) {
  const Point* const shown = session.at_cursor();
  if (!shown) return "At the cursor: …";
  const std::string place =
      fmt::format("At the cursor{}, θ = {:.1f}°", remark(session, session.curve()), shown->theta_deg);
  const std::string status = shown->is_trusted() ? "" : " (" + status_text(shown->status) + ')';
  if (!shown->is_good()) return fmt::format("{}: no DOLP{}. {}", place, status, peak_text(session));
  return fmt::format("{}: DOLP {:.3f} % ± {}, {}{}. {}", place, kPercent * (*shown)[Quantity::kDolp],
                     points_text((*shown)[Quantity::kErrorEstimate]), polarisation(*shown), status, peak_text(session));
}

std::string peak_text(const Session& session) {
  const std::optional<PeakAnswer>& peak = session.peak().answer();
  if (!session.curve().is_finished() || !peak) return "Maximum: …";
  const Point& at = peak->at;
  const double error = at[Quantity::kErrorEstimate];
  if (at[Quantity::kDolp] <= error) return "Maximum: 0 everywhere, within its bound.";
  const bool has_range = !peak->rival_deg && peak->theta_low_deg < peak->theta_high_deg;
  std::string text =
      fmt::format("Maximum: {:.3f} % ± {} at {}, {}", kPercent * at[Quantity::kDolp], points_text(error),
                  has_range ? fmt::format("{:.2f}° to {:.2f}°", peak->theta_low_deg, peak->theta_high_deg)
                            : fmt::format("{:.2f}°", at.theta_deg),
                  polarisation(at));
  if (!at.is_trusted()) text += ", " + status_text(at.status);
  if (peak->rival_deg)
    text += fmt::format("; within this bound also elsewhere, for example at {:g}°", *peak->rival_deg);
  if (peak->is_at_end) text += ", at the end of the good range";
  // The error bound of DOLP contains only numerical errors. The albedo shows whether the surface model itself errs.
  const double albedo = at[Quantity::kAlbedo];
  if (albedo < kAlbedoMin) text += fmt::format("; the surface model loses energy there (albedo {:.2f})", albedo);
  if (albedo > kAlbedoMax) text += fmt::format("; the surface model gains energy there (albedo {:.2f})", albedo);
  return text + '.';
}

std::string cause_text(const Session& session) {
  if (!session.curve().is_finished() || !session.peak().is_complete()) return "Cause: …";
  const Point& shown = session.peak().cursor();
  const double sum = shown[Quantity::kQOverI];
  if (!has_q_over_i(shown)) return "Cause: the model fails at the cursor.";
  std::string with, against;
  for (const Part& part : radiating_parts(session, shown)) {
    std::string& side = part.q_over_i * sum >= 0.0 ? with : against;
    side += fmt::format("{}{} {:+.2f}", side.empty() ? "" : ", ", part.name, kPercent * part.q_over_i);
  }
  std::string text = fmt::format("Cause, in points of Q/I (+ is s, - is p): {}", with);
  if (!against.empty()) text += "; against it: " + against;
  return text + fmt::format("; sum {:+.2f}.", kPercent * sum);
}

std::string cursor_text(const Session& session) {
  const Point* const shown = session.at_cursor();
  if (!shown) return "Cursor: …";
  const Point& r = *shown;
  const Scene& scene = session.curve().shown_scene();
  std::string shape;
  for (const char* key : {"surface.sigma", kSigmaCross, "surface.wind_m_s", "surface.q", kSurfaceAzimuth}) {
    const std::optional<double> value = scene.number(key) ? control(key).value(scene) : std::nullopt;
    if (value) shape += fmt::format("{}{} = {:.4g}", shape.empty() ? "" : ", ", control(key).label, *value);
  }
  std::string text = fmt::format("Cursor{}: {}: Q/I {:+.3f} %", remark(session, session.curve()), shape,
                                 kPercent * r[Quantity::kQOverI]);
  if (r[Quantity::kStokesU] != 0.0 && r.is_good()) {
    text += fmt::format(", U/I {:+.3f} %", described(Plotted::kUOverI).shown(r));
  }
  if (r.has_bracket()) {
    text += fmt::format(", all bounces {:.3f} to {:.3f} %", kPercent * r[Quantity::kDolpLow],
                        kPercent * r[Quantity::kDolpHigh]);
  }
  if (std::isfinite(r[Quantity::kRhoI])) {
    for (const Plotted quantity : {Plotted::kRhoS, Plotted::kRhoP}) {
      text += fmt::format(", {} {:.4f}", described(quantity).name, described(quantity).value(r));
    }
  }
  if (std::isfinite(r[Quantity::kAlbedo])) text += fmt::format(", albedo {:.3f}", r[Quantity::kAlbedo]);
  return text + "; " + status_text(r.status);
}

std::string without_text(const Session& session, const std::string& effect) {
  const WithoutEffect* const away = without(session, effect);
  if (!away) return {};
  const bool is_known = has_q_over_i(*away->at_cursor) && has_q_over_i(session.peak().cursor());
  if (!is_known) return "the model fails";
  return fmt::format("{:+.2f} → {:+.2f} %", kPercent * session.peak().cursor()[Quantity::kQOverI],
                     kPercent * (*away->at_cursor)[Quantity::kQOverI]);
}

std::string without_words(const Session& session, const std::string& effect) {
  const WithoutEffect* const away = without(session, effect);
  if (!away) return {};
  std::vector<std::string> sentences;
  const auto add = [&](const char* place, const Point& with, const Point& without) {
    if (!has_q_over_i(with) || !has_q_over_i(without)) return;
    const double before = kPercent * with[Quantity::kQOverI], after = kPercent * without[Quantity::kQOverI];
    sentences.push_back(
        fmt::format("At the {}, θ = {:.2f}°, Q/I is {:+.2f} %. Without {} it is {:+.2f} %, a change of "
                    "{:+.2f} points.",
                    place, with.theta_deg, before, effect, after, after - before));
  };
  add("cursor", session.peak().cursor(), *away->at_cursor);
  add("maximum of the curve", session.peak().answer()->at, *away->at_peak);
  return fmt::format("{}", fmt::join(sentences, "\n"));
}

std::vector<std::string> about_lines(const Session& session) {
  std::string device;
  for (const Attribute& attribute : session.curve().finished().results.attributes) {
    const bool is_device = attribute.name == "device" || attribute.name == "driver";
    if (is_device) device += (device.empty() ? "" : ", ") + std::get<std::string>(attribute.value);
  }
  return {"version  " + version(), "commit   " + commit(), "device   " + (device.empty() ? "…" : device)};
}

std::string figure_title(const SceneEdits& edits) {
  const Scene& scene = edits.scene();
  std::string title = scene.title();
  std::vector<std::string> changed;
  for (const Setting& change : scene.settings()) {
    if (change.key == "title") return title;
    const std::string text = change_text(scene, change);
    if (!text.empty() && std::ranges::count(changed, text) == 0) changed.push_back(text);
    if (change.key.starts_with("spectrum.")) title = without_spectrum(title);
  }
  const std::string words = join(changed);
  if (title.empty() || words.empty()) return title + words;
  return title + (words.starts_with("without") ? " " : " with ") + words;
}

std::string table_command(const SceneEdits& edits) {
  const std::string& file = edits.opened().name();
  std::string command = "dolp table " + shell_quoted(file);
  for (const Setting& change : edits.changes()) command += " --set " + shell_quoted(change.text());
  return command + " -o table.nc";
}

std::vector<std::string> cost_lines(const Session& session) {
  const Curve& curve = session.curve();
  if (!curve.is_finished()) return {"time …", "work …", "error …"};
  const double points = static_cast<double>(curve.points().size());
  const double wall_s = curve.finished().wall_s;
  constexpr double kMilliseconds = 1e3;
  constexpr double kMicroseconds = 1e6;
  return {fmt::format("time    {:.1f} ms for {} directions, {:.0f} µs each", kMilliseconds * wall_s, points,
                      kMicroseconds * wall_s / points),
          fmt::format("work    {:.0f} integrand evaluations an entry",
                      curve.finished().results.integrand_evaluations / points),
          fmt::format("error   DOLP ≤ {:.2g}; tolerance {:.2g}", curve.worst_error(),
                      *curve.scene().number("accuracy.tolerance"))};
}

std::string plot_json(const Session& session, const Scale& x, const Scale& y) {
  const Plotted quantity = session.view().quantity;
  json curves = json::array();
  const auto add = [&](const std::string& name, const json& style, const Curve& curve) {
    curves.push_back(curve_json(name, style, curve.drawn(), quantity));
  };
  add(curve_name(session), "curve", session.curve());
  if (session.overlay()) add(overlay_name(session), "overlay", *session.overlay());
  for (const Pin& pin : session.pins()) {
    if (!pin.is_visible) continue;
    const Scene& scene = pin.curve.shown_scene();
    std::string name = pin.name.empty() ? surface_name(scene) : pin.name;
    if (name == surface_name(session.curve().shown_scene())) name = pin_name(session, pin);
    add(name, pin.colour, pin.curve);
  }
  json measured = json::array();
  const double scale = described(quantity).scale();
  for (const Measurement& point : session.residuals().measured(quantity)) {
    measured.push_back({{"at", point.theta_deg},
                        {"value", scale * point.value},
                        {"uncertainty", scale * point.uncertainty.value_or(0.0)}});
  }
  return json{{"title", figure_title(session.edits())},
              {"x", axis_json(zenith_label(session.scene()), x)},
              {"y", axis_json(described(quantity).label(), y)},
              {"curves", curves},
              {"measured", measured},
              {"map", map_json(session)},
              {"sweep", sweep_json(session)}}
      .dump();
}

}  // namespace dolp::explore
