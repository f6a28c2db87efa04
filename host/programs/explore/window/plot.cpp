#include "explore/window/plot.hpp"

#include <algorithm>
#include <cmath>

#include "explore/ticks.hpp"
#include "explore/window/text.hpp"

namespace dolp::explore {
namespace {

std::vector<double> ticks_of(const PlotAxis& axis, float pixels, float spacing) {
  const auto most = static_cast<std::size_t>(std::max(2.0F, pixels / spacing));
  return axis.is_log ? log_ticks(axis.from, axis.to, most) : linear_ticks(axis.from, axis.to, most);
}

}  // namespace

double PlotAxis::position(double value) const {
  if (is_log) return std::log(value / from) / std::log(to / from);
  return (value - from) / (to - from);
}

double PlotAxis::value(double position) const {
  return is_log ? from * std::pow(to / from, position) : from + position * (to - from);
}

void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text) {
  const std::string visible = shown(text);
  const ImVec2 size = ImGui::CalcTextSize(visible.c_str());
  list->AddText({std::round(at.x - anchor.x * size.x), std::round(at.y - anchor.y * size.y)}, colour, visible.c_str());
}

void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text) {
  constexpr float kPadding = 3.0F;
  constexpr ImU32 kGround = IM_COL32(20, 21, 24, 215);
  const ImVec2 size = ImGui::CalcTextSize(shown(text).c_str());
  const ImVec2 corner{at.x - anchor.x * size.x, at.y - anchor.y * size.y};
  list->AddRectFilled({corner.x - kPadding, corner.y - 1.0F}, {corner.x + size.x + kPadding, corner.y + size.y + 1.0F},
                      kGround, kPadding);
  draw_text(list, at, anchor, colour, text);
}

void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width) {
  if (points.size() < 2) return;
  if (style.dash == 0.0F) {
    list->AddPolyline(points.data(), static_cast<int>(points.size()), style.colour, ImDrawFlags_None, width);
    return;
  }
  const float period = style.dash + style.gap;
  float done = 0.0F;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const ImVec2 a = points[i];
    const ImVec2 b = points[i + 1];
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length > 0.0F)) continue;
    const auto point = [&](float at) {
      return ImVec2{a.x + (b.x - a.x) * at / length, a.y + (b.y - a.y) * at / length};
    };
    for (float at = 0.0F; at < length;) {
      const float phase = std::fmod(done + at, period);
      const bool is_dash = phase < style.dash;
      const float next = std::min(length, at + std::max(0.01F, (is_dash ? style.dash : period) - phase));
      if (is_dash) list->AddLine(point(at), point(next), style.colour, width);
      at = next;
    }
    done += length;
  }
}

Plot::Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right, bool has_grid)
    : x_(std::move(x)), y_(std::move(y)), list_(ImGui::GetWindowDrawList()) {
  const float line = ImGui::GetTextLineHeight();
  const float bottom = x_.label.empty() ? 0.4F * line : 2.3F * line;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  min_ = {corner.x + 3.9F * line, corner.y + 1.4F * line};
  max_ = {corner.x + size.x - 0.6F * line - right, corner.y + size.y - bottom};
  max_ = {std::max(max_.x, min_.x + line), std::max(max_.y, min_.y + line)};
  list_->AddRectFilled(min_, max_, kPlotColour);
  draw_x_axis(has_grid);
  draw_y_axis(has_grid);
  list_->AddRect(min_, max_, kDimColour);
  ImGui::SetCursorScreenPos(min_);
  ImGui::InvisibleButton(id, {max_.x - min_.x, max_.y - min_.y});
  is_active_ = ImGui::IsItemActive();
  is_hovered_ = ImGui::IsItemHovered();
  ImGui::SetCursorScreenPos(corner);
  ImGui::Dummy(size);
}

ImVec2 Plot::at_position(double x, double y) const {
  return {min_.x + static_cast<float>(x) * (max_.x - min_.x), max_.y - static_cast<float>(y) * (max_.y - min_.y)};
}

double Plot::mouse_position_x() const {
  return std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - min_.x) / (max_.x - min_.x)), 0.0, 1.0);
}

double Plot::mouse_position_y() const {
  return std::clamp(static_cast<double>((max_.y - ImGui::GetIO().MousePos.y) / (max_.y - min_.y)), 0.0, 1.0);
}

void Plot::draw_x_axis(bool has_grid) const {
  const float line = ImGui::GetTextLineHeight();
  for (const double tick : ticks_of(x_, max_.x - min_.x, 4.0F * line)) {
    const float at = at_position(x_.position(tick), 0.0).x;
    if (has_grid) list_->AddLine({at, min_.y}, {at, max_.y}, kGridColour);
    list_->AddLine({at, max_.y}, {at, max_.y + 0.25F * line}, kDimColour);
    if (!x_.label.empty()) draw_text(list_, {at, max_.y + 0.25F * line}, {0.5F, 0.0F}, kDimColour, tick_text(tick));
  }
  if (x_.label.empty()) return;
  draw_text(list_, {0.5F * (min_.x + max_.x), max_.y + 1.25F * line}, {0.5F, 0.0F}, kTextColour, x_.label);
}

void Plot::draw_y_axis(bool has_grid) const {
  const float line = ImGui::GetTextLineHeight();
  for (const double tick : ticks_of(y_, max_.y - min_.y, 2.2F * line)) {
    const float at = at_position(0.0, y_.position(tick)).y;
    if (has_grid) list_->AddLine({min_.x, at}, {max_.x, at}, kGridColour);
    list_->AddLine({min_.x - 0.25F * line, at}, {min_.x, at}, kDimColour);
    draw_text(list_, {min_.x - 0.4F * line, at}, {1.0F, 0.5F}, kDimColour, tick_text(tick));
  }
  // Above the axis, where it needs no turned text.
  draw_text(list_, {min_.x - 2.6F * line, min_.y - 0.15F * line}, {0.0F, 1.0F}, kTextColour, y_.label);
}

}  // namespace dolp::explore
