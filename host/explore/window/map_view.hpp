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
  /// The lines of one value.
  struct Line {
    double level;
    std::vector<Segment> segments;
  };
  void update(const Session& session);
  void draw_cells(const class Plot& plot) const;
  void draw_lines(const class Plot& plot, double scale) const;
  void draw_bar(const class Plot& plot, const QuantityDescription& quantity) const;

  // Made anew when the map or the quantity changes.
  std::size_t version_ = 0;
  Quantity quantity_ = Quantity::kDolp;
  MapField field_;
  std::vector<ImU32> colours_;
  std::vector<Line> lines_;
};

}  // namespace dolp::explore
