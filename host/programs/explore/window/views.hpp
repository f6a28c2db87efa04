#pragma once

#include "explore/session.hpp"
#include "explore/window/plot.hpp"
#include "explore/window/screen.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

// Each view fills the current ImGui window, or the area `size` in it.

/// Fills the current ImGui window with the controls of a scene. Tests find these areas by name (Input::areas): "KEY" is
/// the slider, list or box of a scene key; "vary KEY" the box that lets a number vary in fits; "field KEY" the text
/// field beside a slider; "field fit KEY 0" and "field fit KEY 1" the fields for the ends of its range in fits; "sky"
/// the list of skies; "sky zenith" and "sky horizon" the sliders of their temperatures.
void draw_controls(Session& session, NumberFields& fields);
void draw_accuracy_controls(Session& session, NumberFields& fields);  ///< draws tolerance and precision

/// A line of a plot with several lines. The x values of all these lines are equal.
struct NamedLine {
  std::string name;
  CurveStyle style;
  std::vector<double> values;
};

/// The current curve, the overlay, pins and measured points. A click in the legend hides the overlay, and hides or
/// shows a pin. A click or drag in the plot moves the cursor. The mouse controls the zoom (Plot::follow_mouse).
class CurveView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Area& area() const { return area_; }  ///< area of the plot in the last frame
  const Scale& x() const { return x_; }
  const Scale& y() const { return y_; }

 private:
  /// Sets x_ and y_ to the zoom. Without a zoom, sets them to the automatic ranges `zeniths` and `values`.
  void choose_axes(const Session& session, Zoom& zoom, const Scale& zeniths, Scale& values);
  void edit_axes(View& view, AxisEditor& editor, const Plot& plot, const std::string& values);

  Area area_;
  Scale x_, y_;
  Plotted quantity_ = Plotted::kDolp;
};

void draw_effects(const Session& session);
void draw_slopes(const Session& session, ImVec2 size);    ///< D of the scene, and of with_other_distribution()
void draw_material(const Session& session, ImVec2 size);  ///< n and k over wavelength

/// Draws the plotted quantity over wavelength at the cursor's zenith. A drag changes the scene's wavelength.
void draw_spectrum(Session& session, AxisEditor& editor, ImVec2 size);
/// Draws the reflectances R_s and R_p of a facet over the local angle of incidence, and over wavelength at one angle.
void draw_smooth(Session& session, AxisEditor& editor, ImVec2 size);

/// One element of the Mueller pBRDF in the plane of incidence, as a polar plot. Light comes from the cursor's zenith.
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

/// Images of a sphere and a tilted plate with the scene's surface. They show DOLP and angle of polarisation.
class ShapeView {
 public:
  void draw(Session& session, ImVec2 size);  ///< a drag sets azimuth and zenith of the plate's normal

 private:
  double azimuth_deg_ = 30.0;  ///< direction of the tilt from the image's horizontal
};

/// Draws the last fit: minima, intervals, explanations. A click visits a minimum. The areas are "minimum 1" and so on.
void draw_fit_result(Session& session);

void draw_sky(const Session& session, ImVec2 size);  ///< DOLP over the directions of the source, as a polar map

/// Stores in the session's view a range that the user typed for a wavelength axis or a map axis.
void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change);

/// Map, contour lines, colour bar and cursor. A click or drag moves the cursor and gives the scene the values there.
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

  // The inputs from which update() computed the members below.
  std::size_t version_ = 0;
  Plotted quantity_ = Plotted::kDolp;
  bool is_log_ = false;
  std::optional<Scale> typed_colours_;

  Scale colour_scale_;  ///< values of the first and the last colour; may be equal
  MapField field_;
  Texture cells_;
  std::vector<Contour> contours_;
  Area area_;
};

}  // namespace dolp::explore
