#include "explore/window/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

constexpr float kCurveWidth = 2.0F;
// In lines of text.
constexpr float kRoomForTwo = 18.0F;        // from which on the legend has two lines
constexpr float kRoomForResiduals = 17.0F;  // from which on residuals are shown
constexpr float kLeastResiduals = 7.0F;

/// A curve as it is drawn.
struct Shown {
  const Curve* curve;
  CurveStyle style;
  std::string name;
};

std::vector<Shown> shown_curves(const Session& session) {
  std::vector<Shown> curves;
  const auto add = [&](const Curve& curve, const CurveStyle& style, const std::string& name) {
    curves.push_back({&curve, session.is_outdated(curve) ? stale(style) : style, name});
  };
  if (session.overlay()) add(*session.overlay(), overlay_style(), session.overlay_name());
  for (const Pin& pin : session.pins()) {
    if (pin.is_visible) add(pin.curve, pin_style(pin.colour), pin_name(pin, session));
  }
  // Last, so that it lies over the others.
  add(session.curve(), current_style(), curve_name(session));
  return curves;
}

double scale_of(Plotted quantity) { return described(quantity).scale(); }

/// The value of a point as it is shown.
double shown_value(Plotted quantity, const Point& point) {
  return scale_of(quantity) * described(quantity).value(point);
}

/// The maximum of polarisation where the plot has a mark of it; null elsewhere.
const PeakAnswer* shown_peak(const Session& session) {
  const Plotted quantity = session.view().quantity;
  const bool is_marked = quantity == Plotted::kDolp || quantity == Plotted::kSignedDolp;
  const std::optional<PeakAnswer>& peak = session.peak().answer();
  return is_marked && peak && session.curve().is_finished() ? &*peak : nullptr;
}

/// The range that the axis of values must cover.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool is_empty() const { return !(low <= high); }
};

Range range_of(const Session& session, const std::vector<Shown>& curves, bool is_log) {
  const Plotted quantity = session.view().quantity;
  Range range;
  const auto add = [&](double value) {
    if (!is_log || value > 0.0) range.add(value);
  };
  for (const Shown& shown : curves) {
    for (const Point& point : shown.curve->drawn()) {
      if (point.theta_deg > session.view().theta_max_deg) break;
      if (!point.is_good()) continue;
      add(shown_value(quantity, point));
      if (shown.curve != &session.curve() || quantity != Plotted::kDolp) continue;
      add(scale_of(quantity) * point[Quantity::kDolpLow]);
      add(scale_of(quantity) * point[Quantity::kDolpHigh]);
    }
  }
  for (const Measurement& one : session.residuals().measured(quantity)) add(scale_of(quantity) * one.value);
  return range;
}

PlotAxis value_axis(const Session& session, const std::vector<Shown>& curves) {
  const bool is_log = session.view().is_log;
  PlotAxis axis{described(session.view().quantity).label(), {0.0, 1.0, is_log}};
  double& from = axis.scale.from;
  double& to = axis.scale.to;
  Range range = range_of(session, curves, is_log);
  if (range.is_empty()) range = {is_log ? 0.01 : 0.0, 1.0};
  if (is_log) {
    constexpr double kMostDecades = 1e6;
    constexpr double kRoom = 4.0;  // for the mark of the maximum
    to = kRoom * range.high;
    from = std::max(range.low / 1.5, to / kMostDecades);
    return axis;
  }
  range.add(0.0);
  const double room = 0.06 * std::max(range.high - range.low, 1e-9);
  from = range.low < 0.0 ? range.low - room : 0.0;
  to = range.high > 0.0 ? range.high + 2.0 * room : 0.0;
  if (to <= from) to = from + 1.0;
  return axis;
}

/// Fills the range of DOLP with all bounces; for the current curve alone, because overlapping bands are unreadable.
void draw_bracket(const Plot& plot, const Shown& shown) {
  const std::vector<Point> points = shown.curve->drawn();
  const ImU32 colour = band_colour(shown.style);
  const auto at = [&](const Point& point, Quantity limit) {
    return plot.at(point.theta_deg, std::max(scale_of(Plotted::kDolp) * point[limit], plot.y().from));
  };
  // Smooth edges are off: they would show as seams.
  const ImDrawListFlags flags = std::exchange(plot.list()->Flags, ImDrawListFlags_None);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point& a = points[i];
    const Point& b = points[i + 1];
    if (!plot.has_place(a.theta_deg, 1.0) || !a.is_good() || !b.is_good() || !a.has_bracket() || !b.has_bracket())
      continue;
    plot.list()->AddQuadFilled(at(a, Quantity::kDolpLow), at(a, Quantity::kDolpHigh), at(b, Quantity::kDolpHigh),
                               at(b, Quantity::kDolpLow), colour);
  }
  plot.list()->Flags = flags;
}

