#include "explore/window/plot.hpp"

#include <algorithm>
#include <cmath>

namespace dolp::explore {
namespace {

std::vector<double> axis_ticks(const Scale& scale, float pixels, float spacing) {
  return scale.ticks(static_cast<std::size_t>(std::max(3.0F, pixels / spacing)));
}

void draw_piece(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width) {
  if (style.dash == 0.0F && points.size() > 1)
    return list->AddPolyline(points.data(), static_cast<int>(points.size()), style.colour, ImDrawFlags_None, width);
  const float dash = scaled(style.dash), period = scaled(style.dash + style.gap);
  float done = 0.0F;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const ImVec2 a = points[i], b = points[i + 1];
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    const auto point = [&](float at) {
      return ImVec2{a.x + (b.x - a.x) * at / length, a.y + (b.y - a.y) * at / length};
    };
    for (float at = 0.0F; at < length;) {
      const float phase = std::fmod(done + at, period);
      const float next = std::min(length, at + std::max(0.01F, (phase < dash ? dash : period) - phase));
      if (phase < dash) list->AddLine(point(at), point(next), style.colour, width);
      at = next;
    }
    done += length;
  }
}

}  // namespace

void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text) {
  const std::string visible = shown(text);
  const ImVec2 size = ImGui::CalcTextSize(visible.c_str());
  list->AddText({std::round(at.x - anchor.x * size.x), std::round(at.y - anchor.y * size.y)}, colour, visible.c_str());
}

void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text) {
  const float padding = scaled(3.0F);
  const ImVec2 size = ImGui::CalcTextSize(shown(text).c_str());
  const ImVec2 corner{at.x - anchor.x * size.x, at.y - anchor.y * size.y};
  list->AddRectFilled({corner.x - padding, corner.y - 1.0F}, {corner.x + size.x + padding, corner.y + size.y + 1.0F},
                      kLabelGround, padding);
  draw_text(list, at, anchor, colour, text);
}

void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width) {
  const auto is_gap = [](ImVec2 point) { return std::isnan(point.x); };
  for (auto first = points.begin(); first != points.end();) {
    const auto last = std::find_if(first, points.end(), is_gap);
    draw_piece(list, {first, last}, style, scaled(width));
    first = std::find_if_not(last, points.end(), is_gap);
  }
}

void draw_colours(ImDrawList* list, const Area& bar, bool is_upright, const std::function<ImU32(double)>& colour_at) {
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const float from = static_cast<float>(i) / kSteps, to = static_cast<float>(i + 1) / kSteps;
    const ImVec2 low = is_upright ? bar.at(0.0F, 1.0F - to) : bar.at(from, 0.0F);
    const ImVec2 high = is_upright ? bar.at(1.0F, 1.0F - from) : bar.at(to, 1.0F);
    list->AddRectFilled(low, high, colour_at((i + 0.5) / kSteps));
  }
}

Plot::Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right, bool has_grid)
    : x_(std::move(x)), y_(std::move(y)), list_(ImGui::GetWindowDrawList()) {
  const float line = ImGui::GetTextLineHeight();
  const float bottom = (x_.label.empty() ? 1.3F : 2.3F) * line;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  area_.min = {corner.x + 3.9F * line, corner.y + 1.8F * line};
  area_.max = {std::max(corner.x + size.x - 0.6F * line - right, min().x + line),
               std::max(corner.y + size.y - bottom, min().y + line)};
  list_->AddRectFilled(min(), max(), kPlotColour);
  draw_x_axis(has_grid);
  draw_y_axis(has_grid);
  list_->AddRect(min(), max(), kDimColour);
  ImGui::SetCursorScreenPos(min());
  ImGui::InvisibleButton(id, {area_.width(), area_.height()},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  name_area(std::string("plot ") + id, area_);
  is_dragged_ = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  is_shifted_ = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right);
  is_hovered_ = ImGui::IsItemHovered();
  ImGui::SetCursorScreenPos(corner);
  ImGui::Dummy(size);
}

void Plot::follow_mouse(Zoom& zoom, const Scale& all_x) const {
  constexpr float kPerNotch = 1.25F;
  constexpr double kLeastPart = 1e-4;  // the zoomed range is at least this share of `all_x`
  const ImGuiIO& io = ImGui::GetIO();
  if (is_hovered_ && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) zoom = {};
  if (is_shifted_ && (io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F)) {
    const double across = static_cast<double>(io.MouseDelta.x / area_.width());
    const double up = static_cast<double>(-io.MouseDelta.y / area_.height());
    zoom = {x().between(-across, 1.0 - across).within(all_x), y().between(-up, 1.0 - up)};
  }
  if (!is_hovered_ || io.MouseWheel == 0.0F) return;
  const double part = static_cast<double>(std::pow(kPerNotch, -io.MouseWheel));
  const auto magnified = [part](const Scale& scale, double at) {
    return scale.between(at - at * part, at + (1.0 - at) * part);
  };
  if (!io.KeyAlt) {
    const Scale wanted = magnified(x(), mouse_x());
    if (wanted.to - wanted.from > kLeastPart * (all_x.to - all_x.from)) zoom.x = wanted.within(all_x);
  }
  if (!io.KeyShift) {
    const Scale wanted = magnified(y(), mouse_y());
    const double largest = std::max(std::abs(wanted.from), std::abs(wanted.to));
    if (wanted.to - wanted.from > kLeastPart * kLeastPart * largest) zoom.y = wanted;
  }
}

void Plot::draw_x_axis(bool has_grid) const {
  const float line = ImGui::GetTextLineHeight();
  for (const double tick : axis_ticks(x(), area_.width(), 3.4F * line)) {
    const float at = x_pixel(tick);
    if (has_grid) list_->AddLine({at, min().y}, {at, max().y}, kGridColour);
    list_->AddLine({at, max().y}, {at, max().y + 0.25F * line}, kDimColour);
    draw_text(list_, {at, max().y + 0.25F * line}, {0.5F, 0.0F}, kDimColour, tick_text(tick));
  }
  if (x_.label.empty()) return;
  draw_text(list_, {0.5F * (min().x + max().x), max().y + 1.25F * line}, {0.5F, 0.0F}, kTextColour, x_.label);
}

void Plot::draw_y_axis(bool has_grid) const {
  const float line = ImGui::GetTextLineHeight();
  for (const double tick : axis_ticks(y(), area_.height(), 2.2F * line)) {
    const float at = at_position(0.0, y().position(tick)).y;
    if (has_grid) list_->AddLine({min().x, at}, {max().x, at}, kGridColour);
    list_->AddLine({min().x - 0.25F * line, at}, {min().x, at}, kDimColour);
    draw_text(list_, {min().x - 0.4F * line, at}, {1.0F, 0.5F}, kDimColour, tick_text(tick));
  }
  // The label is above the y axis, where its text need not be rotated.
  draw_text(list_, {min().x - 2.6F * line, min().y - 0.6F * line}, {0.0F, 1.0F}, kTextColour, y_.label);
}

}  // namespace dolp::explore
