#pragma once

#include "explore/session.hpp"
#include "explore/window/plot.hpp"
#include "explore/window/screen.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

// Each view fills the current ImGui window, or `size` in it.

/// Fills the current ImGui window with the controls of a scene. Tests find these areas by name (Input::areas): "KEY" is
/// the slider, list or box of a scene key; "vary KEY" the box that lets a number vary in fits; "field KEY" the text
/// field beside a slider; "field fit KEY 0" and "field fit KEY 1" the fields for the ends of its range in fits; "sky"
/// the list of skies; "sky zenith" and "sky horizon" the sliders of their temperatures.
void draw_controls(Session& session, NumberFields& fields);
void draw_accuracy_controls(Session& session, NumberFields& fields);  ///< tolerance and precision, beside the cost

/// A line of a plot. All lines of the plot have their values at the same positions.
struct NamedLine {
  std::string name;
  CurveStyle style;
  std::vector<double> values;
};

/// The current curve, the overlay, pins and measured points, below a legend that shows or hides them. A click or drag
/// moves the cursor. The mouse controls the zoom.
class CurveView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Area& area() const { return area_; }  ///< last drawn area of the curves
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
void draw_slopes(const Session& session, ImVec2 size);    ///< both distributions, with an equal D(0)
void draw_material(const Session& session, ImVec2 size);  ///< n and k over wavelength

/// Draws the curve over wavelength at the cursor's zenith. A drag along wavelengths changes the scene's wavelength.
void draw_spectrum(Session& session, AxisEditor& editor, ImVec2 size);
/// R_s and R_p of the smooth surface over the local angle of incidence, and over wavelength at the cursor's zenith.
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
  std::string reason_;  ///< reason why there is no cut
};

/// A sphere and a tilted plate as a camera would see them under the scene's radiation: DOLP and angle of polarisation.
class ShapeView {
 public:
  void draw(Session& session, ImVec2 size);  ///< a drag tilts the plate and moves the cursor to its zenith

 private:
  double azimuth_deg_ = 30.0;  ///< direction of the tilt from the image's horizontal
};

/// The last fit: minima, intervals and explanations. A click visits a minimum, whose area is "minimum N", from 1.
void draw_fit_result(Session& session);

void draw_sky(const Session& session, ImVec2 size);  ///< DOLP over the source's direction, as a polar map

/// Changes the typed range of a wavelength axis or of a map axis.
void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change);

/// Map, contour lines, colour bar and cursor. A click or drag moves the cursor, and the scene follows.
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

  Scale colour_scale_;  ///< values of the first and the last colour; equal if all values are
  MapField field_;
  Texture cells_;
  std::vector<Contour> contours_;
  Area area_;
};

}  // namespace dolp::explore