/// Draws the good parts in the curve's style, the others thin and grey.
void draw_curve(const Plot& plot, const Shown& shown, Plotted quantity) {
  std::vector<ImVec2> line;
  bool is_good_part = true;
  const auto finish = [&] {
    const CurveStyle bad{kBadColour, 4.0F, 4.0F};
    draw_line(plot.list(), line, is_good_part ? shown.style : bad, is_good_part ? kCurveWidth : 1.0F);
    line.clear();
  };
  for (const Point& point : shown.curve->drawn()) {
    const double value = shown_value(quantity, point);
    if (!plot.has_place(point.theta_deg, value)) {
      finish();
      continue;
    }
    const ImVec2 at = plot.at(point.theta_deg, value);
    if (point.is_good() != is_good_part) {
      // The line between a good entry and another is not good.
      if (!point.is_good() && !line.empty()) {
        const ImVec2 last = line.back();
        finish();
        line.push_back(last);
      } else {
        line.push_back(at);
        finish();
      }
      is_good_part = point.is_good();
    }
    line.push_back(at);
  }
  finish();
}

/// Samples and names, as many beside each other as fit.
class Legend {
 public:
  /// Returns true where the entry was clicked.
  bool add(const char* id, const CurveStyle& style, const std::string& name, ImU32 colour = kTextColour) {
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 at = take(id, name);
    draw_line(ImGui::GetWindowDrawList(), {{at.x, at.y + 0.5F * line}, {at.x + 2.0F * line, at.y + 0.5F * line}}, style,
              kCurveWidth);
    draw_text(ImGui::GetWindowDrawList(), {at.x + 2.3F * line, at.y}, {0.0F, 0.0F}, colour, name);
    return ImGui::IsItemClicked();
  }
  void add_band(ImU32 colour, const std::string& name) {
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 at = take("band", name);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.1F * line}, {at.x + 2.0F * line, at.y + 0.9F * line},
                                              colour);
    draw_text(ImGui::GetWindowDrawList(), {at.x + 2.3F * line, at.y}, {0.0F, 0.0F}, kTextColour, name);
  }

 private:
  ImVec2 take(const char* id, const std::string& name) {
    const float line = ImGui::GetTextLineHeight();
    const float width = 2.3F * line + ImGui::CalcTextSize(shown(name).c_str()).x;
    if (!is_empty_) ImGui::SameLine(0.0F, 1.2F * line);
    if (!is_empty_ && ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    is_empty_ = false;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(id, {width, line});
    return at;
  }

  bool is_empty_ = true;
};

void draw_legend(const std::vector<Shown>& curves, Session& session) {
  Legend legend;
  const auto colour_of = [&](const Curve& curve) { return session.is_outdated(curve) ? kDimColour : kTextColour; };
  legend.add("curve", curves.back().style, curves.back().name, colour_of(session.curve()));
  if (session.overlay() &&
      legend.add("overlay", overlay_style(), session.overlay_name(), colour_of(*session.overlay()))) {
    View view = session.view();
    view.has_overlay = false;
    session.set_view(view);
  }
  for (std::size_t i = 0; i < session.pins().size(); ++i) {
    const Pin& pin = session.pins()[i];
    const std::string name = "pinned: " + pin_name(pin, session);
    const ImU32 colour = pin.is_visible ? colour_of(pin.curve) : kDimColour;
    ImGui::PushID(static_cast<int>(i));
    if (legend.add("pin", pin.is_visible ? pin_style(pin.colour) : stale(pin_style(pin.colour)), name, colour))
      session.show_pin(i, !pin.is_visible);
    ImGui::PopID();
  }
  const std::vector<Point>& points = session.curve().points();
  const bool is_dolp = session.view().quantity == Plotted::kDolp;
  if (is_dolp && std::ranges::any_of(points, [](const Point& point) { return point.has_bracket(); }))
    legend.add_band(band_colour(curves.back().style), "all bounces lie between");
  if (std::ranges::any_of(points, [](const Point& point) { return !point.is_good(); }))
    legend.add("bad", {kBadColour, 4.0F, 4.0F}, "the model fails here (status)");
}

