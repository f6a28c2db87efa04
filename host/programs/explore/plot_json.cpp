#include <nlohmann/json.hpp>

#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

using nlohmann::json;

json axis_json(const std::string& label, const Scale& scale) {
  return {{"label", label}, {"from", scale.from}, {"to", scale.to}, {"is_log", scale.is_log}};
}

struct NamedPoints {
  std::string name;
  json style;  ///< "curve", "overlay", or the number of a pin's colour (Pin::colour)
  std::vector<double> at;
  std::vector<Point> points;
};

NamedPoints curve_points(const Curve& curve, const std::string& name, const json& style) {
  NamedPoints named{name, style, {}, curve.drawn()};
  for (const Point& point : named.points) named.at.push_back(point.theta_deg);
  return named;
}

json curve_json(const NamedPoints& curve, Plotted quantity) {
  const PlottedDescription& description = described(quantity);
  double last = 0.0;
  json values = json::array(), good = json::array(), low = json::array(), high = json::array();
  for (const Point& point : curve.points) {
    const double value = description.shown(point);
    const bool is_gap = !values.empty() && description.jumps(last, value);
    values.push_back(is_gap ? json() : json(value));
    last = value;
    good.push_back(point.is_good());
    const bool has_band =
        quantity == Plotted::kDolp && curve.style == "curve" && point.is_good() && point.has_bracket();
    low.push_back(has_band ? json(description.scale() * point[Quantity::kDolpLow]) : json());
    high.push_back(has_band ? json(description.scale() * point[Quantity::kDolpHigh]) : json());
  }
  return {{"name", curve.name}, {"style", curve.style}, {"at", curve.at}, {"values", values},
          {"good", good},       {"low", low},           {"high", high}};
}

/// The curve over another number of the scene (Session::sweep()), with its axes. Null if the window does not show it.
json sweep_json(const Session& session) {
  const Sweep& sweep = session.sweep();
  const std::string name = swept_name(session.view().panel);
  if (name.empty() || !sweep.is_finished()) return {};
  const PlottedDescription& quantity = described(session.view().quantity);
  return {{"x", axis_json(session.sweep_axis().label, session.sweep_axis().scale)},
          {"y", axis_json(quantity.label(), sweep_values(session))},
          {"curves", {curve_json({sweep_name(session), "curve", sweep.at(), sweep.points()}, quantity.quantity)}},
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
  const auto map_axis_json = [](const MapAxis& axis) { return axis_json(axis.label, axis.scale); };
  return {{"x", map_axis_json(session.map().x())},
          {"y", map_axis_json(session.map().y())},
          {"label", description.label()},
          {"is_log", session.view().is_log},
          {"is_signed", description.is_signed},
          {"colours", colours},
          {"rows", rows}};
}

}  // namespace

std::string plot_json(const Session& session, const Scale& x, const Scale& y) {
  const Plotted quantity = session.view().quantity;
  json curves = json::array();
  curves.push_back(curve_json(curve_points(session.curve(), curve_name(session), "curve"), quantity));
  if (session.overlay())
    curves.push_back(curve_json(curve_points(*session.overlay(), overlay_name(session), "overlay"), quantity));
  for (const Pin& pin : session.pins()) {
    if (!pin.is_visible) continue;
    const Scene& scene = pin.curve.shown_scene();
    std::string name = pin.name.empty() ? surface_name(scene) : pin.name;
    if (name == surface_name(session.curve().shown_scene())) name = pin_name(session, pin);
    curves.push_back(curve_json(curve_points(pin.curve, name, pin.colour), quantity));
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
