// Axes, curves and maps from ImGui's draw lists.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "explore/scale.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

/// A rectangle in pixels of the window, y downwards.
struct Area {
  ImVec2 min, max;

  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  /// At fractions of width and height, from the upper left corner.
  ImVec2 at(float x, float y) const { return {min.x + x * width(), min.y + y * height()}; }
};

/// One axis of a plot.
struct PlotAxis {
  std::string label;
  Scale scale;
};

/// A rectangle of the screen with two axes.
class Plot {
 public:
  /// Takes `size` of the current ImGui window from its cursor on, margins for marks and labels included, and draws
  /// background, grid and axes. `right` leaves room at the right side.
  Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right = 0.0F, bool has_grid = true);

  const Area& area() const { return area_; }
  ImVec2 min() const { return area_.min; }
  ImVec2 max() const { return area_.max; }
  const Scale& x() const { return x_.scale; }
  const Scale& y() const { return y_.scale; }
  ImDrawList* list() const { return list_; }
  // The numbers beside the axes.
  Area x_numbers() const;
  Area y_numbers() const;
  /// True where a point has a place along both axes.
  bool has_place(double x_value, double y_value) const;

  ImVec2 at(double x_value, double y_value) const { return at_position(x().position(x_value), y().position(y_value)); }
  ImVec2 at_position(double x, double y) const;
  /// True while the left button, which was pressed inside, is held down.
  bool is_dragged() const { return is_dragged_; }
  bool is_hovered() const { return is_hovered_; }
  /// Follows the mouse of this frame: the wheel magnifies about its place (with Shift along x alone, with Alt along y),
  /// the right button shifts, a double click shows all again. `all_x`: the longest axis there may be.
  void follow_mouse(Zoom& zoom, const Scale& all_x) const;
  /// The position of the mouse, from 0 to 1 along both axes; outside of the plot that of the nearest point.
  double mouse_x() const;
  double mouse_y() const;

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

/// A line through points, dashed where the style says so; its width and dashes are scaled().
void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width);

/// Text with its anchor at a fraction of its own size: (0.5, 0) is centred below `at`.
void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// The same on a dark ground, for what lies over curves.
void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

}  // namespace dolp::explore
