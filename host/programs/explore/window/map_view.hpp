// The heat map.
#pragma once

#include <imgui.h>

#include <vector>

#include "explore/contours.hpp"
#include "explore/session.hpp"

namespace dolp::explore {

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
  bool uses_log() const { return is_log_ && low_ > 0.0; }
  double colour_position(double value) const;
  std::vector<Run> runs_along(bool rows) const;
  void draw_cells(const class Plot& plot) const;
  void draw_lines(const class Plot& plot, double scale) const;
  void draw_bar(const class Plot& plot, const PlottedDescription& quantity) const;

  // Made anew when the map or the quantity changes.
  std::size_t version_ = 0;
  Plotted quantity_ = Plotted::kDolp;
  bool is_log_ = false;
  double low_ = 0.0;  ///< value of the first colour
  MapField field_;
  std::vector<ImU32> colours_;
  std::vector<Run> runs_;
  std::vector<Line> lines_;
};

}  // namespace dolp::explore