void draw_cursor(const Plot& plot, const Session& session, const CurveStyle& style) {
  if (!plot.has_place(session.theta_deg(), 1.0)) return;
  const float x = plot.at_position(plot.x().position(session.theta_deg()), 0.0).x;
  plot.list()->AddLine({x, plot.min().y}, {x, plot.max().y}, kCursorColour, scaled(1.0F));
  const Point* const shown = session.at_cursor();
  if (!shown) return;
  const Plotted quantity = session.view().quantity;
  const double value = shown_value(quantity, *shown);
  if (!plot.has_place(shown->theta_deg, value)) return;
  const ImVec2 at = plot.at(shown->theta_deg, value);
  plot.list()->AddCircleFilled(at, scaled(4.0F), style.colour);
  plot.list()->AddCircle(at, scaled(4.5F), kTextColour, 0, scaled(1.0F));
}

void draw_peak(const Plot& plot, const Session& session) {
  const PeakAnswer* const peak = shown_peak(session);
  if (!peak) return;
  const double value = shown_value(session.view().quantity, peak->at);
  if (!plot.has_place(peak->at.theta_deg, value)) return;
  const bool is_low = value < 0.0;
  const ImVec2 at = plot.at(peak->at.theta_deg, value);
  if (at.x < plot.min().x || at.x > plot.max().x || at.y < plot.min().y || at.y > plot.max().y) return;
  const float side = is_low ? 1.0F : -1.0F;
  plot.list()->AddTriangleFilled({at.x, at.y + side * scaled(3.0F)}, {at.x - scaled(5.0F), at.y + side * scaled(12.0F)},
                                 {at.x + scaled(5.0F), at.y + side * scaled(12.0F)}, kTextColour);
  // Beside the mark towards the middle, so that it stays inside.
  const bool is_right = at.x > 0.5F * (plot.min().x + plot.max().x);
  const float line = ImGui::GetTextLineHeight();
  const float beside = std::max(std::min(at.y + side * scaled(8.0F), plot.max().y - line), plot.min().y + line);
  draw_label(plot.list(), {at.x + scaled(is_right ? -9.0F : 9.0F), beside}, {is_right ? 1.0F : 0.0F, 0.5F}, kTextColour,
             fmt::format("{:.2f} % at {:.2f}°", value, peak->at.theta_deg));
}

void draw_error_bar(const Plot& plot, double theta_deg, double low, double high) {
  const float cap = scaled(3.0F);
  const ImVec2 bottom = plot.at(theta_deg, low);
  const ImVec2 top = plot.at(theta_deg, high);
  plot.list()->AddLine(bottom, top, kTextColour, scaled(1.0F));
  for (const ImVec2 end : {bottom, top})
    plot.list()->AddLine({end.x - cap, end.y}, {end.x + cap, end.y}, kTextColour, scaled(1.0F));
}

void draw_measured(const Plot& plot, const std::vector<Measurement>& points) {
  for (const Measurement& point : points) {
    const double scale = scale_of(plotted(point.observable));
    const double value = scale * point.value;
    if (!plot.has_place(point.theta_deg, value)) continue;
    plot.list()->AddCircle(plot.at(point.theta_deg, value), scaled(4.0F), kTextColour, 0, scaled(1.5F));
    if (!point.uncertainty) continue;
    const double deviation = scale * *point.uncertainty;
    const double low = plot.y().is_log ? std::max(value - deviation, plot.y().from) : value - deviation;
    draw_error_bar(plot, point.theta_deg, low, value + deviation);
  }
}

void draw_residuals(const Session& session, const Scale& theta, ImVec2 size) {
  const Plotted quantity = session.view().quantity;
  const double scale = scale_of(quantity);
  const std::vector<double> residuals = session.residuals().residuals();
  struct Residual {
    double theta_deg, value, deviation;
  };
  std::vector<Residual> shown;
  double largest = 1e-6;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Measurement& point = session.residuals().data()->measurements[i];
    if (plotted(point.observable) != quantity || !std::isfinite(residuals[i])) continue;
    shown.push_back({point.theta_deg, scale * residuals[i], scale * point.uncertainty.value_or(0.0)});
    largest = std::max(largest, std::abs(shown.back().value) + shown.back().deviation);
  }
  const std::string unit = described(quantity).in_percent ? " [points]" : "";
  const std::optional<double> rms = session.residuals().rms(quantity);
  const std::string label =
      rms ? fmt::format("measured − model{}; root mean square {:.3g}", unit, scale * *rms) : "measured − model" + unit;
  const Plot plot("residuals", size, {"", theta}, {label, {-1.2 * largest, 1.2 * largest}});
  plot.clip();
  plot.list()->AddLine(plot.at(theta.from, 0.0), plot.at(theta.to, 0.0), kDimColour);
  for (const Residual& one : shown) {
    if (!plot.has_place(one.theta_deg, 1.0)) continue;
    if (one.deviation > 0.0) draw_error_bar(plot, one.theta_deg, one.value - one.deviation, one.value + one.deviation);
    plot.list()->AddCircleFilled(plot.at(one.theta_deg, one.value), scaled(3.0F), kTextColour);
  }
  plot.unclip();
}

}  // namespace

