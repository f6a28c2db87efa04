#include "explore/window/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

constexpr float kCurveWidth = 2.0F;
constexpr float kRoomForTwo = 18.0F;    // height in lines of text; in a taller view, the legend has at least two lines
constexpr float kMostOfLegend = 0.75F;  // share of the height in which the names of five curves have room
constexpr float kRoomForResiduals = 17.0F;  // height in lines of text; a taller view also has a plot of residuals
constexpr float kLeastResiduals = 7.0F;     // least height of the plot of residuals, in lines of text

bool is_dim(const Session& session, const Curve& curve) {  // the curve is old, or belongs to another scene file
  return session.is_outdated(curve) || session.is_foreign(curve.scene());
}

CurveStyle bad_style() { return {kBadColour, 4.0F, 4.0F}; }  // for the parts of a curve in which the model fails

std::vector<ShownCurve> shown_curves(const Session& session) {
  std::vector<ShownCurve> curves;
  const auto add = [&](const Curve& curve, const CurveStyle& style) {
    curves.push_back({&curve, is_dim(session, curve) ? stale(style) : style});
  };
  if (session.overlay()) add(*session.overlay(), overlay_style());
  for (const Pin& pin : session.pins()) {
    if (pin.is_visible) add(pin.curve, pin_style(pin.colour));
  }
  add(session.curve(), current_style());  // the last curve is drawn on top of the others
  return curves;
}

std::vector<double> values_to_show(const Session& session, const std::vector<ShownCurve>& curves) {
  const Plotted quantity = session.view().quantity;
  std::vector<double> values;
  for (const ShownCurve& shown : curves) {
    for (const Point& point : shown.curve->drawn()) {
      if (point.theta_deg > session.view().theta_max_deg) break;
      if (!point.is_good()) continue;
      values.push_back(described(quantity).shown(point));
      if (shown.curve != &session.curve() || quantity != Plotted::kDolp) continue;
      for (const Quantity limit : {Quantity::kDolpLow, Quantity::kDolpHigh})
        values.push_back(described(quantity).scale() * point[limit]);
    }
  }
  for (const Measurement& point : session.residuals().measured(quantity))
    values.push_back(described(quantity).scale() * point.value);
  return values;
}

/// Fills the area between dolp_low and dolp_high. Only the current curve gets it: overlapping areas are unreadable.
void draw_bracket(const Plot& plot, const ShownCurve& shown) {
  const std::vector<Point> points = shown.curve->drawn();
  const ImU32 colour = band_colour(shown.style);
  const auto at = [&](const Point& point, Quantity limit) {
    return plot.at(point.theta_deg, std::max(described(Plotted::kDolp).scale() * point[limit], plot.y().from));
  };
  // Turns off anti-aliasing, which would show the edges between the quadrilaterals.
  const ImDrawListFlags flags = std::exchange(plot.list()->Flags, ImDrawListFlags_None);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point& a = points[i];
    const Point& b = points[i + 1];
    if (!plot.can_show(a.theta_deg, 1.0) || !a.is_good() || !b.is_good() || !a.has_bracket() || !b.has_bracket())
      continue;
    plot.list()->AddQuadFilled(at(a, Quantity::kDolpLow), at(a, Quantity::kDolpHigh), at(b, Quantity::kDolpHigh),
                               at(b, Quantity::kDolpLow), colour);
  }
  plot.list()->Flags = flags;
}

/// Draws the curve in its style. On both sides of a point at which the model fails, the line is thin, grey and dashed.
void draw_curve(const Plot& plot, const ShownCurve& shown, Plotted quantity) {
  const std::vector<Point> points = shown.curve->drawn();
  std::vector<ImVec2> good, bad;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double value = described(quantity).shown(points[i]);
    const bool can_show = plot.can_show(points[i].theta_deg, value);
    const bool is_beside_bad = !points[i].is_good() || (i > 0 && !points[i - 1].is_good()) ||
                               (i + 1 < points.size() && !points[i + 1].is_good());
    if (i > 0 && described(quantity).jumps(described(quantity).shown(points[i - 1]), value)) good.push_back(kGap);
    const ImVec2 at = can_show ? plot.at(points[i].theta_deg, value) : kGap;
    good.push_back(points[i].is_good() ? at : kGap);
    bad.push_back(is_beside_bad ? at : kGap);
  }
  draw_line(plot.list(), bad, bad_style(), 1.0F);
  draw_line(plot.list(), good, shown.style, kCurveWidth);
}

