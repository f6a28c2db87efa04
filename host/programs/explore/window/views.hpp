// The window's views of a session: curves, map, effects.
#pragma once

#include <imgui.h>

#include <vector>

#include "explore/session.hpp"
#include "explore/window/plot.hpp"

namespace dolp::explore {

/// Fills `size` of the current ImGui window with the current curve, the overlaid one, pins and measured points; a click
/// or drag moves the cursor. Returns the area of the curves.
Area draw_curve_view(Session& session, ImVec2 size);

/// Fills the current ImGui window with the plan's treatment of each effect, its influence and the reason.
void draw_effects(const Session& session);

class MapView {
 public:
  /// Fills `size` of the current ImGui window with map, contour lines, colour bar and cursor; a click or drag moves the
  /// cursor, which the scene follows.
  void draw(Session& session, ImVec2 size);

 private:
  /// Cells of one colour beside or above one another.
  struct Run {
    std::size_t column, row;
    std::size_t columns, rows;
    ImU32 colour;
  };
  /// The lines of one value.
  struct Line {
    double level;
    std::vector<Segment> segments;
  };
  void update(const Session& session);
  double colour_position(double value) const;
  std::vector<Run> runs_along(bool rows) const;
  void draw_cells(const Plot& plot) const;
  void draw_lines(const Plot& plot, double scale) const;
  void draw_bar(const Plot& plot, const PlottedDescription& quantity) const;

  // Made anew when the map or the quantity changes.
  std::size_t version_ = 0;
  Plotted quantity_ = Plotted::kDolp;
  bool is_log_ = false;
  Scale colour_scale_;  ///< from the first colour to the last; empty where all values are equal
  MapField field_;
  std::vector<ImU32> colours_;
  std::vector<Run> runs_;
  std::vector<Line> lines_;
};

}  // namespace dolp::explore
