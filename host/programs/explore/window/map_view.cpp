#include "explore/window/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

constexpr double kMostContrast = 1e3;  // an automatic logarithmic colour scale spans at most this factor
constexpr std::size_t kMostLines = 7;
constexpr ImU32 kLightLine = IM_COL32(255, 255, 255, 190);  // lines on the colours of viridis()
constexpr ImU32 kDarkLine = IM_COL32(0, 0, 0, 170);         // lines on the colours of diverging()
constexpr float kBarRoom = 5.4F;                            // space right of the map, in lines of text

Scale times(const Scale& range, double factor) { return {factor * range.from, factor * range.to, range.is_log}; }

std::string map_title(const Session& session) {
  const HeatMap& map = session.map();
  const bool is_outdated = map.is_stale() && !session.is_dragged();
  const std::string state = map.is_finished()      ? ""
                            : session.is_dragged() ? ", coarse"
                                                   : fmt::format(", refining {:.0f} %", 100.0 * map.progress());
  return fmt::format("{}; {} × {}{}{}", described(session.view().quantity).label(), map.finished_count(),
                     map.finished_count(), stale_text(is_outdated), state);
}

void draw_map_cursor(const Session& session, const Plot& plot) {
  const HeatMap& map = session.map();
  const ImVec2 at = plot.at_position(session.map_cursor(map.x()), session.map_cursor(map.y()));
  const ImU32 colour = described(session.view().quantity).is_signed ? kDarkLine : kLightLine;
  plot.list()->AddLine({at.x, plot.min().y}, {at.x, plot.max().y}, colour, scaled(1.0F));
  plot.list()->AddLine({plot.min().x, at.y}, {plot.max().x, at.y}, colour, scaled(1.0F));
  plot.list()->AddCircle(at, scaled(5.0F), colour, 0, scaled(2.0F));
}

}  // namespace

void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change) {
  View view = session.view();
  const bool is_automatic = !change.range && change.is_log == axis.scale.is_log;
  view.set_range(axis.label, is_automatic ? std::nullopt
                                          : std::optional(change.range.value_or(axis.scale.with_log(change.is_log))));
  session.set_view(view);
}

double MapView::colour_position(double value) const {
  if (!(colour_scale_.from < colour_scale_.to)) return 0.0;
  if (colour_scale_.is_log && !(value > colour_scale_.from)) return 0.0;
  return colour_scale_.position(value);
}

Scale MapView::colour_range() const {
  if (quantity().is_signed) {
    const double largest = std::max(std::abs(field_.min), std::abs(field_.max));
    return {-largest, largest};
  }
  const double low = is_log_ && field_.max > 0.0 ? std::max(field_.min, field_.max / kMostContrast) : field_.min;
  return {low, field_.max, is_log_ && low > 0.0};
}

ImU32 MapView::colour(double position) const { return quantity().is_signed ? diverging(position) : viridis(position); }

void MapView::update(const Session& session) {
  const Plotted quantity = session.view().quantity;
  const bool is_log = session.view().is_log;
  const bool is_same =
      field_.quantity == quantity && is_log_ == is_log && typed_colours_ == session.view().range(View::kColours);
  if (version_ == session.map().version() && is_same) return;
  version_ = session.map().version();
  is_log_ = is_log;
  typed_colours_ = session.view().range(View::kColours);
  field_ = session.map().field(quantity);
  // While the user drags a slider, the colour scale stays, so that equal values keep their colours.
  const bool is_held = session.is_dragged() && is_same && colour_scale_.from < colour_scale_.to;
  if (!is_held) colour_scale_ = typed_colours_.value_or(colour_range());
  std::vector<ImU32> colours;
  for (const double value : field_.values)
    colours.push_back(std::isnan(value) ? kBadColour : colour(colour_position(value)));
  cells_.set(colours, field_.count);
  contours_.clear();
  if (field_.min >= field_.max || colour_scale_.from >= colour_scale_.to) return;
  for (const double level : colour_scale_.ticks(kMostLines)) contours_.push_back({level, contour(field_, level)});
}