/// Adds a name to the legend, in a new line if needed. A name wider than the legend is broken at its spaces. Returns
/// the area left of the name, for a sample of the curve.
Area add_entry(const char* id, const std::string& name, ImU32 colour = kTextColour) {
  const float line = ImGui::GetTextLineHeight();
  const float room = ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorStartPos().x;
  const std::string text = in_lines(shown(name), room - 2.3F * line);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float width = 2.3F * line + size.x;
  if (ImGui::GetCursorPosX() > ImGui::GetCursorStartPos().x && ImGui::GetContentRegionAvail().x < width)
    ImGui::NewLine();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, {width, size.y});
  name_item(std::string("legend ") + id);
  draw_text(ImGui::GetWindowDrawList(), {at.x + 2.3F * line, at.y}, {0.0F, 0.0F}, colour, text);
  ImGui::SameLine(0.0F, 1.2F * line);
  return {at, {at.x + 2.0F * line, at.y + line}};
}

bool add_curve(const char* id, const std::string& name, const CurveStyle& style, ImU32 colour = kTextColour) {
  const Area sample = add_entry(id, name, colour);
  const bool is_clicked = ImGui::IsItemClicked();
  draw_line(ImGui::GetWindowDrawList(), {sample.at(0.0F, 0.5F), sample.at(1.0F, 0.5F)}, style, kCurveWidth);
  return is_clicked;
}

void draw_legend(const std::vector<ShownCurve>& curves, Session& session) {
  const auto curve_colour = [&](const Curve& curve) { return is_dim(session, curve) ? kDimColour : kTextColour; };
  add_curve("curve", curve_name(session), curves.back().style, curve_colour(session.curve()));
  if (session.overlay() &&
      add_curve("overlay", overlay_name(session), overlay_style(), curve_colour(*session.overlay())))
    session.set_view(&View::has_overlay, false);
  for (Pin& pin : session.pins()) {
    const CurveStyle style = pin_style(pin.colour);
    ImGui::PushID(&pin);
    if (add_curve("pin", "pinned: " + pin_name(session, pin), pin.is_visible ? style : stale(style),
                  pin.is_visible ? curve_colour(pin.curve) : kDimColour))
      pin.is_visible = !pin.is_visible;
    ImGui::PopID();
  }
  const std::vector<Point>& points = session.curve().points();
  const bool is_dolp = session.view().quantity == Plotted::kDolp;
  if (is_dolp && std::ranges::any_of(points, [](const Point& point) { return point.has_bracket(); })) {
    const Area sample = add_entry("band", "all bounces lie between");
    ImGui::GetWindowDrawList()->AddRectFilled(sample.at(0.0F, 0.1F), sample.at(1.0F, 0.9F),
                                              band_colour(curves.back().style));
  }
  if (std::ranges::any_of(points, [](const Point& point) { return !point.is_good(); }))
    add_curve("bad", "the model fails here (status)", bad_style());
  if (session.residuals().data() && session.is_foreign(session.residuals().loaded_for()))
    add_entry("measured", "o  points measured for another scene", kDimColour);
}

void draw_cursor(const Plot& plot, const Session& session, const CurveStyle& style) {
  if (!plot.can_show(session.theta_deg(), 1.0)) return;
  plot.draw_cursor(session.theta_deg());
  const Point* const shown = session.at_cursor();
  if (!shown) return;
  const Plotted quantity = session.view().quantity;
  const double value = described(quantity).shown(*shown);
  if (!plot.can_show(shown->theta_deg, value)) return;
  const ImVec2 at = plot.at(shown->theta_deg, value);
  plot.list()->AddCircleFilled(at, scaled(4.0F), style.colour);
  plot.list()->AddCircle(at, scaled(4.5F), kTextColour, 0, scaled(1.0F));
}

