#pragma once

#include "explore/session.hpp"
#include "explore/window/plot.hpp"
#include "explore/window/screen.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

// Each view fills the current ImGui window, or an area of the given size.

void draw_controls(Session& session, NumberFields& fields);
void draw_accuracy_controls(Session& session, NumberFields& fields);  ///< draws tolerance and precision

/// The y values of a line in a plot. All lines of the plot have the same x values.
struct NamedLine {
  std::string name;
  CurveStyle style;
  std::vector<double> values;
};

/// Draws the current curve, the overlay, pins and measured points. A click or drag in the plot moves the cursor. A
/// click on the overlay in the legend hides the overlay. A click on a pin in the legend hides or shows the pin.
class CurveView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Area& area() const { return area_; }  ///< area of the plot in the last frame
  const Scale& x() const { return x_; }
  const Scale& y() const { return y_; }

 private:
  /// Sets x_ and y_ to the ranges in `zoom`, if the user chose such ranges. Otherwise sets x_ to `zeniths`, and y_ to
  /// `values`, or to a wider range while the user drags a slider. At the end, sets `values` to y_.
  void choose_axes(const Session& session, Zoom& zoom, const Scale& zeniths, Scale& values);
  void edit_axes(View& view, AxisEditor& editor, const Plot& plot, const std::string& values);

  Area area_;
  Scale x_, y_;
  Plotted quantity_ = Plotted::kDolp;
};

void draw_effects(const Session& session);
void draw_slopes(const Session& session, ImVec2 size);    ///< slope distributions D
void draw_material(const Session& session, ImVec2 size);  ///< n and k over wavelength

/// Draws the plotted quantity over wavelength at the cursor's zenith. A drag changes the scene's wavelength.
void draw_spectrum(Session& session, AxisEditor& editor, ImVec2 size);
/// Draws the reflectances R_s and R_p of a facet over the local angle of incidence, and over wavelength at one angle.
void draw_smooth(Session& session, AxisEditor& editor, ImVec2 size);

/// Draws an element of the Mueller pBRDF in the plane of incidence, for light from the zenith of the cursor.
class ScatteringView {
 public:
  void draw(Session& session, ImVec2 size);

 private:
  void update(const Session& session);

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

/// Stores in View::ranges the range that the user typed for an axis of wavelengths or of the map.
void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change);

/// Draws map, contour lines, colour bar and cursor. A click or drag calls Session::set_map_cursor().
class MapView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Scale& colours() const { return colour_scale_; }
  const Area& area() const { return area_; }

 private:
  struct Contour {
    double level;
    std::vector<Segment> segments;
  };
  const PlottedDescription& quantity() const { return described(quantity_); }
  void update(const Session& session);
  Scale colour_range() const;  ///< values of the first and of the last colour
  ImU32 colour(double position) const;
  void edit_axes(Session& session, AxisEditor& editor, const Plot& plot);
  double colour_position(double value) const;
  void draw_contours(const Plot& plot) const;
  void draw_bar(const Plot& plot) const;

  // The inputs of the last update(), which computed the members below.
  std::size_t version_ = 0;
  Plotted quantity_ = Plotted::kDolp;
  bool is_log_ = false;
  std::optional<Scale> typed_colours_;

  Scale colour_scale_;  ///< values of the first and the last colour; may be equal if the map is constant
  MapField field_;
  Texture cells_;
  std::vector<Contour> contours_;
  Area area_;
};

}  // namespace dolp::explore
