#pragma once

#include "explore/session.hpp"
#include "explore/window/plot.hpp"
#include "explore/window/screen.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

// Each view fills the current ImGui window, or an area of the given size.

/// What the controls of the scene remember from frame to frame.
struct ControlState {
  NumberFields fields = {};
  ControlRows rows = {};
  std::string search = {};  ///< text in the search field of the open list of materials
  std::string wanted_file =
      {};  ///< "surface", or the table of a film, whose own file of n and k the user wants to open
};

void draw_controls(Session& session, ControlState& state);
void draw_accuracy_controls(Session& session, ControlState& state);  ///< draws tolerance and precision

/// The y values of a line in a plot. All lines of the plot have the same x values.
struct NamedLine {
  std::string name;
  CurveStyle style;
  std::vector<double> values;
};

struct ShownCurve {
  const Curve* curve;
  CurveStyle style;
};

/// Draws the current curve, the overlay, pins and measured points. A click or drag in the plot moves the cursor. A
/// click on the overlay in the legend hides the overlay. A click on a pin in the legend hides or shows the pin.
class CurveView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Scale& x() const { return x_; }
  const Scale& y() const { return y_; }

 private:
  /// Sets x_ and y_ to the ranges in `zoom`, which the user chose. Without such a range, x_ becomes `zeniths`, and y_
  /// becomes `values`; but while the user drags a slider, y_ only grows. Copies y_ to `values`.
  void choose_axes(const Session& session, Zoom& zoom, const Scale& zeniths, Scale& values);
  void edit_axes(View& view, AxisEditor& editor, const Plot& plot, const std::string& values);

  float draw_legend_above(const std::vector<ShownCurve>& curves, Session& session, ImVec2 size);

  Scale x_, y_;
  Plotted quantity_ = Plotted::kDolp;
  float legend_height_ = 0.0F;  ///< height of the legend's entries in the last frame
};

void draw_effects(const Session& session);
void draw_slopes(const Session& session, ImVec2 size);    ///< slope distributions D
void draw_material(const Session& session, ImVec2 size);  ///< n and k over wavelength

/// Draws the plotted quantity at the cursor's zenith over another number of the scene (Session::sweep()): wavelength,
/// zenith of the camera, or azimuth of the surface. A drag changes this number.
void draw_sweep(Session& session, AxisEditor& editor, ImVec2 size);
/// Draws the reflectances R_s and R_p of a facet over the local angle of incidence, and over wavelength at one angle.
void draw_smooth(Session& session, AxisEditor& editor, ImVec2 size);

/// Draws a Mueller pBRDF element over the view zenith in the plane of incidence, for light from the cursor's zenith.
class ScatteringView {
 public:
  void draw(Session& session, ImVec2 size);

 private:
  Evaluator evaluator_{EvaluatorOptions{.evaluator = "cpu"}};
  std::string key_;
  ScatteringCut cut_;
  std::string reason_;  ///< reason why cut_ is empty
};

/// Draws a sphere and a tilted plate with the scene's surface, in the colours of DOLP and angle of polarisation.
class ShapeView {
 public:
  void draw(Session& session, ImVec2 size);  ///< a drag sets azimuth and zenith of the plate's normal

 private:
  double azimuth_deg_ = 30.0;  ///< direction to which the plate's normal tilts: 0 is right, 90 is up
};

/// Draws minima, intervals and explanations of the last fit. A click on a minimum calls Session::visit_minimum().
void draw_fit_result(Session& session);

void draw_sky(const Session& session, ImVec2 size);  ///< DOLP over the directions of the source, as a polar map

/// Stores a typed range in View::ranges. `axis` is the axis of wavelengths or an axis of the map.
void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change);

/// Draws map, contour lines, colour bar and cursor. A click or drag calls Session::set_map_cursor().
class MapView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Scale& colours() const { return colour_scale_; }

 private:
  struct Contour {
    double level;
    std::vector<Segment> segments;
  };
  const PlottedDescription& quantity() const { return described(field_.quantity); }
  void update(const Session& session);
  Scale colour_range() const;  ///< automatic range of the values that the colours show
  ImU32 colour(double position) const;
  void edit_axes(Session& session, AxisEditor& editor, const Plot& plot);
  double colour_position(double value) const;
  void draw_contours(const Plot& plot) const;
  void draw_bar(const Plot& plot) const;

  // Inputs of the last update(). From them it computed the members from colour_scale_ to contours_.
  std::size_t version_ = 0;
  bool is_log_ = false;
  std::optional<Scale> typed_colours_;

  Scale colour_scale_;  ///< values of the first and the last colour; may be equal if the map is constant
  MapField field_;
  Texture cells_;
  std::vector<Contour> contours_;
};

}  // namespace dolp::explore
