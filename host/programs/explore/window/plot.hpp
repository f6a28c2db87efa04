#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "explore/scale.hpp"
#include "explore/window/input.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

struct PlotAxis {
  std::string label;
  Scale scale;
};

/// The ranges of a plot that the user chose by mouse or by typing. An empty one means the whole axis.
struct Zoom {
  std::optional<Scale> x, y;
};

class Plot {
 public:
  /// Takes an area of `size`, with margins for ticks and labels, at the cursor of the current ImGui window. Draws
  /// background, grid and axes. `right` is the width of a margin on the right for a colour bar.
  Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right = 0.0F, bool has_grid = true);

  const Area& area() const { return area_; }
  ImVec2 min() const { return area_.min; }
  ImVec2 max() const { return area_.max; }
  const Scale& x() const { return x_.scale; }
  const Scale& y() const { return y_.scale; }
  ImDrawList* list() const { return list_; }
  // The areas of the tick labels. A double click on them opens the AxisEditor.
  Area x_numbers() const {
    const float line = ImGui::GetTextLineHeight();
    return {{min().x - line, max().y + 0.1F * line}, {max().x + line, max().y + 2.2F * line}};
  }
  Area y_numbers() const {
    const float line = ImGui::GetTextLineHeight();
    return {{min().x - 3.5F * line, min().y - 0.5F * line}, {min().x - 0.1F * line, max().y + 0.5F * line}};
  }
  /// True if the plot can show a point: the y value is finite, and the values on logarithmic axes are positive.
  bool can_show(double x_value, double y_value) const {
    return std::isfinite(y_value) && (!x().is_log || x_value > 0.0) && (!y().is_log || y_value > 0.0);
  }

  ImVec2 at(double x_value, double y_value) const { return at_position(x().position(x_value), y().position(y_value)); }
  ImVec2 at_position(double x, double y) const { return area_.at(static_cast<float>(x), 1.0F - static_cast<float>(y)); }
  bool is_dragged() const { return is_dragged_; }  ///< the left button went down in the plot and is down
  bool is_hovered() const { return is_hovered_; }
  /// Changes `zoom` by the mouse events of this frame. The wheel zooms around the mouse, with Shift only along x, with
  /// Alt only along y. The right button moves the plot. A double click resets it. `all_x` limits the x axis.
  void follow_mouse(Zoom& zoom, const Scale& all_x) const;
  /// The position of the mouse, or the nearest position in the plot, from 0 to 1 along both axes.
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

/// Draws a line through `points`. Width and dashes grow with the text size (scaled()). The point kGap makes a gap.
inline const ImVec2 kGap{std::numeric_limits<float>::quiet_NaN(), 0.0F};
void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width);

/// Draws text. Its point `anchor` lies at `at`. The unit of `anchor` is the text's width and height: with (0.5, 0) the
/// text is centred below `at`.
void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// Draws text on a background that hides curves behind it.
void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// Draws a colour bar with the colours colour_at(0) to colour_at(1), upwards if `is_upright`, otherwise to the right.
void draw_colours(ImDrawList* list, const Area& bar, bool is_upright, const std::function<ImU32(double)>& colour_at);

}  // namespace dolp::explore