void CurveView::edit_axes(View& view, const Plot& plot, const std::string& values) {
  const auto check_zeniths = [&](const Scale& range) {
    const Scale all = Scale{0.0, view.theta_max_deg}.with_log(range.is_log);
    const bool is_inside = range.from >= all.from && range.to <= all.to;
    return is_inside ? "" : fmt::format("must be numbers in [{:g}, {:g}]; \"θ up to\" sets the end", all.from, all.to);
  };
  if (const auto change = axis_editor_.draw("zenith θ [°]", plot.x_numbers(), x_, check_zeniths)) {
    view.curve_zoom.x = change->range;
    view.is_theta_log = change->is_log;
  }
  const auto take_all = [](const Scale&) { return std::string(); };
  if (const auto change = axis_editor_.draw(values, plot.y_numbers(), y_, take_all)) {
    view.curve_zoom.y = change->range;
    view.is_log = change->is_log;
  }
}

void CurveView::draw(Session& session, ImVec2 size) {
  const std::vector<Shown> curves = shown_curves(session);
  const Plotted quantity = session.view().quantity;
  const float line = ImGui::GetTextLineHeight();
  // Of a fixed height, so that the plot stays where it is; more entries are scrolled to. In a drag names are longer for
  // a moment.
  const float lines = size.y > kRoomForTwo * line ? 2.0F : 1.0F;
  const float legend_height = lines * ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginChild("legend", {size.x, legend_height}, false,
                    session.is_dragged() ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None);
  draw_legend(curves, session);
  ImGui::EndChild();
  size.y -= legend_height + ImGui::GetStyle().ItemSpacing.y;
  const std::vector<Measurement> measured = session.residuals().measured(quantity);
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  const bool has_residuals = !measured.empty() && size.y > kRoomForResiduals * line;
  const float residual_height = has_residuals ? std::max(0.28F * size.y, kLeastResiduals * line) : 0.0F;

  const Scale zeniths = Scale{0.0, session.view().theta_max_deg}.with_log(session.view().is_theta_log);
  PlotAxis values = value_axis(session, curves);
  View view = session.view();
  Zoom& zoom = view.curve_zoom;
  const bool has_zeniths = zoom.x && zoom.x->is_log == zeniths.is_log;
  if (has_zeniths) zoom.x = zoom.x->within(zeniths);
  // Before there is a curve its values have no logarithm, but the range of them stays.
  if (zoom.y && zoom.y->is_log == values.scale.is_log) {
    values.scale = *zoom.y;
  } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && quantity_ == quantity && y_.is_log == values.scale.is_log) {
    // While a slider is dragged the axis grows at most, so that the curve is what moves.
    values.scale = {std::min(y_.from, values.scale.from), std::max(y_.to, values.scale.to), y_.is_log};
  }
  quantity_ = quantity;
  x_ = has_zeniths ? *zoom.x : zeniths;
  y_ = values.scale;
  const Plot plot("curve", {size.x, size.y - residual_height - (has_residuals ? gap : 0.0F)},
                  {is_bistatic(session.scene()) ? "zenith θ of the source [°]" : "zenith θ [°]", x_}, values);
  if (plot.is_dragged()) session.set_theta(plot.x().value(plot.mouse_x()));
  plot.follow_mouse(zoom, zeniths);
  plot.clip();
  if (!plot.y().is_log) plot.list()->AddLine(plot.at(x_.from, 0.0), plot.at(x_.to, 0.0), kDimColour);
  if (quantity == Plotted::kDolp) draw_bracket(plot, curves.back());
  for (const Shown& shown : curves) draw_curve(plot, shown, quantity);
  draw_measured(plot, measured);
  draw_cursor(plot, session, curves.back().style);
  if (plot.is_hovered() && !plot.is_dragged()) {
    draw_label(plot.list(), plot.area().at(0.99F, 0.98F), {1.0F, 1.0F}, kDimColour,
               fmt::format("{:.2f}°, {:.4g}", x_.value(plot.mouse_x()), y_.value(plot.mouse_y())));
  }
  plot.unclip();
  draw_peak(plot, session);  // the mark at an end of the axis is as large as elsewhere
  area_ = plot.area();
  edit_axes(view, plot, values.label);
  const View& before = session.view();
  if (view.curve_zoom != before.curve_zoom || view.is_log != before.is_log || view.is_theta_log != before.is_theta_log)
    session.set_view(view);
  if (has_residuals) draw_residuals(session, x_, {size.x, residual_height});
}

}  // namespace dolp::explore