void MapView::draw_contours(const Plot& plot) const {
  const ImU32 line_colour = quantity().is_signed ? kDarkLine : kLightLine;
  for (const Contour& contour : contours_) {
    for (const Segment& s : contour.segments) {
      plot.list()->AddLine(plot.at_position(s.x0, s.y0), plot.at_position(s.x1, s.y1), line_colour, scaled(1.0F));
    }
  }
  std::vector<ImVec2> labels;
  for (const Contour& contour : contours_) {
    if (contour.segments.empty()) continue;
    // The label of a contour line is on the segment that is farthest from the edges of the map.
    const auto room = [](const Segment& s) { return std::min({s.x0, 1.0 - s.x0, s.y0, 1.0 - s.y0}); };
    const Segment& inner = *std::ranges::max_element(contour.segments, {}, room);
    const ImVec2 at = plot.at_position(inner.x0, inner.y0);
    const float apart = 1.5F * ImGui::GetTextLineHeight();
    const auto is_near = [&](ImVec2 other) { return std::hypot(at.x - other.x, at.y - other.y) < apart; };
    if (std::ranges::any_of(labels, is_near)) continue;
    labels.push_back(at);
    draw_label(plot.list(), at, {0.5F, 0.5F}, kTextColour, tick_text(quantity().scale() * contour.level));
  }
}

void MapView::draw_bar(const Plot& plot) const {
  if (!(field_.min <= field_.max)) return;
  const float line = ImGui::GetTextLineHeight(), left = plot.max().x + 0.9F * line;
  const Area bar{{left, plot.min().y}, {left + 0.9F * line, plot.max().y}};
  draw_colours(plot.list(), bar, true, [this](double position) { return colour(position); });
  plot.list()->AddRect(bar.min, bar.max, kDimColour);
  if (!(colour_scale_.from < colour_scale_.to)) return;
  const double scale = quantity().scale();
  const auto most = static_cast<std::size_t>(std::max(2.0F, bar.height() / (2.2F * line)));
  for (const double tick : times(colour_scale_, scale).ticks(most)) {
    const float y = bar.at(0.0F, 1.0F - static_cast<float>(colour_position(tick / scale))).y;
    plot.list()->AddLine({bar.max.x, y}, {bar.max.x + 0.25F * line, y}, kDimColour);
    draw_text(plot.list(), {bar.max.x + 0.4F * line, y}, {0.0F, 0.5F}, kDimColour, tick_text(tick));
  }
}

void MapView::edit_axes(Session& session, AxisEditor& editor, const Plot& plot) {
  for (const auto& [axis, numbers] :
       {std::pair{session.map().x(), plot.x_numbers()}, {session.map().y(), plot.y_numbers()}}) {
    const auto check = [&](const Scale& range) { return refusal(session.scene(), axis, range); };
    const auto change = editor.draw(axis.label, numbers, axis.scale, check);
    if (change) set_range(session, axis, *change);
  }
  const float line = ImGui::GetTextLineHeight();
  const Area numbers{{plot.max().x + 0.5F * line, plot.min().y}, {plot.max().x + kBarRoom * line, plot.max().y}};
  auto change = editor.draw("colours: " + quantity().label(), numbers, times(colour_scale_, quantity().scale()));
  if (!change) return;
  View view = session.view();
  if (change->range) change->range = times(*change->range, 1.0 / quantity().scale());
  view.set_range(View::kColours, change->range);
  if (!quantity().is_signed) view.is_log = change->is_log;
  session.set_view(view);
}

void MapView::draw(Session& session, AxisEditor& editor, ImVec2 size) {
  update(session);
  const HeatMap& map = session.map();
  const float line = ImGui::GetTextLineHeight();
  const Plot plot("map", size, {map.x().label, map.x().scale}, {map.y().label, map.y().scale}, kBarRoom * line, false);
  if (plot.is_dragged()) session.set_map_cursor(plot.mouse_x(), plot.mouse_y());
  draw_text(plot.list(), {plot.max().x, plot.min().y - 0.6F * line}, {1.0F, 1.0F}, kTextColour, map_title(session));
  plot.clip();
  cells_.draw(plot.list(), plot.min(), plot.max());
  draw_contours(plot);
  if (map.is_stale() && !session.is_dragged()) plot.list()->AddRectFilled(plot.min(), plot.max(), kStaleVeil);
  draw_map_cursor(session, plot);
  plot.unclip();
  draw_bar(plot);
  edit_axes(session, editor, plot);
}

}  // namespace dolp::explore
