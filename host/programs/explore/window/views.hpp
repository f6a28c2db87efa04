// The window's views of a session: curves, map, effects.
#pragma once

#include <imgui.h>

#include <map>
#include <string>
#include <vector>

#include "explore/session.hpp"
#include "explore/window/axis_editor.hpp"
#include "explore/window/plot.hpp"

namespace dolp::explore {

class CurveView {
 public:
  /// Fills `size` of the current ImGui window with the current curve, the overlaid one, pins and measured points, below
  /// a legend that switches them; a click or drag moves the cursor, and Zoom follows the mouse.
  void draw(Session& session, ImVec2 size);
  /// The last drawn area of the curves, and their axes.
  const Area& area() const { return area_; }
  const Scale& x() const { return x_; }
  const Scale& y() const { return y_; }
  const AxisEditor& axis_editor() const { return axis_editor_; }

 private:
  void edit_axes(View& view, const Plot& plot, const std::string& values);

  Area area_;
  Scale x_, y_;
  AxisEditor axis_editor_;
  Plotted quantity_ = Plotted::kDolp;
};

/// Fills the current ImGui window with the plan's treatment of each effect, its influence and the reason.
void draw_effects(const Session& session);

/// Fills `size` of the current ImGui window with the slope distribution and the other one with the same D(0).
void draw_slopes(const Session& session, ImVec2 size);

/// Likewise with n and k of the material over wavelength, the scene's spectrum marked.
void draw_material(const Session& session, ImVec2 size);

/// Likewise with one element of the Mueller pBRDF in the plane of incidence, as a polar plot for the cursor's zenith.
class ScatteringView {
 public:
  void draw(Session& session, ImVec2 size);

 private:
  void update(const Session& session);

  Evaluator evaluator_{EvaluatorOptions{.evaluator = "cpu"}};
  std::string key_;
  ScatteringCut cut_;
  std::string reason_;  ///< why there is none
};

/// A sphere and a tilted plate as a camera sees them under the scene's radiation: DOLP and angle of polarisation.
class ShapeView {
 public:
  /// A drag tilts the plate, and moves the cursor to its zenith.
  void draw(Session& session, ImVec2 size);

 private:
  double azimuth_deg_ = 30.0;  ///< to which the plate is tilted, from the image's horizontal
};

/// Fills the current ImGui window with the minima of the last fit, which a click visits, its intervals, and the words
/// of `dolp fit`. `areas` gets "minimum N" of each, from 1.
void draw_fit_result(Session& session, std::map<std::string, Area>& areas);

/// DOLP of a bistatic scene over the direction of the source, as a polar map.
void draw_sky(const Session& session, ImVec2 size);

class MapView {
 public:
  const Scale& colours() const { return colour_scale_; }
  const Area& area() const { return area_; }
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
  /// The values of the first colour and the last.
  Scale colour_range(const Session& session) const;
  ImU32 colour(double position) const;
  void edit_axes(Session& session, const Plot& plot);
  double colour_position(double value) const;
  std::vector<Run> runs_along(bool rows) const;
  void draw_cells(const Plot& plot) const;
  void draw_lines(const Plot& plot, double scale) const;
  void draw_bar(const Plot& plot, const PlottedDescription& quantity) const;

  // Made anew when the map or the quantity changes.
  std::size_t version_ = 0;
  Plotted quantity_ = Plotted::kDolp;
  bool is_log_ = false;
  Scale colour_scale_;                  ///< from the first colour to the last; empty where all values are equal
  std::optional<Scale> typed_colours_;  ///< of the view that colour_scale_ belongs to
  AxisEditor axis_editor_;
  MapField field_;
  std::vector<ImU32> colours_;
  std::vector<Run> runs_;
  std::vector<Line> lines_;
  Area area_;
};

}  // namespace dolp::explore
