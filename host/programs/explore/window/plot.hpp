#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "explore/scale.hpp"
#include "explore/window/input.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

struct PlotAxis {
  std::string label;
  Scale scale;
};

/// The ranges of a plot that the user chose by mouse or by typing. An empty range means the automatic range.
struct Zoom {
  std::optional<Scale> x, y;
};

class Plot {
 public:
  /// Draws background, grid and axes at the cursor of the current ImGui window. `size` includes the margins for
  /// ticks, labels and a colour bar. `right` is the width of the margin for the colour bar.
  Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right = 0.0F, bool has_grid = true);

  const Area& area() const { return area_; }
  ImVec2 min() const { return area_.min; }
  ImVec2 max() const { return area_.max; }
  const Scale& x() const { return x_.scale; }
  const Scale& y() const { return y_.scale; }
  ImDrawList* list() const { return list_; }
  // Areas of the numbers along the axes. A double click in these areas opens the AxisEditor.
  Area x_numbers() const {
    const float line = ImGui::GetTextLineHeight();
    return {{min().x - line, max().y + 0.1F * line}, {max().x + line, max().y + 2.2F * line}};
  }
  Area y_numbers() const {
    const float line = ImGui::GetTextLineHeight();
    return {{min().x - 3.5F * line, min().y - 0.5F * line}, {min().x - 0.1F * line, max().y + 0.5F * line}};
  }
  bool can_show(double x_value, double y_value) const {
    return std::isfinite(y_value) && (!x().is_log || x_value > 0.0) && (!y().is_log || y_value > 0.0);
  }

  ImVec2 at(double x_value, double y_value) const { return at_position(x().position(x_value), y().position(y_value)); }
  ImVec2 at_position(double x, double y) const { return area_.at(static_cast<float>(x), 1.0F - static_cast<float>(y)); }
  float x_pixel(double x_value) const { return at_position(x().position(x_value), 0.0).x; }
  void draw_cursor(double x_value) const {  // a vertical line
    list_->AddLine({x_pixel(x_value), min().y}, {x_pixel(x_value), max().y}, kCursorColour, scaled(1.0F));
  }
  bool is_dragged() const { return is_dragged_; }  ///< the left button went down in the plot and is still down
  bool is_hovered() const { return is_hovered_; }
  /// Changes `zoom` by the mouse input of this frame: the wheel zooms (with Shift only x, with Alt only y), the right
  /// button moves the range, a double click removes the zoom. `all_x` is the largest range of x.
  void follow_mouse(Zoom& zoom, const Scale& all_x) const;
  /// The position in the plot that is nearest to the mouse: from 0 to 1 along both axes.
  double mouse_x() const {
    return std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - min().x) / area_.width()), 0.0, 1.0);
  }
  double mouse_y() const {
    return std::clamp(static_cast<double>((max().y - ImGui::GetIO().MousePos.y) / area_.height()), 0.0, 1.0);
  }

  void clip() const { list_->PushClipRect(area_.min, area_.max, true); }
  void unclip() const { list_->PopClipRect(); }

 private:
  void draw_x_axis(bool has_grid) const;
  void draw_y_axis(bool has_grid) const;

  PlotAxis x_, y_;
  Area area_;
  ImDrawList* list_ = nullptr;
  bool is_dragged_ = false;
  bool is_shifted_ = false;
  bool is_hovered_ = false;
};

inline const ImVec2 kGap{std::numeric_limits<float>::quiet_NaN(), 0.0F};  ///< a point that makes a gap in a line
/// Draws a line through `points`. The width and the dashes scale with the size of the text.
void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width);

/// Draws text. `at` is its upper left corner for `anchor` (0, 0), and its centre for `anchor` (0.5, 0.5).
void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// Draws text as draw_text() does, on a background that hides curves.
void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// Draws a colour bar with the colours colour_at(0) to colour_at(1), upwards if `is_upright`, otherwise to the right.
void draw_colours(ImDrawList* list, const Area& bar, bool is_upright, const std::function<ImU32(double)>& colour_at);

}  // namespace dolp::explore
