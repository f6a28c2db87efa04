#include <nlohmann/json.hpp>

#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

using nlohmann::json;

json axis_json(const std::string& label, const Scale& scale) {
  return {{"label", label}, {"from", scale.from}, {"to", scale.to}, {"is_log", scale.is_log}};
}

/// `style` is "curve", "overlay", or the number of a pin's colour (Pin::colour).
json curve_json(const Curve& curve, const std::string& name, const json& style, Plotted quantity) {
  const PlottedDescription& description = described(quantity);
  json theta = json::array(), values = json::array(), good = json::array(), low = json::array(), high = json::array();
  for (const Point& point : curve.drawn()) {
    theta.push_back(point.theta_deg);
    values.push_back(description.shown(point));
    good.push_back(point.is_good());
    const bool has_band = quantity == Plotted::kDolp && style == "curve" && point.is_good() && point.has_bracket();
    low.push_back(has_band ? json(description.scale() * point[Quantity::kDolpLow]) : json());
    high.push_back(has_band ? json(description.scale() * point[Quantity::kDolpHigh]) : json());
  }
  return {{"name", name}, {"style", style}, {"theta_deg", theta}, {"values", values},
          {"good", good}, {"low", low},     {"high", high}};
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
  curves.push_back(curve_json(session.curve(), curve_name(session), "curve", quantity));
  if (session.overlay()) curves.push_back(curve_json(*session.overlay(), overlay_name(session), "overlay", quantity));
  for (const Pin& pin : session.pins()) {
    if (!pin.is_visible) continue;
    const Scene& scene = pin.curve.shown_scene();
    std::string name = pin.name.empty() ? surface_name(scene) : pin.name;
    if (name == surface_name(session.curve().shown_scene())) name = pin_name(session, pin);
    curves.push_back(curve_json(pin.curve, name, pin.colour, quantity));
  }
  json measured = json::array();
  const double scale = described(quantity).scale();
  for (const Measurement& point : session.residuals().measured(quantity)) {
    measured.push_back({{"theta_deg", point.theta_deg},
                        {"value", scale * point.value},
                        {"uncertainty", scale * point.uncertainty.value_or(0.0)}});
  }
  return json{{"title", figure_title(session.edits())},
              {"x", axis_json("zenith θ [°]", x)},
              {"y", axis_json(described(quantity).label(), y)},
              {"curves", curves},
              {"measured", measured},
              {"map", map_json(session)}}
      .dump();
}

}  // namespace dolp::explore
