// Axes, curves and maps from ImGui's draw lists.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "explore/heat_map.hpp"
#include "explore/window/colours.hpp"

namespace dolp::explore {

/// One axis of a plot.
struct PlotAxis {
  std::string label;
  double from = 0.0;
  double to = 1.0;
  bool is_log = false;

  double position(double value) const;
  double value(double position) const;
};

/// A rectangle of the screen with two axes.
class Plot {
 public:
  /// Takes `size` of the current ImGui window from its cursor on, margins for marks and labels included, and draws
  /// background, grid and axes. `right` leaves room at the right side.
  Plot(const char* id, ImVec2 size, PlotAxis x, PlotAxis y, float right = 0.0F, bool has_grid = true);

  ImVec2 min() const { return min_; }
  ImVec2 max() const { return max_; }
  const PlotAxis& x() const { return x_; }
  const PlotAxis& y() const { return y_; }
  ImDrawList* list() const { return list_; }

  ImVec2 at(double x, double y) const { return at_position(x_.position(x), y_.position(y)); }
  ImVec2 at_position(double x, double y) const;
  /// State of the mouse inside the plot, and its position as values of the axes.
  bool is_dragged() const { return is_active_; }
  bool is_hovered() const { return is_hovered_; }
  double mouse_x() const { return x_.value(mouse_position_x()); }
  double mouse_position_x() const;
  double mouse_position_y() const;

  void clip() const { list_->PushClipRect(min_, max_, true); }
  void unclip() const { list_->PopClipRect(); }

 private:
  void draw_x_axis(bool has_grid) const;
  void draw_y_axis(bool has_grid) const;

  PlotAxis x_, y_;
  ImVec2 min_, max_;
  ImDrawList* list_ = nullptr;
  bool is_active_ = false;
  bool is_hovered_ = false;
};

/// A line through points, dashed where the style says so.
void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, const CurveStyle& style, float width);

/// Text with its anchor at a fraction of its own size: (0.5, 0) is centred below `at`.
void draw_text(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

/// The same on a dark ground, for what lies over curves.
void draw_label(ImDrawList* list, ImVec2 at, ImVec2 anchor, ImU32 colour, const std::string& text);

}  // namespace dolp::explore