void draw_peak(const Plot& plot, const Session& session) {
  const Plotted quantity = session.view().quantity;
  const bool is_marked = quantity == Plotted::kDolp || quantity == Plotted::kSignedDolp;
  const std::optional<PeakAnswer>& peak = session.peak().answer();
  if (!is_marked || !peak || !session.curve().is_finished()) return;
  const double value = described(quantity).shown(peak->at);
  if (!plot.can_show(peak->at.theta_deg, value)) return;
  const bool is_low = value < 0.0;
  const ImVec2 at = plot.at(peak->at.theta_deg, value);
  if (at.x < plot.min().x || at.x > plot.max().x || at.y < plot.min().y || at.y > plot.max().y) return;
  const float side = is_low ? 1.0F : -1.0F;
  plot.list()->AddTriangleFilled({at.x, at.y + side * scaled(3.0F)}, {at.x - scaled(5.0F), at.y + side * scaled(12.0F)},
                                 {at.x + scaled(5.0F), at.y + side * scaled(12.0F)}, kTextColour);
  // The label is on the side of the mark towards the middle of the plot, so that it stays inside the plot.
  const bool is_right = at.x > 0.5F * (plot.min().x + plot.max().x);
  const float line = ImGui::GetTextLineHeight();
  const float beside = std::max(std::min(at.y + side * scaled(8.0F), plot.max().y - line), plot.min().y + line);
  draw_label(plot.list(), {at.x + scaled(is_right ? -9.0F : 9.0F), beside}, {is_right ? 1.0F : 0.0F, 0.5F}, kTextColour,
             fmt::format("{:.2f} % at {:.2f}°", value, peak->at.theta_deg));
}

void draw_points(const Plot& plot, const std::vector<Measurement>& points, double scale, bool is_filled, ImU32 colour) {
  const auto line = [&](ImVec2 from, ImVec2 to) { plot.list()->AddLine(from, to, colour, scaled(1.0F)); };
  const float cap = scaled(3.0F);
  for (const Measurement& point : points) {
    const double value = scale * point.value;
    if (!plot.can_show(point.theta_deg, value)) continue;
    if (const double deviation = scale * point.uncertainty.value_or(0.0); deviation > 0.0) {
      const double low = plot.y().is_log ? std::max(value - deviation, plot.y().from) : value - deviation;
      const ImVec2 ends[] = {plot.at(point.theta_deg, low), plot.at(point.theta_deg, value + deviation)};
      line(ends[0], ends[1]);
      for (const ImVec2 end : ends) line({end.x - cap, end.y}, {end.x + cap, end.y});
    }
    const ImVec2 at = plot.at(point.theta_deg, value);
    if (is_filled) {
      plot.list()->AddCircleFilled(at, scaled(3.0F), colour);
    } else {
      plot.list()->AddCircle(at, scaled(4.0F), colour, 0, scaled(1.5F));
    }
  }
}

ImU32 colour_of_points(const Session& session) {  // grey if the points were loaded for another scene
  return session.is_foreign(session.residuals().loaded_for()) ? kDimColour : kTextColour;
}

void draw_residuals(const Session& session, const Scale& theta, ImVec2 size) {
  const PlottedDescription& quantity = described(session.view().quantity);
  const std::vector<Measurement> residuals = session.residuals().residuals(quantity.quantity);
  double largest = residuals.empty() ? 1.0 : 1e-6;
  for (const Measurement& point : residuals)
    largest = std::max(largest, quantity.scale() * (std::abs(point.value) + point.uncertainty.value_or(0.0)));
  std::string label = std::string("measured − model") + (quantity.is_percent() ? " [points]" : "");
  if (const auto rms = residual_rms(residuals))
    label += fmt::format("; root mean square {:.3g}", quantity.scale() * *rms);
  const Plot plot("residuals", size, {"", theta}, {label, {-1.2 * largest, 1.2 * largest}});
  plot.clip();
  plot.list()->AddLine(plot.at(theta.from, 0.0), plot.at(theta.to, 0.0), kDimColour);
  draw_points(plot, residuals, quantity.scale(), true, colour_of_points(session));
  plot.unclip();
  const std::string reason = no_residuals_text(session, theta);
  if (!reason.empty()) draw_label(plot.list(), plot.area().at(0.5F, 0.3F), {0.5F, 0.5F}, kDimColour, reason);
}

}  // namespace

/// Draws the legend and returns its height. While the mouse is down, the height only grows, so that the plot below
/// stays.
float CurveView::draw_legend_above(const std::vector<ShownCurve>& curves, Session& session, ImVec2 size) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float least = (size.y > kRoomForTwo * ImGui::GetTextLineHeight() ? 2.0F : 1.0F) * line;
  const float height = std::min(std::max(legend_height_, least), kMostOfLegend * size.y);
  const bool scrolls = legend_height_ > height && !session.is_dragged();
  ImGui::BeginChild(
      "legend", {size.x, height}, false,
      scrolls ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float top = ImGui::GetCursorPosY();
  draw_legend(curves, session);
  ImGui::NewLine();
  const float needed = ImGui::GetCursorPosY() - top;
  const bool may_shrink = !ImGui::IsMouseDown(ImGuiMouseButton_Left);
  legend_height_ = may_shrink ? needed : std::max(legend_height_, needed);
  ImGui::EndChild();
  return height + ImGui::GetStyle().ItemSpacing.y;
}

