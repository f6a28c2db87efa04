// The window's views of a session: controls, curves, map, effects, and the views that can replace the map.
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
/// Draws the controls of tolerance and precision, which are beside the cost.
void draw_accuracy_controls(Session& session, NumberFields& fields);

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
  /// The last drawn area of the curves, and their axes.
  const Area& area() const { return area_; }
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

/// Draws a table of effects: whether the plan keeps each one and why, and its influence.
void draw_effects(const Session& session);

/// Draws the slope distribution, and the other distribution with an equal D(0).
void draw_slopes(const Session& session, ImVec2 size);

/// Draws n and k of the material over wavelength, with the scene's spectrum marked.
void draw_material(const Session& session, ImVec2 size);

/// Draws the curve over wavelength at the cursor's zenith. A drag along wavelengths changes the scene's wavelength.
void draw_spectrum(Session& session, AxisEditor& editor, ImVec2 size);
/// Draws R_s and R_p of the smooth surface over the local angle of incidence, and over wavelength at the angle that
/// equals the cursor's zenith.
void draw_smooth(Session& session, AxisEditor& editor, ImVec2 size);

/// Draws one element of the Mueller pBRDF in the plane of incidence as a polar plot. Light comes from the cursor's
/// zenith.
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
  /// A drag tilts the plate and moves the cursor to its zenith.
  void draw(Session& session, ImVec2 size);

 private:
  double azimuth_deg_ = 30.0;  ///< direction of the tilt from the image's horizontal
};

/// Draws the minima of the last fit, its intervals, and the sentences with which `dolp fit` explains the result. A
/// click visits a minimum. The areas of the minima are named "minimum N", from 1.
void draw_fit_result(Session& session);

/// Draws DOLP of a bistatic scene over the direction of the source, as a polar map.
void draw_sky(const Session& session, ImVec2 size);

/// Changes the typed range of a wavelength axis or of a map axis.
void set_range(Session& session, const MapAxis& axis, const AxisEditor::Change& change);

/// Map, contour lines, colour bar and cursor. A click or drag moves the cursor, and the scene follows.
class MapView {
 public:
  void draw(Session& session, AxisEditor& editor, ImVec2 size);
  const Scale& colours() const { return colour_scale_; }
  const Area& area() const { return area_; }

 private:
  /// The contour lines of one value.
  struct Contour {
    double level;
    std::vector<Segment> segments;
  };
  const PlottedDescription& quantity() const { return described(quantity_); }
  void update(const Session& session);
  /// The values of the first and of the last colour.
  Scale colour_range() const;
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