void CurveView::edit_axes(View& view, AxisEditor& editor, const Plot& plot, const std::string& values) {
  const auto check_zeniths = [&](const Scale& range) {
    const Scale all = Scale{0.0, view.theta_max_deg}.with_log(range.is_log);
    const bool is_inside = range.from >= all.from && range.to <= all.to;
    return is_inside ? "" : fmt::format("must be numbers in [{:g}, {:g}]; \"θ up to\" sets the end", all.from, all.to);
  };
  if (const auto change = editor.draw("zenith θ [°]", plot.x_numbers(), x_, check_zeniths)) {
    view.set_range(View::kZeniths, change->range);
    view.is_theta_log = change->is_log;
  }
  if (const auto change = editor.draw(values, plot.y_numbers(), y_)) {
    view.set_range(View::kValues, change->range);
    view.is_log = change->is_log;
  }
}

void CurveView::choose_axes(const Session& session, Zoom& zoom, const Scale& zeniths, Scale& values) {
  // A range that the user chose for a linear axis does not hold for a logarithmic axis, and vice versa.
  const bool has_zeniths = zoom.x && zoom.x->is_log == zeniths.is_log;
  if (has_zeniths) zoom.x = zoom.x->within(zeniths);
  x_ = has_zeniths ? *zoom.x : zeniths;
  const bool is_same = quantity_ == session.view().quantity && y_.is_log == values.is_log;
  if (zoom.y && zoom.y->is_log == values.is_log) {
    values = *zoom.y;
  } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && is_same) {
    // While the user drags a slider, the axis only grows, so that the curve moves and not the axis.
    values = {std::min(y_.from, values.from), std::max(y_.to, values.to), y_.is_log};
  }
  quantity_ = session.view().quantity;
  y_ = values;
}

void CurveView::draw(Session& session, AxisEditor& editor, ImVec2 size) {
  const std::vector<ShownCurve> curves = shown_curves(session);
  size.y -= draw_legend_above(curves, session, size);
  const Plotted quantity = session.view().quantity;
  const std::vector<Measurement> measured = session.residuals().measured(quantity);
  const float line = ImGui::GetTextLineHeight();
  const bool has_residuals = session.residuals().data() && size.y > kRoomForResiduals * line;
  const float residual_height = has_residuals ? std::max(0.28F * size.y, kLeastResiduals * line) : 0.0F;
  const float gap = has_residuals ? ImGui::GetStyle().ItemSpacing.y : 0.0F;

  View view = session.view();
  const Scale zeniths = Scale{0.0, view.theta_max_deg}.with_log(view.is_theta_log);
  PlotAxis values{described(quantity).label(), value_scale(values_to_show(session, curves), view.is_log)};
  Zoom zoom{view.range(View::kZeniths), view.range(View::kValues)};
  choose_axes(session, zoom, zeniths, values.scale);
  const Plot plot("curve", {size.x, size.y - residual_height - gap}, {zenith_label(session.scene()), x_}, values);
  if (plot.is_dragged()) session.set_theta(plot.x().value(plot.mouse_x()));
  plot.follow_mouse(zoom, zeniths);
  view.set_range(View::kZeniths, zoom.x);
  view.set_range(View::kValues, zoom.y);
  plot.clip();
  if (!plot.y().is_log) plot.list()->AddLine(plot.at(x_.from, 0.0), plot.at(x_.to, 0.0), kDimColour);
  if (quantity == Plotted::kDolp) draw_bracket(plot, curves.back());
  for (const ShownCurve& shown : curves) draw_curve(plot, shown, quantity);
  draw_points(plot, measured, described(quantity).scale(), false, colour_of_points(session));
  draw_cursor(plot, session, curves.back().style);
  if (plot.is_hovered() && !plot.is_dragged()) {
    draw_label(plot.list(), plot.area().at(0.99F, 0.98F), {1.0F, 1.0F}, kDimColour,
               fmt::format("{:.2f}°, {:.4g}", x_.value(plot.mouse_x()), y_.value(plot.mouse_y())));
  }
  plot.unclip();
  draw_peak(plot, session);  // after unclip(), so that the mark is complete even at an end of the axis
  edit_axes(view, editor, plot, values.label);
  if (view != session.view()) session.set_view(view);
  if (has_residuals) draw_residuals(session, x_, {size.x, residual_height});
}

}  // namespace dolp::explore
